#include "vmech/apps/plot/style.h"

namespace vmech::plot {

std::string_view PlotStyleSheet() {
  static constexpr std::string_view kStyle = R"css(
.plot { --back: #ffffff; --text: #1d2129; --soft: #5f6875; --grid: #e6e9ed; --base: #8d96a3;
  --s1: #0067a8; --s2: #d55e00; --s3: #008a66; --s4: #b0488c; --s5: #c98a00; --s6: #3d9fd6;
  --s7: #555b66; color: var(--text); }
@media (prefers-color-scheme: dark) { .plot { --back: #14171c; --text: #e5e8ec; --soft: #98a2af;
  --grid: #2a3039; --base: #6d7683; --s1: #5ab4f0; --s2: #ff8a3c; --s3: #2fc99b; --s4: #e58cc4;
  --s5: #f0c243; --s6: #a8dcff; --s7: #b8bec7; } }
@media print { .plot { --back: #ffffff; --text: #000000; --soft: #444444; --grid: #dddddd;
  --base: #777777; --s1: #0067a8; --s2: #d55e00; --s3: #008a66; --s4: #b0488c; --s5: #c98a00;
  --s6: #3d9fd6; --s7: #555b66; } }
.plot text { font: 12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue",
  "Noto Sans", "Liberation Sans", Arial, sans-serif; fill: currentColor;
  font-variant-numeric: tabular-nums; }
.plot .title { font-size: 14.5px; font-weight: 620; }
.plot .soft { fill: var(--soft); }
.plot .small { font-size: 10.5px; }
.plot .mid { text-anchor: middle; }
.plot .end { text-anchor: end; }
.plot .note { font-size: 11.5px; font-weight: 600; }
.plot .halo { paint-order: stroke; stroke: var(--back); stroke-width: 4px;
  stroke-linejoin: round; }
.plot line, .plot path, .plot circle { fill: none; }
.plot .grid { stroke: var(--grid); stroke-width: 1px; }
.plot .base { stroke: var(--base); stroke-width: 1px; }
.plot .level { stroke: var(--soft); stroke-width: 1.1px; stroke-dasharray: 2 3; }
.plot .curve { stroke-width: 1.9px; stroke-linejoin: round; stroke-linecap: round; }
.plot .dashed { stroke-dasharray: 7 4; }
.plot .dotted { stroke-dasharray: 0.1 4.5; stroke-width: 2.4px; }
.plot .s1 { stroke: var(--s1); } .plot .s2 { stroke: var(--s2); } .plot .s3 { stroke: var(--s3); }
.plot .s4 { stroke: var(--s4); } .plot .s5 { stroke: var(--s5); } .plot .s6 { stroke: var(--s6); }
.plot .s7 { stroke: var(--s7); }
.plot .f1 { fill: var(--s1); } .plot .f2 { fill: var(--s2); } .plot .f3 { fill: var(--s3); }
.plot .f4 { fill: var(--s4); } .plot .f5 { fill: var(--s5); } .plot .f6 { fill: var(--s6); }
.plot .f7 { fill: var(--s7); }
.plot .dot { stroke: var(--back); stroke-width: 1.5px; }
.plot .hollow { fill: var(--back); stroke-width: 1.6px; }
)css";
  return kStyle;
}

std::string StandaloneSvg(const html::Markup& drawing, std::string_view style_sheet) {
  std::string svg = drawing.html();
  const std::size_t after_tag = svg.find('>') + 1;
  return svg.insert(after_tag, "<style>" + std::string(style_sheet) + "</style>");
}

}  // namespace vmech::plot
