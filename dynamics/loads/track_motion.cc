#include "vmech/dynamics/loads/track_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

#include "vmech/base/lanes4.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/dynamics/loads/pose/idle_freedoms.h"
#include "vmech/dynamics/loads/pose/resting_friction.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/solvers/nullspace.h"

namespace vmech {
namespace {

/// Moves the mechanism with its drives.
class Tracker {
 public:
  Tracker(const LoadStudy& study, const PreparedStudy& prepared, double tolerance,
          std::pmr::memory_resource* memory)
      : study_(study),
        model_(prepared.model),
        tree_(model_.tree),
        tolerance_(tolerance),
        ws_(tree_),
        dependents_(tree_, model_.partition),
        packet_ws_(tree_),
        packet_dependents_(tree_, model_.partition),
        packet_q_(tree_.nq, Lanes4(0)),
        packet_predicted_(packet_q_),
        idle_(model_),
        q_(prepared.q_start),
        q_trial_(q_),
        q_past_{q_, q_, q_},
        step_(VectorXd::Zero(tree_.nv)),
        cut_positions_(StartCutPositions(tree_)),
        motion_{std::pmr::vector<double>(memory), std::pmr::vector<double>(memory),
                std::pmr::vector<MotionSample>(memory), std::pmr::vector<HandSample>(memory),
                std::pmr::vector<Vector3d>(memory)} {
    for (const JointDrive& drive : study.drives) {
      const int q = CoordinateIndex(tree_, drive.joint, drive.freedom);
      coordinate_.push_back(q);
      position_.push_back(q_[q]);
    }
    if (study.hand) {
      hand_.emplace(
          tree_, GraspFrameOf(tree_, study.hand->grasp),
          InverseKinematicsOptions{.stiffness = model_.hand_stiffness, .joint_limits = false});
    }
    EvaluatePose(tree_, q_, &ws_);
    idle_.Remember(ws_);
    ContinueCutPositions(tree_, ws_, &cut_positions_);
    motion_.times.reserve(study.times.size());
    motion_.drives.reserve(study.times.size() * study.drives.size());
    motion_.coordinates.reserve(study.times.size() * tree_.nq);
    motion_.cut_positions.reserve(study.times.size() * tree_.loops.size());
    if (study.hand) motion_.hand.reserve(study.times.size());
  }

  /// From the assembled start to where the motion begins.
  void Approach() {
    if (study_.hand) return Follow(study_.times.front(), 0);
    const std::vector<double> from = position_;
    for (int step = 1; step <= kApproachSteps; ++step) {
      const double s = static_cast<double>(step) / kApproachSteps;
      for (size_t k = 0; k < position_.size(); ++k) {
        const double to = study_.drives[k].law.At(study_.times.front()).position;
        target_.push_back(from[k] + s * (to - from[k]));
      }
      MoveTo(target_, study_.times.front(), 0, 0);
      SettleIdle();
      target_.clear();
    }
    history_ = 0;
  }

  void Advance(double time, size_t pose) {
    AllowForTurns();
    if (study_.hand) return Follow(time, pose);
    target_.clear();
    for (const JointDrive& drive : study_.drives) target_.push_back(drive.law.At(time).position);
    MoveTo(target_, time, pose, 0);
    SettleIdle();
  }

  /// Four poses at once, if their predictions are good enough; otherwise nothing is done.
  bool AdvancePacket(const double* times) {
    if (study_.hand || model_.idle > 0 || history_ < 3) return false;
    AllowForTurns();
    const size_t first = motion_.size();
    for (int lane = 0; lane < Lanes4::kLanes; ++lane) RecordDrives(times[lane]);
    PredictPacket(first);
    const Lanes4 error = CloseByNewton(tree_, tolerance_, kNewtonSteps, &packet_dependents_,
                                       &packet_ws_, packet_q_.data());
    if (!AllLanes(error <= Lanes4(tolerance_)) || !StaysOnBranch()) {
      ForgetDrives(first);
      return false;
    }
    for (size_t l = 0; l < tree_.loops.size(); ++l) {
      packet_cut_[l] = CutJointCoordinates(tree_.loops[l], packet_ws_.loops[l]);
    }
    for (int lane = 0; lane < Lanes4::kLanes; ++lane) {
      q_past_[2].swap(q_past_[1]);
      q_past_[1].swap(q_past_[0]);
      q_past_[0].swap(q_);
      TakeLane(lane, &q_);
    }
    for (size_t k = 0; k < position_.size(); ++k) position_[k] = q_[coordinate_[k]];
    return true;
  }

  void Record(double time) {
    RecordDrives(time);
    if (study_.hand) motion_.hand.push_back(study_.hand->law.At(time));
    RecordPose(q_);
  }

  Motion TakeMotion() {
    motion_.speed = LargestSpeed();
    return std::move(motion_);
  }

 private:
  static constexpr int kApproachSteps = 16;
  static constexpr int kDeepestHalving = 20;
  static constexpr int kNewtonSteps = 6;
  static constexpr double kSettled = 1e-12;    ///< KKT error of a pose that a hand has led to
  static constexpr double kLongestStep = 0.5;  ///< after a hand [rad], or metres: on one branch
  /// A correction of the predicted pose beyond this share of the step, or these radians, is not
  /// trusted to stay on the branch.
  static constexpr double kTrustedShare = 0.5;
  static constexpr double kTrustedTurn = 0.02;

  /// An angle of many turns has lost the digits that its whole turns take.
  void AllowForTurns() {
    constexpr double kDigits = 4 * std::numeric_limits<double>::epsilon();
    tolerance_ = std::max(tolerance_, kDigits * q_.lpNorm<Eigen::Infinity>());
  }

  /// Moves all drives to the target, in halves where one step is not safe.
  void MoveTo(const std::vector<double>& target, double time, size_t pose, int depth) {
    if (TryStep(target)) return;
    if (depth >= kDeepestHalving) ThrowCannotFollow(time, pose);
    std::vector<double> middle(target.size());
    for (size_t k = 0; k < target.size(); ++k) middle[k] = 0.5 * (position_[k] + target[k]);
    history_ = 0;
    MoveTo(middle, time, pose, depth + 1);
    history_ = 0;
    MoveTo(target, time, pose, depth + 1);
    history_ = 0;
  }

  bool TryStep(const std::vector<double>& target) {
    q_trial_ = q_;
    const double size = Predict(target);
    for (size_t k = 0; k < target.size(); ++k) q_trial_[coordinate_[k]] = target[k];
    q_predicted_ = q_trial_;
    const double error =
        CloseByNewton(tree_, tolerance_, kNewtonSteps, &dependents_, &ws_, q_trial_.data());
    const double correction = (q_trial_ - q_predicted_).lpNorm<Eigen::Infinity>();
    if (!(error <= tolerance_) || correction > kTrustedShare * size + kTrustedTurn) return false;
    Accept();
    position_ = target;
    ContinueCutPositions(tree_, ws_, &cut_positions_);
    return true;
  }

  /// Along the last step if it was as long as this one, else along the tangent. Returns the size.
  double Predict(const std::vector<double>& target) {
    if (history_ > 0) {
      Extrapolate();
      return (q_trial_ - q_).lpNorm<Eigen::Infinity>();
    }
    EvaluatePose(tree_, q_, &ws_);
    dependents_.Factor(ws_);
    step_.setZero();
    for (size_t k = 0; k < target.size(); ++k) {
      step_[model_.partition.driven[k]] = target[k] - position_[k];
    }
    dependents_.CompleteVelocities(ws_, step_.data());
    MoveCoordinates(tree_, step_, &q_trial_);
    return step_.lpNorm<Eigen::Infinity>();
  }

  /// The polynomial through the poses so far, taken as equally spaced: after a step or two of
  /// smooth motion one Newton step is left to do. Where the spacing changes Newton does more.
  void Extrapolate() {
    switch (history_) {
      case 1:
        q_trial_ = 2 * q_ - q_past_[0];
        break;
      case 2:
        q_trial_ = 3 * q_ - 3 * q_past_[0] + q_past_[1];
        break;
      default:
        q_trial_ = 4 * q_ - 6 * q_past_[0] + 4 * q_past_[1] - q_past_[2];
        break;
    }
    step_.setZero();
    MoveCoordinates(tree_, step_, &q_trial_);  // quaternions back to unit length
  }

  void RecordDrives(double time) {
    motion_.times.push_back(time);
    for (const JointDrive& drive : study_.drives) motion_.drives.push_back(drive.law.At(time));
  }

  void ForgetDrives(size_t from) {
    motion_.times.resize(from);
    motion_.drives.resize(from * study_.drives.size());
  }

  void RecordPose(const VectorXd& q) {
    for (const double coordinate : q) motion_.coordinates.push_back(coordinate);
    for (const Vector3d& position : cut_positions_) motion_.cut_positions.push_back(position);
  }

  /// Records one pose of a packet and copies it to q.
  void TakeLane(int lane, VectorXd* q) {
    for (int i = 0; i < tree_.nq; ++i) (*q)[i] = packet_q_[i][lane];
    for (size_t l = 0; l < tree_.loops.size(); ++l) {
      ContinueCutPosition(tree_.loops[l].type, Lane(packet_cut_[l], lane), &cut_positions_[l]);
    }
    RecordPose(*q);
  }

  /// The polynomial of Extrapolate, one pose ahead and more.
  void PredictPacket(size_t pose) {
    const Lanes4 n = Lanes4::Of([](int lane) { return lane + 1.0; });
    const Lanes4 a = (n + 1) * (n + 2) * (n + 3) / 6, b = n * (n + 2) * (n + 3) / 2,
                 c = n * (n + 1) * (n + 3) / 2, d = n * (n + 1) * (n + 2) / 6;
    for (int i = 0; i < tree_.nq; ++i) {
      packet_q_[i] = a * q_[i] - b * q_past_[0][i] + c * q_past_[1][i] - d * q_past_[2][i];
    }
    for (size_t k = 0; k < coordinate_.size(); ++k) {
      packet_q_[coordinate_[k]] = FromLanes<Lanes4>([&](int lane) {
        return motion_.drives[(pose + lane) * coordinate_.size() + k].position;
      });
    }
    std::fill(packet_step_.begin(), packet_step_.end(), Lanes4(0));
    MoveCoordinates(tree_, packet_step_.data(), packet_q_.data());  // quaternions to unit length
    packet_predicted_ = packet_q_;
  }

  /// Are the corrections of all four predictions to be trusted?
  bool StaysOnBranch() const {
    Lanes4 size(0), correction(0);
    for (int i = 0; i < tree_.nq; ++i) {
      const Lanes4& predicted = packet_predicted_[i];
      size = max(size, abs(predicted - ShiftIn(q_[i], predicted)));
      correction = max(correction, abs(packet_q_[i] - predicted));
    }
    return AllLanes(correction <= kTrustedShare * size + kTrustedTurn);
  }

  void Accept() {
    q_past_[2].swap(q_past_[1]);
    q_past_[1].swap(q_past_[0]);
    q_past_[0].swap(q_);
    q_ = q_trial_;
    history_ = std::min(history_ + 1, 3);
  }

  void Follow(double time, size_t pose) {
    NullspaceOptions options;
    options.max_step = kLongestStep;
    options.stopping.constraint_tolerance = tolerance_;
    options.stopping.optimality_tolerance = kSettled;
    hand_->SetTarget(study_.hand->law.At(time).X_WH);
    const Summary summary = Solve(*hand_, options, q_);
    q_ = summary.x;
    EvaluatePose(tree_, q_, &ws_);
    if (!summary.converged()) ThrowCannotFollow(time, pose);
    SettleIdle();
    ContinueCutPositions(tree_, ws_, &cut_positions_);
  }

  void SettleIdle() {
    if (model_.idle == 0) return;
    history_ = 0;  // idle freedoms do not go on as they were
    idle_.Settle(tolerance_, &dependents_, &ws_, &q_);
    idle_.Remember(ws_);
    ContinueCutPositions(tree_, ws_, &cut_positions_);
  }

  double LargestSpeed() const {
    double speed = 0;
    const size_t drives = study_.drives.size();
    for (size_t k = 0; k < drives; ++k) {
      const double unit = CreepSpeed(model_, model_.partition.driven[k]);
      for (size_t i = k; i < motion_.drives.size(); i += drives) {
        speed = std::max(speed, std::abs(motion_.drives[i].velocity) / unit);
      }
    }
    for (const HandSample& hand : motion_.hand) {
      speed =
          std::max({speed, hand.V_WH.head<3>().norm() / tree_.length, hand.V_WH.tail<3>().norm()});
    }
    return speed;
  }

  [[noreturn]] void ThrowCannotFollow(double time, size_t pose) const {
    throw std::runtime_error(fmt::format(
        "the motion cannot be followed to pose {} (t = {:.6g} s): {} the mechanism is at a dead "
        "centre or at the edge of its reach, and its loops stay open by {:.3g}. {}",
        pose, time, DrivesAt(study_, position_), LargestLoopError(tree_, ws_), kPastDeadCentre));
  }

  const LoadStudy& study_;
  const LoadModel& model_;
  const KinematicTree& tree_;
  double tolerance_;
  TreeWorkspace<double> ws_;
  DependentSolver<double> dependents_;
  TreeWorkspace<Lanes4> packet_ws_;
  DependentSolver<Lanes4> packet_dependents_;
  std::vector<Lanes4> packet_q_, packet_predicted_;
  std::vector<Vector3<Lanes4>> packet_cut_ = std::vector<Vector3<Lanes4>>(tree_.loops.size());
  std::vector<Lanes4> packet_step_ = std::vector<Lanes4>(tree_.nv, Lanes4(0));
  IdlePositions idle_;
  std::optional<InverseKinematics> hand_;
  VectorXd q_, q_trial_, q_predicted_;
  VectorXd q_past_[3];  ///< accepted poses before q_, the latest first
  VectorXd step_;
  std::vector<int> coordinate_;   ///< index in q of each drive
  std::vector<double> position_;  ///< of each drive
  std::vector<double> target_;
  std::vector<Vector3d> cut_positions_;
  Motion motion_;
  int history_ = 0;  ///< how many of q_past_ lie one pose behind the other
};

}  // namespace

size_t BytesOfMotion(const LoadStudy& study, const KinematicTree& tree) {
  const size_t of_pose = sizeof(double) * static_cast<size_t>(1 + tree.nq) +
                         sizeof(MotionSample) * study.drives.size() +
                         sizeof(HandSample) * (study.hand ? 1 : 0) +
                         sizeof(Vector3d) * tree.loops.size();
  return study.times.size() * of_pose;
}

Motion TrackMotion(const LoadStudy& study, const PreparedStudy& prepared, double closure_tolerance,
                   const std::function<bool()>& goes_on, std::pmr::memory_resource* memory) {
  constexpr size_t kAsked = 4096;  // poses from question to question

  Tracker tracker(study, prepared, std::max(closure_tolerance, prepared.closure_tolerance), memory);
  tracker.Approach();
  const std::vector<double>& times = study.times;
  for (size_t i = 0, next = kAsked; i < times.size();) {
    if (i >= next && goes_on) {
      next += kAsked;
      if (!goes_on()) throw std::runtime_error("the study was stopped before its end");
    }
    if (i + Lanes4::kLanes <= times.size() && tracker.AdvancePacket(&times[i])) {
      i += Lanes4::kLanes;
      continue;
    }
    tracker.Advance(times[i], i);
    tracker.Record(times[i]);
    ++i;
  }
  return tracker.TakeMotion();
}

}  // namespace vmech
