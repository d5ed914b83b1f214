#include "vmech/dynamics/in_hand/closing_step.h"

#include <cmath>

#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr int kClosingSteps = 5;
constexpr double kClosed = 3e-11;      // [-] where the closing stops
constexpr double kStillClosed = 1e-9;  // [-] beyond, a step is not taken
constexpr double kSameWay = 1e-3;      // of a velocity, across the last
constexpr double kMuchFaster = 10;     // than in the last step

double SquaredNorm(const VectorXd& a) {
  return DotOfDouble4(a.data(), a.data(), static_cast<int>(a.size()));
}

}  // namespace

ClosingStep::ClosingStep(const KinematicTree& tree, const GraspedMechanism& pose)
    : tree_(tree),
      x_(VectorXd::Zero(PaddedSize(tree.nv))),
      correction_(x_),
      zero_(x_),
      predicted_defect_(VectorXd::Zero(pose.e2().size())),
      last_closure_defect_(predicted_defect_) {}

bool ClosingStep::Close(const VectorXd& q, const VectorXd& v, const VectorXd& next_v,
                        const VectorXd& d, double step, SaddleSystem* system,
                        GraspedMechanism* pose, VectorXd* next_q) noexcept {
  if (tree_.loops.empty()) {
    x_ = step * next_v;
  } else {
    Predict(v, next_v, d, step, system, pose);
  }
  *next_q = q;
  for (int i = 0;; ++i) {
    MoveCoordinates(tree_, x_.data(), next_q->data());
    pose->SetLoops(*next_q);
    if (tree_.loops.empty()) return true;
    if (i == 0) last_closure_defect_ += pose->e2();
    squared_closure_ = SquaredNorm(pose->e2());
    if (i == kClosingSteps || squared_closure_ <= kClosed * kClosed ||
        !std::isfinite(squared_closure_)) {
      return squared_closure_ <= kStillClosed * kStillClosed;
    }
    system->SolveOnce(pose->C(), zero_, pose->e2(), &x_);
  }
}

bool ClosingStep::Reclose(const VectorXd& q, SaddleSystem* system, GraspedMechanism* pose,
                          VectorXd* next_q) noexcept {
  *next_q = q;
  if (tree_.loops.empty()) return true;
  for (int i = 0;; ++i) {
    squared_closure_ = SquaredNorm(pose->e2());
    if (i == kClosingSteps || squared_closure_ <= kClosed * kClosed ||
        !std::isfinite(squared_closure_)) {
      return squared_closure_ <= kStillClosed * kStillClosed;
    }
    system->SolveOnce(pose->C(), zero_, pose->e2(), &x_);
    MoveCoordinates(tree_, x_.data(), next_q->data());
    pose->SetLoops(*next_q);
  }
}

/// Adds to the step what closes the loops at its end, where it leaves errors of
///
///   e2 - T C v+ - T^2/2 C'(v+) v+ = e2 - T d - T^2/2 C'(v+) v+
///
/// and, to third order, the same as the last step. While a mechanism goes on in the direction of
/// the last step, as it must with a single freedom, C'v grows with the square of the speed.
void ClosingStep::Predict(const VectorXd& v, const VectorXd& next_v, const VectorXd& d, double step,
                          SaddleSystem* system, GraspedMechanism* pose) noexcept {
  const double speed2 = SquaredNorm(v);
  const double along = speed2 > 0 ? Dot(next_v.data(), v.data(), tree_.nv) / speed2 : 0;
  x_ = next_v - along * v;
  const double aside2 = SquaredNorm(x_) / (kSameWay * kSameWay);
  if (std::abs(along) < kMuchFaster && aside2 < SquaredNorm(next_v)) {
    predicted_defect_ = pose->e2() - (step * (1 - 0.5 * along * along)) * d + last_closure_defect_;
  } else {
    pose->SetVelocities(next_v);
    pose->ComputeLoopBias(-0.5 * step * step, &predicted_defect_);
    predicted_defect_ += pose->e2() - step * d + last_closure_defect_;
  }
  system->SolveOnce(pose->C(), zero_, predicted_defect_, &correction_);
  x_ = step * next_v + correction_;
}

double ClosingStep::closure() const noexcept {
  return std::sqrt(squared_closure_);
}

}  // namespace vmech
