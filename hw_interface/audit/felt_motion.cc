#include "vmech/hw_interface/audit/felt_motion.h"

#include <algorithm>
#include <cmath>

#include "vmech/kinematics/inverse/hand_tracker.h"

namespace vmech {

FeltMotion::FeltMotion(const RecordingHeader& header)
    : period_(header.period),
      roll_off_(PromiseOf(header).roll_off),
      share_(PromiseOf(header).inertia),
      share_channel_(header.ChannelOf("inertia_share")) {
  const std::string estimator = header.Note("estimator");
  knows_rate_ = estimator.empty() || estimator == "observer" || estimator == "window";
}

void FeltMotion::Take(const TickRecord& tick) {
  const VectorXd& v = tick.picture.v;
  if (!started_) u_ = felt_ = rate_ = VectorXd::Zero(v.size());
  if (tick.io != IoStatus::kOk) return;
  const double periods = started_ ? PeriodsBetween(last_, tick.state, period_) : 1;
  const double elapsed = period_ * std::max(1.0, std::round(periods));
  last_ = tick.state;
  if (share_channel_ >= 0) share_ = tick.channels[static_cast<size_t>(share_channel_)];
  const double root = std::sqrt(share_);
  if (!started_) root_ = root;
  started_ = true;
  rate_ = share_ / (roll_off_ + elapsed) * (v - u_);
  u_ += elapsed / (roll_off_ + elapsed) * (v - u_);
  rate_ += root * (root - root_) / elapsed * u_;
  root_ = root;
  felt_ = root * u_;
}

OwnWrench::OwnWrench(const RecordingHeader& header)
    : paper_(PromiseOf(header).paper),
      state_channel_(header.ChannelOf("state")),
      force_channel_(header.ChannelOf("dynamic_force")) {}

/// 0: what is recorded has none.
double OwnWrench::StateOf(const TickRecord& tick) const {
  return state_channel_ < 0 ? 0 : tick.channels[static_cast<size_t>(state_channel_)];
}

bool OwnWrench::IsOfNearestPose(const TickRecord& tick, double tolerance) const {
  const bool nearest =
      !paper_ || state_channel_ < 0 || StateOf(tick) == static_cast<double>(TrackStatus::kFollowed);
  return nearest && IsIn(tick, tolerance);
}

bool OwnWrench::IsIn(const TickRecord& tick, double tolerance) const {
  if (!paper_) return StateOf(tick) == 0;
  if (StateOf(tick) >= static_cast<double>(TrackStatus::kDeadCentre)) return false;
  if (force_channel_ < 0) return true;
  const double force = tick.channels[static_cast<size_t>(force_channel_)];
  const double felt = tick.picture.dynamic.head<3>().norm();
  return std::abs(force - felt) <= tolerance * std::max(1.0, force);
}

}  // namespace vmech
