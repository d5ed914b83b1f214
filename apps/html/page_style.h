#pragma once

#include <string_view>

namespace vmech::html {

/// The style sheet of every page. Free of < and &, so that the page stays well-formed XML.
inline constexpr std::string_view kPageStyle = R"css(
:root { color-scheme: light dark; --paper: #ffffff; --panel: #f6f7f9; --ink: #1d2129;
  --muted: #5f6875; --line: #dfe3e8; --accent: #0067a8;
  --good: #0b6e4f; --good-tint: #e3f4ec; --warning: #8a5300; --warning-tint: #fdf1dc;
  --bad: #a8231c; --bad-tint: #fce8e6; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171c; --panel: #1c2027; --ink: #e5e8ec;
  --muted: #98a2af; --line: #323943; --accent: #6cb8ee;
  --good: #6fd3a8; --good-tint: #14322a; --warning: #f0b95f; --warning-tint: #38290f;
  --bad: #ff9a90; --bad-tint: #401c1a; } }
* { box-sizing: border-box; }
html { background: var(--paper); color: var(--ink); -webkit-text-size-adjust: 100%;
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans",
  "Liberation Sans", Arial, sans-serif; }
body { margin: 0; }
main { max-width: 66rem; margin: 0 auto; padding: 2.5rem 1.5rem 5rem; }
h1 { font-size: 2rem; line-height: 1.2; letter-spacing: -0.015em; margin: 0 0 0.4rem; }
h2 { font-size: 1.35rem; line-height: 1.3; letter-spacing: -0.01em; margin: 3rem 0 0.7rem;
  padding-top: 0.9rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.06rem; margin: 2rem 0 0.4rem; }
p, ul, ol { margin: 0 0 0.9rem; max-width: 46rem; }
li { margin: 0.15rem 0; }
a { color: var(--accent); }
.lead { color: var(--muted); font-size: 1.06rem; }
.eyebrow { color: var(--accent); font-size: 0.78rem; font-weight: 650; letter-spacing: 0.07em;
  text-transform: uppercase; margin: 0 0 0.3rem; }
small, .remark, figcaption, caption { color: var(--muted); }
code, pre { font-family: ui-monospace, "SF Mono", "Cascadia Mono", Menlo, Consolas,
  "DejaVu Sans Mono", "Liberation Mono", monospace; font-size: 0.875em; }
code { background: var(--panel); border-radius: 4px; padding: 0.1em 0.3em;
  overflow-wrap: anywhere; }
pre { background: var(--panel); border-radius: 8px; padding: 0.8rem 1rem; overflow-x: auto;
  line-height: 1.5; margin: 0 0 1rem; }
pre code { background: none; padding: 0; font-size: 1em; overflow-wrap: normal; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(11.5rem, 1fr)); gap: 0.8rem;
  margin: 1.5rem 0; }
.tile { background: var(--panel); border-radius: 10px; padding: 0.85rem 1rem 0.8rem; }
.tile .label { font-size: 0.82rem; color: var(--muted); }
.tile .value { font-size: 1.65rem; font-weight: 620; line-height: 1.3; letter-spacing: -0.02em;
  font-variant-numeric: tabular-nums; }
.tile .value small { font-size: 0.95rem; font-weight: 450; letter-spacing: 0; }
.tile .remark { font-size: 0.82rem; line-height: 1.4; }
figure { margin: 1rem 0; min-width: 0; }
figcaption { font-size: 0.88rem; margin-top: 0.4rem; max-width: 46rem; }
figure svg { display: block; max-width: 100%; height: auto; }
.figures { display: flex; flex-wrap: wrap; gap: 0.5rem 1.5rem; align-items: flex-start; }
.figures figure { flex: 0 1 auto; }
table { border-collapse: collapse; width: 100%; margin: 1rem 0 1.5rem; font-size: 0.92rem; }
caption { text-align: left; padding: 0 0 0.4rem; font-size: 0.9rem; }
th, td { text-align: left; padding: 0.42rem 0.7rem; border-bottom: 1px solid var(--line);
  vertical-align: baseline; }
th { position: sticky; top: 0; background: var(--paper); font-weight: 620; font-size: 0.84rem;
  color: var(--muted); border-bottom-color: var(--muted); vertical-align: bottom; }
th:first-child, td:first-child { padding-left: 0.2rem; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.badge { display: inline-block; font-size: 0.78rem; font-weight: 600; line-height: 1.5;
  padding: 0 0.55em; border-radius: 1em; white-space: nowrap; background: var(--panel);
  color: var(--muted); }
.notice { border-left: 3px solid var(--muted); background: var(--panel); margin: 1rem 0;
  border-radius: 0 8px 8px 0; padding: 0.7rem 1rem; max-width: 48rem; }
.notice > :last-child { margin-bottom: 0; }
.badge.good { background: var(--good-tint); color: var(--good); }
.badge.warning { background: var(--warning-tint); color: var(--warning); }
.badge.bad { background: var(--bad-tint); color: var(--bad); }
.notice.good { background: var(--good-tint); border-color: var(--good); }
.notice.warning { background: var(--warning-tint); border-color: var(--warning); }
.notice.bad { background: var(--bad-tint); border-color: var(--bad); }
details { margin: 0.6rem 0 1rem; }
summary { cursor: pointer; color: var(--accent); }
footer { margin-top: 4rem; padding-top: 1rem; border-top: 1px solid var(--line);
  color: var(--muted); font-size: 0.85rem; }
@media screen and (max-width: 66rem) { .scroll, figure { overflow-x: auto; } }
@media screen and (max-width: 36rem) {
  main { padding: 1.3rem 0.9rem 3rem; }
  h1 { font-size: 1.55rem; overflow-wrap: anywhere; }
  h2 { margin-top: 2.2rem; }
  ul, ol { padding-left: 1.3rem; }
  .tiles { grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr)); gap: 0.6rem; }
  .tile { padding: 0.7rem 0.8rem; overflow-wrap: anywhere; }
  .tile .value { font-size: 1.35rem; }
  figure svg[width="660"] { max-width: none; width: 32rem; } }
.printed { display: none; }
@media print {
  :root { --paper: #ffffff; --panel: #f6f7f9; --ink: #000000; --muted: #444444; --line: #bbbbbb; }
  html { font-size: 10pt; color-scheme: light; }
  main { max-width: none; padding: 0; }
  th { position: static; }
  h2 { margin-top: 1.4rem; }
  h3 { margin-top: 0.9rem; }
  table { margin: 0.5rem 0 0.8rem; }
  th, td { padding: 0.18rem 0.5rem; }
  details { margin: 0.4rem 0; }
  details.screen { display: none; }
  .printed { display: block; }
  h2, h3, h3 + p, caption, thead, summary { break-after: avoid; }
  figure, .figures, tr, li, .tile, .notice { break-inside: avoid; }
  p, li { orphans: 3; widows: 3; }
  .figures { zoom: 0.68; }
  details > * { display: block; }
  details::details-content { content-visibility: visible; }
  @page { margin: 16mm 14mm; }
}
)css";

}  // namespace vmech::html
