#include "vmech/hw_interface/rendering/closing_hand.h"

#include <algorithm>

#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

constexpr double kLongest = 0.5;   // [s]: until the hand has closed
constexpr double kSwiftest = 300;  // [m/s^2]: that is foreseen; more is a blow, which does not last
constexpr double kLever = 0.1;     // l [m], of a hand

/// The factor that brings a pull within the hold; at most 1.
double ShareOf(double pull, double hold) {
  return pull > hold ? hold / pull : 1;
}

}  // namespace

ClosingHand::ClosingHand(const HandCoupling& coupling, double rate, double step)
    : coupling_(coupling),
      rate_(rate),
      step_(step),
      full_(std::min(coupling.max_force, rate * kLongest)),
      hold_(full_) {}

void ClosingHand::Open() noexcept {
  hold_ = 0;
  change_.setZero();
}

void ClosingHand::BeforeStep(const Posed& X_WH, const Vector6d& V_WH, int hand,
                             CoupledDynamics* dynamics) noexcept {
  const GraspFrame grasp = dynamics->pose().grasp(hand);
  const Vector6d V_WG = dynamics->V_WG(hand) + change_;
  const Vector6d e = HandError(dynamics->X_WG(hand), X_WH) - step_ * V_WG;
  const Vector6d slip = V_WH - V_WG;
  const Vector6d pull = coupling_.stiffness.cwiseProduct(e) + coupling_.damping.cwiseProduct(slip);
  Vector6d share;
  share << Vector3d::Constant(ShareOf(pull.head<3>().norm(), hold_)),
      Vector3d::Constant(ShareOf(pull.tail<3>().norm(), kLever * hold_));
  if (share.minCoeff() < 1) {
    const Posed X_WB = dynamics->pose().X_WB(grasp.node);
    const Posed X_WG = Displaced(dynamics->X_WG(hand), e - share.cwiseProduct(e));
    dynamics->GraspAt({grasp.node, X_WB.inverse() * X_WG, grasp.kind}, hand);
  }
  // The frame that has slid has another velocity on a turning link.
  V_WG_ = dynamics->V_WG(hand);
  const Vector6d expected = V_WG_ + change_;
  const Posed X_asked = Displaced(dynamics->X_WG(hand), share.cwiseProduct(e) + step_ * expected);
  dynamics->SetHand({FrameOf(X_asked), ScrewOf(expected + share.cwiseProduct(slip))}, hand);
  if (hold_ == 0) dynamics->LetGo(hand);
}

void ClosingHand::AfterStep(CoupledStatus status, int hand, CoupledDynamics* dynamics) noexcept {
  if (hold_ == 0) dynamics->GraspAt(dynamics->pose().grasp(hand), hand);
  hold_ += step_ * rate_;
  const bool moved = status == CoupledStatus::kMoved;
  Foresee(moved ? (dynamics->V_WG(hand) - V_WG_).eval() : Vector6d::Zero());
}

void ClosingHand::Foresee(const Vector6d& change) noexcept {
  const double most = kSwiftest * step_;
  change_.head<3>() = ShareOf(change.head<3>().norm(), most) * change.head<3>();
  change_.tail<3>() = ShareOf(kLever * change.tail<3>().norm(), most) * change.tail<3>();
}

}  // namespace vmech
