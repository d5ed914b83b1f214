#include "vmech/hw_interface/rendering/mechanism_tick.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"

namespace vmech {
namespace {

constexpr int kOwnChannels = 4;
constexpr double kFinest = 1e-7;  // [m], [rad]: of a device that states no resolution

double Resolution(const HandlePhysics& handle) {
  return std::max(handle.resolution, kFinest);
}

TrackOptions InTheMetricOf(const ContactLaw& law, TrackOptions track) {
  track.kinematics.stiffness = law.stiffness;
  return track;
}

AdaptiveWindow SlipOf(const DeviceInfo& device, bool angular) {
  return AdaptiveWindow(device.period, Resolution(angular ? device.angular : device.linear));
}

bool IsHeld(TrackStatus status) {
  return status == TrackStatus::kDeadCentre || status == TrackStatus::kJump ||
         status == TrackStatus::kLost;
}

}  // namespace

void MechanismTickOptions::Validate() const {
  CheckRange("MechanismTickOptions", "inertia", inertia, 0, 1);
  for (int i = 0; i < 6; ++i) {
    CheckRange("MechanismTickOptions", "stiffness", law.stiffness[i], 0, 1e7);
    CheckRange("MechanismTickOptions", "damping", law.damping[i], 0, 1e5);
  }
  CheckRange("MechanismTickOptions", "loss", law.loss, 0, 1e3);
  CheckRange("MechanismTickOptions", "angular_loss", law.angular_loss, 0, 1e3);
}

MechanismTick::MechanismTick(const KinematicTree& tree, int grasp, const VectorXd& q,
                             const DeviceInfo& device, const MechanismTickOptions& options)
    : options_(options),
      tracker_(tree, GraspFrameOf(tree, grasp), q, InTheMetricOf(options.law, options.track)),
      dynamics_(tree, GraspFrameOf(tree, grasp), options.law.stiffness, q),
      motion_(options.estimator, device.period, Resolution(device.linear),
              Resolution(device.angular)),
      slip_{SlipOf(device, false), SlipOf(device, false), SlipOf(device, false),
            SlipOf(device, true),  SlipOf(device, true),  SlipOf(device, true)},
      period_(device.period),
      X_WG_(dynamics_.SetPose(q)),
      peaks_(tree.mechanism) {
  options.Validate();
  // A point grasp returns no moments (paper section 4).
  if (tree.mechanism.grasps[grasp].kind == GraspKind::kPoint) {
    options_.law.stiffness.tail<3>().setZero();
    options_.law.damping.tail<3>().setZero();
  }
}

std::vector<std::string> MechanismTick::ChannelNames() const {
  std::vector<std::string> names{"off_position", "off_rotation", "dynamic_force", "state"};
  peaks_.AppendNames(&names);
  return names;
}

std::vector<std::string> MechanismTick::StateNames() const {
  std::vector<std::string> names;
  for (int s = 0; s <= static_cast<int>(TrackStatus::kLost); ++s) {
    names.emplace_back(NameOf(static_cast<TrackStatus>(s)));
  }
  return names;
}

void MechanismTick::Show(TickPicture* picture) const noexcept {
  picture->q = tracker_.q();
  picture->v = dynamics_.v();
  picture->joints = dynamics_.joints();
  picture->X_WH = X_WH_;
  picture->X_WG = X_WG_;
  picture->dynamic = dynamics_.w_d();
  picture->constraint = w_c_;
}

void MechanismTick::Reset() noexcept {
  motion_.Reset();
  for (AdaptiveWindow& window : slip_) window.Reset();
  slip_rate_.setZero();
  peaks_.Reset();
}

TickOutput MechanismTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  if (input.fresh) track_ = tracker_.Advance(input.X_WH);
  const VectorXd& q = tracker_.q();
  X_WG_ = dynamics_.SetPose(q, tracker_.kinematics().WorkspaceAt(q));
  const Vector6d e1 = HandError(X_WG_, input.X_WH);
  if (input.fresh) {
    motion_.Update(X_WG_, static_cast<int>(std::lround(input.elapsed / period_)));
    if (options_.law.kind != ContactKind::kLinear) {
      for (int i = 0; i < 6; ++i) slip_rate_[i] = slip_[i].Update(e1[i]).v;
    }
  }
  TickOutput out;
  if (!dynamics_.Evaluate(motion_.V(), motion_.A(), options_.inertia)) {
    out.status = TickStatus::kFailed;
    return out;
  }
  const ContactLaw& law = options_.law;
  out.status = IsHeld(track_) ? TickStatus::kHeld : TickStatus::kOk;
  // Paper eq. (12): the hand feels the opposite of what it does to the mechanism.
  X_WH_ = input.X_WH;
  w_c_ = law.Wrench(e1, slip_rate_);
  out.F_Ho_W = -(dynamics_.w_d() + w_c_);
  out.stored_energy = dynamics_.Energy() + law.StoredEnergy(e1);
  if (!input.held) out.F_Ho_W.setZero();
  Report(e1, channels);
  return out;
}

void MechanismTick::Report(const Vector6d& e1, std::span<double> channels) noexcept {
  channels[0] = e1.head<3>().norm();
  channels[1] = e1.tail<3>().norm();
  channels[2] = dynamics_.w_d().head<3>().norm();
  channels[3] = static_cast<double>(track_);
  peaks_.Add(dynamics_.joints(), channels.subspan(kOwnChannels));
}

std::string MechanismTick::FullReport() const {
  return "  " + tracking().BriefReport() + "\n" + peaks_.Report();
}

}  // namespace vmech
