#include "vmech/dynamics/in_hand/fading_wrench.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/screw_algebra.h"

namespace vmech {

FadingWrench::FadingWrench(const Screw& stiffness, double rate, double step)
    : most_(rate * step), T_(step) {
  constexpr double kFade = 0.02;  // [s]
  share_ = std::exp(-step / kFade);
  for (int i = 0; i < 3; ++i) {
    compliance_.linear[i] = stiffness.linear[i] > 0 ? 1 / stiffness.linear[i] : 0;
    compliance_.angular[i] = stiffness.angular[i] > 0 ? 1 / stiffness.angular[i] : 0;
  }
}

void FadingWrench::Add(const Screw& w) noexcept {
  w_ += w;
}

void FadingWrench::Step(const Screw& V) noexcept {
  if (!acts()) return;
  const double force = Length(w_.linear), work = T_ * Power(w_, V);
  double left = share_;
  if (force * (1 - left) > most_) left = 1 - most_ / force;
  if (work > 0) left *= std::max(0.0, 1 - work / (2 * energy()));
  w_ = left * w_;
}

bool FadingWrench::acts() const noexcept {
  return Power(w_, w_) > 0;
}

double FadingWrench::energy() const noexcept {
  return 0.5 * Power(w_, Scaled(compliance_, w_));
}

}  // namespace vmech
