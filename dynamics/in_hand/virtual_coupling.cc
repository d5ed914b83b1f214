#include "vmech/dynamics/in_hand/virtual_coupling.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/tree/grasp_rows.h"

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
  coupling.stiffness = RowsThatCount(coupling.stiffness, kind);
  coupling.damping = RowsThatCount(coupling.damping, kind);
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
  root_damping_ = ScrewOf(checked.damping.cwiseSqrt());
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
  force_slips_ = moment_slips_ = all_slips_ = false;
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

void VirtualCoupling::Foresee(const Screw& V_WG) noexcept {
  if (slipping_) PullSpring(V_WG);
}

Screw VirtualCoupling::RootGain() const noexcept {
  if (all_slips_) return {};
  return {force_slips_ ? root_damping_.linear : root_gain_.linear,
          moment_slips_ ? root_damping_.angular : root_gain_.angular};
}

Screw VirtualCoupling::Given() const noexcept {
  if (all_slips_) return w_;
  const Screw spring = Scaled(stiffness_, e1_);
  return Screw{force_slips_ ? spring_.linear : spring.linear,
               moment_slips_ ? spring_.angular : spring.angular} +
         Scaled(damping_, V_WH_);
}

/// The spring's pull, shortened where it slips. True if it is one more part that does.
bool VirtualCoupling::PullSpring(const Screw& V_WG) noexcept {
  Screw spring = Scaled(stiffness_, e1_ - T_ * V_WG);
  const WrenchLimit allowed = Allowed(spring);
  const bool force = Shorten(allowed.force, &spring.linear) && !force_slips_;
  const bool moment = Shorten(allowed.moment, &spring.angular) && !moment_slips_;
  if (!force_slips_) spring_.linear = spring.linear;
  if (!moment_slips_) spring_.angular = spring.angular;
  force_slips_ = force_slips_ || force;
  moment_slips_ = moment_slips_ || moment;
  return force || moment;
}

bool VirtualCoupling::Pull(const Screw& V_WG) noexcept {
  const bool more = !all_slips_ && PullAll(V_WG);
  dragged_ = std::max(0.0, T_ * Power(w_ - spring_, V_WG));
  return more;
}

bool VirtualCoupling::PullAll(const Screw& V_WG) noexcept {
  bool more = PullSpring(V_WG);
  w_ = spring_ + Scaled(damping_, V_WH_ - V_WG);
  const WrenchLimit allowed = Allowed(w_);
  const bool force = Shorten(allowed.force, &w_.linear);
  const bool moment = Shorten(allowed.moment, &w_.angular);
  // What is too large while the spring is not yet known may be within its limit afterwards.
  if (!more) more = all_slips_ = force || moment;
  slipping_ = force_slips_ || moment_slips_ || force || moment;
  return more;
}

void VirtualCoupling::LetGo() noexcept {
  spring_ = w_ = {};
  energy_ = dragged_ = 0;
  slipped_ = {};
  slipping_ = false;
}

}  // namespace vmech
