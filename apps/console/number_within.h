#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

namespace vmech {

/// The check of an option whose value is a number in [low, high], which `range` shows in the help;
/// "nan" is no number.
inline CLI::Validator NumberWithin(double low, double high, const std::string& range) {
  const auto check = [=](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool number = !text.empty() && *end == 0;
    if (number && value >= low && value <= high) return std::string();
    return fmt::format("'{}' is not a number in {}", text, range);
  };
  return {[check](std::string& text) { return check(text); }, range};
}

}  // namespace vmech
