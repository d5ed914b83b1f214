#pragma once

#include <string_view>

namespace vmech {

/// The style sheet of a drawing: classes and plain colours alone, which drawing programs and word
/// processors understand. The colours of links are those of plots (apps/plot/style.cc).
inline constexpr std::string_view kDrawingStyle = R"css(
text { font-family: "Liberation Sans", Arial, Helvetica, sans-serif; font-size: 12px;
  fill: #1d2129; }
.title { font-size: 15px; font-weight: bold; }
.soft { fill: #5f6875; }
.note { font-size: 11.5px; font-weight: bold; }
.halo { paint-order: stroke; stroke: #ffffff; stroke-width: 3.5px; stroke-linejoin: round; }
.mid { text-anchor: middle; }
line, path, circle { fill: none; }
.bar { stroke-width: 7px; stroke-linecap: round; stroke-linejoin: round; }
.plate { fill-opacity: 0.16; stroke: none; }
.arm { stroke-width: 2px; stroke-dasharray: 4 3; }
.ground { stroke: #555b66; stroke-width: 1.6px; }
.hatch { stroke: #555b66; stroke-width: 1px; }
.symbol { fill: #ffffff; stroke: #1d2129; stroke-width: 1.6px; stroke-linejoin: round; }
.slider { fill: #ffffff; stroke-width: 3.2px; stroke-linejoin: round; }
.detail { stroke: #1d2129; stroke-width: 1.3px; }
.pivot { fill: #1d2129; }
.axis { stroke: #5f6875; stroke-width: 0.9px; stroke-dasharray: 9 3 2 3; }
.gap { stroke: #a8231c; stroke-width: 1.6px; stroke-dasharray: 3 3; }
.scale { stroke: #1d2129; stroke-width: 1.6px; }
.s1 { stroke: #0067a8; } .s2 { stroke: #d55e00; } .s3 { stroke: #008a66; }
.s4 { stroke: #b0488c; } .s5 { stroke: #c98a00; } .s6 { stroke: #3d9fd6; }
.s7 { stroke: #555b66; }
.f1 { fill: #0067a8; } .f2 { fill: #d55e00; } .f3 { fill: #008a66; }
.f4 { fill: #b0488c; } .f5 { fill: #c98a00; } .f6 { fill: #3d9fd6; }
.f7 { fill: #555b66; }
)css";

}  // namespace vmech
