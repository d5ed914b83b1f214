#include "vmech/dynamics/in_hand/virtual_coupling.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

HandCoupling Checked(HandCoupling coupling, GraspKind kind) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 6; ++i) {
    CheckRange("HandCoupling", "stiffness", coupling.stiffness[i], 0, 1e9);
    CheckRange("HandCoupling", "damping", coupling.damping[i], 0, 1e7);
  }
  CheckRange("HandCoupling", "max_force", coupling.max_force, 1e-9, kNoLimit);
  CheckRange("HandCoupling", "max_moment", coupling.max_moment, 1e-9, kNoLimit);
  if (kind == GraspKind::kPoint) {
    coupling.stiffness.tail<3>().setZero();
    coupling.damping.tail<3>().setZero();
  }
  return coupling;
}

/// Of a spring along `way` that pulls with `pull`, and with no more than `most`.
double SpringEnergy(const Double4& way, const Double4& pull, double most) {
  const double whole = 0.5 * Dot(way, pull), force2 = Dot(pull, pull);
  if (force2 <= most * most) return whole;
  const double part = most / std::sqrt(force2);  // of the way, until it slips
  return whole * part * (2 - part);
}

/// Shortens a vector to `most`. True if it was longer.
bool Shorten(double most, Double4* a) {
  const double length2 = Dot(*a, *a);
  if (length2 <= most * most) return false;
  *a *= most / std::sqrt(length2);
  return true;
}

}  // namespace

VirtualCoupling::VirtualCoupling(const HandCoupling& coupling, GraspKind kind, double step)
    : most_{coupling.max_force, coupling.max_moment}, T_(step) {
  const HandCoupling checked = Checked(coupling, kind);
  stiffness_ = ScrewOf(checked.stiffness);
  damping_ = ScrewOf(checked.damping);
  root_gain_ = ScrewOf((checked.damping + step * checked.stiffness).cwiseSqrt());
}

void VirtualCoupling::Stretch(const Frame& X_WG, const MovingFrame& hand) noexcept {
  V_WH_ = hand.V;
  e1_ = HandError(X_WG, hand.X);
  const Screw pull = Scaled(stiffness_, e1_);
  const WrenchLimit allowed = Allowed(pull);
  energy_ = SpringEnergy(e1_.linear, pull.linear, allowed.force) +
            SpringEnergy(e1_.angular, pull.angular, allowed.moment);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  slipped_.force = Length(pull.linear) > allowed.force ? allowed.force : kNone;
  slipped_.moment = Length(pull.angular) > allowed.moment ? allowed.moment : kNone;
}

/// The largest force and moment of a pull that may be too large.
WrenchLimit VirtualCoupling::Allowed(const Screw& pull) const noexcept {
  WrenchLimit allowed{std::min({most_.force, room_.force, slipped_.force}),
                      std::min({most_.moment, room_.moment, slipped_.moment})};
  if (!room_.together) return allowed;
  const double f = std::min(Length(pull.linear), allowed.force);
  const double m = std::min(Length(pull.angular), allowed.moment);
  const double share = room_.Share(f, m);
  return share < 1 ? WrenchLimit{share * f, share * m} : allowed;
}

Screw VirtualCoupling::Given() const noexcept {
  return Scaled(stiffness_, e1_) + Scaled(damping_, V_WH_);
}

bool VirtualCoupling::Pull(const Screw& V_WG) noexcept {
  w_ = Scaled(stiffness_, e1_ - T_ * V_WG) + Scaled(damping_, V_WH_ - V_WG);
  const WrenchLimit allowed = Allowed(w_);
  const bool force_slips = Shorten(allowed.force, &w_.linear);
  const bool moment_slips = Shorten(allowed.moment, &w_.angular);
  return slipping_ = force_slips || moment_slips;
}

void VirtualCoupling::LetGo() noexcept {
  w_ = {};
  energy_ = 0;
  slipped_ = {};
  slipping_ = false;
}

double VirtualCoupling::Dragged(const Screw& V_WG) const noexcept {
  return std::max(0.0, T_ * Power(Scaled(damping_, V_WH_ - V_WG), V_WG));
}

}  // namespace vmech
