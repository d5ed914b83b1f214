#include "vmech/hw_interface/audit/audit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vmech {

void AuditFinding::Add(double value, std::uint64_t at) {
  if (value <= worst || std::isnan(worst)) return;
  worst = value;
  tick = at;
}

bool AuditReport::sound() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const AuditFinding& finding) { return finding.sound(); });
}

std::string AuditReport::Text() const {
  std::string text = fmt::format("audit of {} ticks\n", ticks);
  for (const AuditFinding& f : findings) {
    text += fmt::format("  {:<60} {:>9.2g} {:<6} at most {:.3g}{}\n", f.what, f.worst,
                        f.unit == "-" ? "" : f.unit, f.bound,
                        f.sound() ? "" : fmt::format("   NOT SOUND, tick {}", f.tick));
  }
  text += fmt::format("  energy: {}\n", energy.Text());
  if (!left_out.empty()) text += fmt::format("  not judged: {}\n", left_out);
  return text + fmt::format("verdict: {}\n", Verdict());
}

std::string AuditReport::Verdict() const {
  return sound() ? "sound, every number agrees with the mechanism"
                 : "not sound, these numbers are not those of this mechanism";
}

std::string EnergyBalance::Text() const {
  return fmt::format(
      "the hand did {:.4g} J on the mechanism; {:.4g} J went into motion, {:.4g} J into height, "
      "{:.4g} J into springs, friction and limits of joints, {:.4g} J were taken by {}, {:.4g} J "
      "{}, {:.2g} J are not traced; constraints did {:.2g} J along free motions",
      hand, kinetic, weight, joints, taken, follows ? "the lag of its inertia" : "time steps",
      withheld,
      follows ? "were felt beyond what it got, where forces are bounded or it catches up"
              : "by what closes its loops",
      untraced, constraint);
}

}  // namespace vmech
