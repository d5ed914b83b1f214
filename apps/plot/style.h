#pragma once

#include <string>
#include <string_view>

#include "vmech/apps/html/markup.h"

namespace vmech::plot {

/// Number of distinct series colours; later series begin again.
inline constexpr int kPaletteSize = 7;

/// The style sheet of all plots, to be put once into the page that shows them. The palette is that
/// of Okabe and Ito ("Color Universal Design", 2008), darkened where thin lines on white need it,
/// so that colour-blind readers tell the series apart; it follows the reader's light or dark mode.
std::string_view PlotStyleSheet();

/// A plot as a file of its own: the drawing with its style sheet inside.
std::string StandaloneSvg(const html::Markup& drawing,
                          std::string_view style_sheet = PlotStyleSheet());

}  // namespace vmech::plot
