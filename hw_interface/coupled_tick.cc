#include "vmech/hw_interface/coupled_tick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vmech/kinematics/rotation_error.h"
#include "vmech/solvers/stopping_rule.h"

namespace vmech {
namespace {

constexpr int kOwnChannels = 4;

HandCoupling AtTheMechanism(const CoupledTickOptions& options) {
  options.Validate();
  HandCoupling coupling = options.coupling;
  coupling.stiffness /= options.scale;
  coupling.damping /= options.scale;
  coupling.max_force /= options.scale;
  coupling.max_moment /= options.scale;
  return coupling;
}

}  // namespace

void CoupledTickOptions::Validate() const {
  CheckRange("CoupledTickOptions", "scale", scale, 1e-6, 1e3);
  CheckRange("CoupledTickOptions", "smoothing", smoothing, 0, 0.1);
}

CoupledTick::CoupledTick(const KinematicTree& tree, int grasp, const VectorXd& q, double period,
                         const CoupledTickOptions& options)
    : options_(options),
      dynamics_(tree, GraspFrameOf(tree, grasp), AtTheMechanism(options), period, q),
      period_(period),
      peaks_(tree.mechanism) {}

std::vector<std::string> CoupledTick::ChannelNames() const {
  std::vector<std::string> names{"off_position", "off_rotation", "coupling_force", "state"};
  peaks_.AppendNames(&names);
  return names;
}

void CoupledTick::Reset() noexcept {
  dynamics_.Stop();
  has_hand_ = false;
  V_WH_.setZero();
  peaks_.Reset();
  summary_ = {};
}

TickOutput CoupledTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  if (input.fresh) EstimateTwist(input);
  const CoupledStatus status = dynamics_.Step(X_WH_, V_WH_);
  TickOutput out;
  if (status == CoupledStatus::kFailed) {
    out.status = TickStatus::kFailed;
    return out;
  }
  out.status = status == CoupledStatus::kStopped ? TickStatus::kHeld : TickStatus::kOk;
  out.F_Ho_W = -options_.scale * dynamics_.w();
  out.stored_energy = options_.scale * dynamics_.Energy();
  Account(status, channels);
  return out;
}

void CoupledTick::Account(CoupledStatus status, std::span<double> channels) noexcept {
  const Vector6d e1 = HandError(dynamics_.X_WG(), X_WH_);
  channels[0] = e1.head<3>().norm();
  channels[1] = e1.tail<3>().norm();
  channels[2] = dynamics_.w().head<3>().norm();
  channels[3] = static_cast<double>(dynamics_.slipping() + 2 * dynamics_.at_limit() +
                                    4 * (status == CoupledStatus::kStopped));
  peaks_.Add(dynamics_.joints(), channels.subspan(kOwnChannels));
  ++summary_.ticks;
  summary_.at_limit += dynamics_.at_limit();
  summary_.slipping += dynamics_.slipping();
  summary_.stopped += status == CoupledStatus::kStopped;
  if (status == CoupledStatus::kMoved) {
    summary_.worst_closure = std::max(summary_.worst_closure, dynamics_.closure());
  }
  summary_.farthest = std::max(summary_.farthest, channels[0]);
}

std::string CoupledSummary::BriefReport() const {
  return fmt::format(
      "{} ticks: {} with a joint at its limit, {} with the coupling at its largest, {} stopped "
      "before open loops; hand at most {:.2g} mm off; loops closed to {:.2g}",
      ticks, at_limit, slipping, stopped, 1e3 * farthest, worst_closure);
}

std::string CoupledTick::FullReport() const {
  return "  " + summary_.BriefReport() + "\n" + peaks_.Report();
}

/// Differences through a filter of first order.
void CoupledTick::EstimateTwist(const TickInput& input) noexcept {
  if (has_hand_) {
    const double elapsed = std::max(input.elapsed, period_);
    const double share = options_.smoothing > 0 ? 1 - std::exp(-elapsed / options_.smoothing) : 1;
    V_WH_ += share * (HandError(X_WH_, input.X_WH) / elapsed - V_WH_);
  }
  X_WH_ = input.X_WH;
  has_hand_ = true;
}

}  // namespace vmech
