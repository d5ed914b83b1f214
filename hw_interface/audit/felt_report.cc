#include "vmech/hw_interface/audit/felt_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

constexpr double kWorstFit = 0.05;  // error of what is still told

bool IsTold(const Felt& felt, double size) {
  return felt.known && felt.error <= kWorstFit * std::max(size, 1e-12);
}

std::string Line(const char* what, const Felt& felt, double size, double unit, const char* name) {
  if (!felt.known || felt.error > kWorstFit * size) {
    return fmt::format("  {:<26} not told: too little of it in this session\n", what);
  }
  return fmt::format("  {:<26} {:>9.4g} +- {:<8.2g} promised {:<9.4g} {}\n", what,
                     unit * felt.value, unit * felt.error, unit * felt.promised, name);
}

std::string Share(std::uint64_t count, std::uint64_t of) {
  return fmt::format("{:.3g} %", 100.0 * static_cast<double>(count) / static_cast<double>(of));
}

/// "as promised", "12 % more than promised".
std::string Against(const Felt& felt) {
  constexpr double kNear = 0.05;
  const double off = felt.value / felt.promised - 1;
  const double error = 2 * felt.error / std::abs(felt.promised);
  if (std::abs(off) <= kNear + error) {
    return error <= kNear ? "as promised"
                          : fmt::format("as promised within {:.0f} %", 100 * (kNear + error));
  }
  return fmt::format("{:.0f} % {} than promised", 100 * std::abs(off), off > 0 ? "more" : "less");
}

/// What is fitted, a line for each figure.
std::string FittedFigures(const FeltReport& felt) {
  constexpr double kPercent = 100, kMilli = 1e3;
  std::string text;
  const std::string whose =
      felt.share < 1 - 1e-9
          ? fmt::format("% of the share rendered, {:.3g} % on average", 100 * felt.share)
          : "% of the mechanism's";
  text += Line("  inertia", felt.inertia, felt.inertia.promised, kPercent, whose.c_str());
  text += Line("  weight", felt.weight, felt.weight.promised, kPercent, "% of the mechanism's");
  text += Line("  damping, free motion", felt.damping, 10, 1, "N s/m");
  text += Line("  stiffness, constraints", felt.stiffness, felt.stiffness.promised, 1, "N/m");
  text +=
      Line("  damping, constraints", felt.resistance, 0.02 * felt.stiffness.promised, 1, "N s/m");
  text += Line("  delay of the device", felt.delay, 0.01, kMilli, "ms");
  return text;
}

}  // namespace

std::string FeltReport::Text() const {
  std::string text = "  felt, fitted to this session\n";
  text += unreached ? "    not told: the mechanism has freedoms that the hand does not reach\n"
                    : FittedFigures(*this);
  text += fmt::format("  {:<26} {:>9.3g} N RMS from tick to tick, at most {:.3g} N\n", "  noise",
                      noise, largest_change);
  constexpr std::array<const char*, kSafetyStages> kWhy{"soft start", "damped by passivity",
                                                        "clamped at the largest", "slowed down",
                                                        "braked near the speed limit"};
  for (int i = 0; i < kSafetyStages; ++i) {
    if (stages[i] > 0) {
      text += fmt::format("  force changed: {:<22} {}\n", kWhy[i], Share(stages[i], ticks));
    }
  }
  for (int i = 0; i < kCauses; ++i) {
    if (off[i] > 0) {
      text += fmt::format("  no force: {:<27} {}\n", NameOf(static_cast<ForceOff>(i)),
                          Share(off[i], ticks));
    }
  }
  return text;
}

std::string FeltReport::Verdict() const {
  std::string words;
  if (IsTold(inertia, inertia.promised)) words += "the inertia was felt " + Against(inertia);
  if (IsTold(stiffness, stiffness.promised)) {
    words += (words.empty() ? "" : ", ") + ("the constraints " + Against(stiffness));
  }
  if (unreached) {
    words = "what was felt is not told, since the hand does not reach every freedom";
  } else if (words.empty()) {
    words = "this session shows too little to tell what was felt";
  }
  std::uint64_t without = 0;
  for (const std::uint64_t count : off) without += count;
  if (stages[1] * 100 > ticks) words += "; passivity damped in " + Share(stages[1], ticks);
  if (stages[2] * 100 > ticks)
    words += "; the device was at its largest in " + Share(stages[2], ticks);
  if (without * 100 > ticks) words += "; no force in " + Share(without, ticks) + " of the time";
  return words;
}

}  // namespace vmech
