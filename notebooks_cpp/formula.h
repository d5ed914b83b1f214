#pragma once

#include <string_view>

#include "vmech/apps/html/markup.h"

namespace vmech {

enum class FormulaStyle { kInline, kDisplay };

/// A formula in a part of TeX as MathML, which browsers draw themselves. Known are letters, numbers
/// and operators, `_ ^ '` and `{}`, \frac, \sqrt, accents (\dot, \ddot, \hat, \bar, \vec, \tilde),
/// \mathbf, \mathrm, \text, \left and \right, bmatrix, Greek letters, and the usual functions and
/// signs.
/// @throws std::invalid_argument naming what cannot be read and where.
html::Markup RenderFormula(std::string_view tex, FormulaStyle style);

}  // namespace vmech
