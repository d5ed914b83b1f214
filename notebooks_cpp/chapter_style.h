#pragma once

#include <string_view>

namespace vmech {

/// What a chapter adds to the style sheet of pages.
inline constexpr std::string_view kChapterStyle = R"css(
main { max-width: 58rem; }
.formula { margin: 1.1rem 0; overflow-x: auto; }
math { font-size: 1.1em;
  font-family: "STIX Two Math", "Latin Modern Math", "Cambria Math", "Libertinus Math", serif; }
math .bold { font-weight: 700; font-style: normal; }
.cell { border-left: 3px solid var(--accent); border-radius: 0 8px 8px 0; margin-bottom: 0.4rem; }
.output { background: none; padding: 0.2rem 1rem; margin: 0.4rem 0 1.2rem;
  border-left: 3px solid var(--line); border-radius: 0; }
.check { margin: 0.3rem 0 0.5rem; font-size: 0.92rem; max-width: none; }
.check + p:not(.check) { margin-top: 1.2rem; }
.cell .k { color: #8a2b91; } .cell .t { color: #0b5f8a; } .cell .n { color: #9a4a00; }
.cell .s { color: #2a6b2f; } .cell .c { color: var(--muted); font-style: italic; }
.cell .p { color: #7a5a00; }
@media (prefers-color-scheme: dark) { .cell .k { color: #d79be0; } .cell .t { color: #7cc4ea; }
  .cell .n { color: #f0a35f; } .cell .s { color: #93cf96; } .cell .p { color: #d9bd66; } }
)css";

}  // namespace vmech
