#pragma once

#include <string>

namespace vmech {

/// Numbers as people read them, the same on a terminal, in messages and on a page.

/// "12 000", "−0.25": true minus, thin spaces between thousands from five digits on. "–" for a
/// value that is not finite.
std::string FormatNumber(double value, int decimals);

/// The value to `digits` significant digits, written as FormatNumber does; scientific ("1.2×10⁻⁹")
/// where that needs many zeros. "–" for a value that is not finite.
std::string FormatSignificant(double value, int digits);

/// FormatSignificant without zeros at the end: "15", "0.4".
std::string FormatShort(double value, int digits);

/// "10⁻³".
std::string PowerOfTen(int exponent);

}  // namespace vmech
