#include "vmech/hw_interface/rendering/mechanism_tick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/tree/grasp_rows.h"

namespace vmech {
namespace {

constexpr int kOwnChannels = 6;
constexpr double kFinest = 1e-7;      // [m], [rad]: of a device that states no resolution
constexpr double kShareTime = 0.01;   // [s] in which the share of inertia follows the pose
constexpr double kMean = 0.02;        // [s] over which energy given to the hand is smoothed
constexpr double kRest = 0.1;         // [s] after which a hand begins to be at rest
constexpr int kFirstIterations = 30;  // of the inertia's ratio, where the hand takes hold

using Coordinates = std::vector<CoordinateEstimator::Coordinate>;

double Resolution(const HandlePhysics& handle) {
  return std::max(handle.resolution, kFinest);
}

Coordinates OfTheHand(const DeviceInfo& device) {
  Coordinates coordinates(6, {false, Resolution(device.linear)});
  for (int i = 3; i < 6; ++i) coordinates[i] = {true, Resolution(device.angular)};
  return coordinates;
}

Coordinates OfTheTree(const KinematicTree& tree, const DeviceInfo& device) {
  Coordinates coordinates(tree.nv, {true, Resolution(device.angular)});
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kPrismatic) {
      coordinates[node.v] = {false, Resolution(device.linear)};
    }
  }
  return coordinates;
}

TrackOptions InTheMetricOf(const ContactLaw& law, TrackOptions track) {
  track.kinematics.stiffness = law.stiffness;
  return track;
}

bool IsHeld(TrackStatus status) {
  return status == TrackStatus::kDeadCentre || status == TrackStatus::kJump ||
         status == TrackStatus::kLost;
}

bool FindsAccelerations(EstimatorKind kind) {
  return kind != EstimatorKind::kObserver && kind != EstimatorKind::kAdaptiveWindow;
}

/// The factor that brings a wrench within a force and a moment; at most 1.
double ShareWithin(const Vector6d& w, double max_force, double max_moment) {
  const double force = w.head<3>().norm(), moment = w.tail<3>().norm();
  double share = 1;
  if (force > max_force) share = max_force / force;
  if (moment > max_moment) share = std::min(share, max_moment / moment);
  return share;
}

}  // namespace

double MechanismTickOptions::LagOfInertia() const {
  return FindsAccelerations(estimator.kind) ? 0 : roll_off;
}

void MechanismTickOptions::Validate() const {
  const char* const name = "MechanismTickOptions";
  CheckRange(name, "scale", scale, 1e-6, 1e3);
  CheckRange(name, "inertia", inertia, 0, 1);
  CheckRange(name, "inertia_ratio", inertia_ratio, 1e-6, 1e6);
  CheckRange(name, "roll_off", roll_off, 0, 0.1);
  CheckRange(name, "slew", slew, 10, 1e7);
  for (int i = 0; i < 6; ++i) {
    CheckRange(name, "stiffness", law.stiffness[i], 0, 1e7);
    CheckRange(name, "damping", law.damping[i], 0, 1e5);
    CheckRange(name, "handle_masses", handle_masses[i], 0, 1e6);
  }
  CheckRange(name, "loss", law.loss, 0, 1e3);
  CheckRange(name, "angular_loss", law.angular_loss, 0, 1e3);
}

MechanismTick::MechanismTick(const KinematicTree& tree, int grasp, const VectorXd& q,
                             const DeviceInfo& device, const MechanismTickOptions& options)
    : tree_(tree),
      options_(options),
      tracker_(tree, GraspFrameOf(tree, grasp), q, InTheMetricOf(options.law, options.track)),
      dynamics_(tree, GraspFrameOf(tree, grasp), options.law.stiffness, q, options.wrench),
      period_(device.period),
      X_WG_(dynamics_.SetPose(q)),
      resolution_(Resolution(device.linear)),
      angular_resolution_(tree.mechanism.grasps[grasp].kind == GraspKind::kPoint
                              ? std::numeric_limits<double>::infinity()
                              : Resolution(device.angular)),
      hand_({.kind = EstimatorKind::kKalman}, device.period, OfTheHand(device)),
      coordinates_(options.estimator, device.period, OfTheTree(tree, device)),
      hand_step_(VectorXd::Zero(6)),
      q_step_(VectorXd::Zero(tree.nv)),
      last_q_(q),
      S_(MatrixXd::Zero(tree.nv, tree.nv)),
      v_(q_step_),
      u_(q_step_),
      udot_(q_step_),
      felt_(q_step_),
      felt_rate_(q_step_),
      peaks_(tree.mechanism) {
  options.Validate();
  for (Vector6d* rows : {&options_.law.stiffness, &options_.law.damping, &options_.handle_masses}) {
    *rows = RowsThatCount(*rows, tree.mechanism.grasps[grasp].kind);
  }
  Reset();
}

std::vector<std::string> MechanismTick::ChannelNames() const {
  std::vector<std::string> names{"off_position", "off_rotation",  "dynamic_force",
                                 "state",        "inertia_share", "unpaid_energy"};
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
  picture->v = v_;
  picture->joints = dynamics_.joints();
  picture->X_WH = X_WH_;
  picture->X_WG = X_WG_;
  // As the hand feels them, at the mechanism's scale.
  picture->dynamic = w_d_ / options_.scale;
  picture->constraint = -(F_Ho_ + w_d_) / options_.scale;
}

void MechanismTick::Reset() noexcept {
  has_hand_ = false;
  hand_.Reset();
  coordinates_.Reset();
  for (VectorXd* x : {&v_, &u_, &udot_, &felt_, &felt_rate_}) x->setZero();
  last_q_ = tracker_.q();
  share_ = last_root_ = unpaid_ = mean_given_ = 0;
  F_Ho_.setZero();
  starts_ = true;
  w_d_.setZero();
  least_share_ = options_.inertia;
  if (dynamics_.FindVelocities(Vector6d::Zero(), nullptr)) {
    for (int i = 0; i < kFirstIterations; ++i) {
      (void)dynamics_.InertiaRatio(options_.handle_masses);
    }
  }
  peaks_.Reset();
}

TickOutput MechanismTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  TickOutput out;
  if (input.fresh || !has_hand_) {
    const int periods = std::max(1, static_cast<int>(std::lround(input.elapsed / period_)));
    const Vector6d way = ReadHand(input, periods);
    track_ = tracker_.Advance(X_WH_);
    X_WG_ = dynamics_.SetPose(tracker_.q(), tracker_.kinematics().WorkspaceAt(tracker_.q()));
    if (!FindMotion(periods) || !dynamics_.Evaluate(v_, felt_, felt_rate_)) {
      out.status = TickStatus::kFailed;
      return out;
    }
    Feel(periods, input.charged_F_Ho_W ? *input.charged_F_Ho_W : F_Ho_, way);
  }
  out.status = IsHeld(track_) ? TickStatus::kHeld : TickStatus::kOk;
  out.stored_energy = energy_ - unpaid_;
  if (input.held) out.F_Ho_W = F_Ho_;
  Report(channels);
  return out;
}

/// Paper eq. (12): the hand feels the opposite of what it does to the mechanism.
void MechanismTick::Feel(int periods, const Vector6d& charged, const Vector6d& way) noexcept {
  const ContactLaw& law = options_.law;
  w_c_ = law.Wrench(e1_, V_WH_ - dynamics_.Twist(v_));
  FollowWrench(periods * period_);
  F_Ho_ = -(w_d_ + w_c_) - Brake();
  AccountForEnergy(periods * period_, charged.dot(way),
                   options_.scale * dynamics_.Energy() + law.StoredEnergy(e1_));
}

/// As observed, or by a filter of its samples. Returns its way since the last sample.
Vector6d MechanismTick::ReadHand(const TickInput& input, int periods) noexcept {
  const Posed X_WH = input.observed ? PoseOf(input.observed->X) : input.X_WH;
  const Vector6d way = has_hand_ ? HandError(X_WH_, X_WH) : Vector6d::Zero();
  X_WH_ = X_WH;
  if (input.observed) {
    V_WH_ = Vector6Of(input.observed->V);
  } else {
    hand_step_ = way;
    hand_.Update(hand_step_, periods);
    V_WH_ = hand_.v();
  }
  FindRest(periods * period_);
  has_hand_ = true;
  return way;
}

void MechanismTick::FindRest(double elapsed) noexcept {
  const Vector6d away = HandError(X_rest_, X_WH_);
  resting_ += elapsed;
  const bool left =
      away.head<3>().norm() > resolution_ || away.tail<3>().norm() > angular_resolution_;
  if (left || !has_hand_) {
    X_rest_ = X_WH_;
    resting_ = 0;
  }
  V_WH_ *= Moving();
}

/// 1 for a hand in motion, 0 at rest.
double MechanismTick::Moving() const noexcept {
  return std::clamp(2 - resting_ / kRest, 0.0, 1.0);
}

/// Velocities of the nearest pose, and what its inertia goes with. A pose that is held stands.
bool MechanismTick::FindMotion(int periods) noexcept {
  const bool follows = !IsHeld(track_);
  if (follows) tracker_.ComputeCurvature(&S_);
  const Vector6d V_WH = follows ? V_WH_ : Vector6d::Zero();
  e1_ = HandError(X_WG_, X_WH_);
  if (!dynamics_.FindVelocities(V_WH, follows ? &S_ : nullptr, e1_.tail<3>())) return false;
  const double elapsed = periods * period_;
  FindShare(elapsed);
  if (options_.estimator.kind == EstimatorKind::kObserver) {
    v_ = dynamics_.v();
    RollOff(v_, elapsed);
  } else {
    Estimate(periods);
  }
  FindFeltMotion(elapsed);
  return true;
}

/// u' = (v - u) / t, by implicit steps.
void MechanismTick::RollOff(const VectorXd& v, double elapsed) noexcept {
  udot_ = (v - u_) / (options_.roll_off + elapsed);
  u_ += elapsed * udot_;
}

/// From the steps of q (paper section 4).
void MechanismTick::Estimate(int periods) noexcept {
  CoordinateDifference(tree_, last_q_, tracker_.q(), &q_step_);
  last_q_ = tracker_.q();
  coordinates_.Update(q_step_, periods);
  const double moving = Moving();
  v_ = moving * coordinates_.v();
  if (!FindsAccelerations(options_.estimator.kind)) return RollOff(v_, periods * period_);
  u_ = v_;
  udot_ = moving * coordinates_.a();
}

void MechanismTick::FindShare(double elapsed) noexcept {
  const double ratio = options_.scale * dynamics_.InertiaRatio(options_.handle_masses);
  double share = options_.inertia;
  if (share * ratio > options_.inertia_ratio) share = options_.inertia_ratio / ratio;
  share_ += (share_ > 0 ? 1 - std::exp(-elapsed / kShareTime) : 1) * (share - share_);
  if (last_root_ == 0) last_root_ = std::sqrt(share_);
  least_share_ = std::min(least_share_, share_);
}

/// The momentum of s M goes with s^1/2 (s^1/2 u)'.
void MechanismTick::FindFeltMotion(double elapsed) noexcept {
  const double root = std::sqrt(share_);
  felt_rate_ = share_ * udot_;
  // The change of s alone, over the time in which it happened.
  felt_rate_ += (root * (root - last_root_) / elapsed) * u_;
  last_root_ = root;
  felt_ = root * u_;
}

/// The mechanism can gain energy that no hand has given: where the nearest pose leaps or is caught
/// up with, or the hand is not charged for all that moves it. Such a gain is no debt of the hand's,
/// but what the hand is given from then on is, until it is paid back.
void MechanismTick::AccountForEnergy(double elapsed, double given, double energy) noexcept {
  if (starts_) energy_ = energy;
  starts_ = false;
  // Encoder steps to and fro are no gift: what counts is the mean.
  mean_given_ += std::min(1.0, elapsed / kMean) * (given - mean_given_);
  unpaid_ = std::max(0.0, unpaid_ + energy - energy_ + given - std::max(0.0, mean_given_));
  energy_ = energy;
}

/// w_d as felt: within what the device can exert, without leaps, and nothing at a pose that is
/// held.
void MechanismTick::FollowWrench(double elapsed) noexcept {
  const double most = options_.slew * elapsed;
  Vector6d target = Vector6d::Zero();
  if (!IsHeld(track_)) target = options_.scale * dynamics_.w_d();
  target *= ShareWithin(target, options_.max_force, options_.max_moment);
  const Vector6d change = target - w_d_;
  w_d_ += ShareWithin(change, most, 0.1 * most) * change;
}

/// A damper for what a velocity has beyond the largest, of a fourth of what the handle's masses
/// bear.
Vector6d MechanismTick::Brake() const noexcept {
  const auto beyond = [](const Vector3d& V, double most) -> Vector3d {
    const double speed = V.norm();
    return speed > most ? Vector3d((1 - most / speed) * V) : Vector3d::Zero();
  };
  Vector6d brake;
  brake << beyond(V_WH_.head<3>(), options_.max_speed),
      beyond(V_WH_.tail<3>(), options_.max_angular_speed);
  return 0.25 / period_ * options_.handle_masses.cwiseProduct(brake);
}

void MechanismTick::Report(std::span<double> channels) noexcept {
  channels[0] = e1_.head<3>().norm();
  channels[1] = e1_.tail<3>().norm();
  channels[2] = dynamics_.w_d().head<3>().norm();
  channels[3] = static_cast<double>(track_);
  channels[4] = share_;
  channels[5] = unpaid_;
  peaks_.Add(dynamics_.joints(), channels.subspan(kOwnChannels));
}

std::string MechanismTick::FullReport() const {
  return fmt::format("  {}\n  inertia felt: {:.3g} % of the mechanism's at least\n{}",
                     tracking().BriefReport(), 100 * least_share_, peaks_.Report());
}

}  // namespace vmech
