#include "vmech/hw_interface/rendering/closing_hand.h"

#include <algorithm>

#include "vmech/base/rotation_error.h"

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

CoupledStatus ClosingHand::Step(const Posed& X_WH, const Vector6d& V_WH,
                                CoupledDynamics* dynamics) noexcept {
  const GraspFrame grasp = dynamics->pose().grasp();
  const Vector6d V_WG = dynamics->V_WG() + change_;
  const Vector6d e = HandError(dynamics->X_WG(), X_WH) - step_ * V_WG;
  const Vector6d slip = V_WH - V_WG;
  const Vector6d pull = coupling_.stiffness.cwiseProduct(e) + coupling_.damping.cwiseProduct(slip);
  Vector6d share;
  share << Vector3d::Constant(ShareOf(pull.head<3>().norm(), hold_)),
      Vector3d::Constant(ShareOf(pull.tail<3>().norm(), kLever * hold_));
  if (share.minCoeff() < 1) {
    const Posed X_WB = dynamics->pose().X_WB(grasp.node);
    const Posed X_WG = Displaced(dynamics->X_WG(), e - share.cwiseProduct(e));
    dynamics->GraspAt({grasp.node, X_WB.inverse() * X_WG, grasp.kind});
  }
  // The frame that has slid has another velocity on a turning link.
  const Vector6d before = dynamics->V_WG(), expected = before + change_;
  const Posed X_asked = Displaced(dynamics->X_WG(), share.cwiseProduct(e) + step_ * expected);
  const bool first = hold_ == 0;
  if (first) dynamics->LetGo();
  const CoupledStatus status = dynamics->Step(X_asked, expected + share.cwiseProduct(slip));
  if (first) dynamics->GraspAt(dynamics->pose().grasp());
  hold_ += step_ * rate_;
  Foresee(status == CoupledStatus::kMoved ? (dynamics->V_WG() - before).eval() : Vector6d::Zero());
  return status;
}

void ClosingHand::Foresee(const Vector6d& change) noexcept {
  const double most = kSwiftest * step_;
  change_.head<3>() = ShareOf(change.head<3>().norm(), most) * change.head<3>();
  change_.tail<3>() = ShareOf(kLever * change.tail<3>().norm(), most) * change.tail<3>();
}

}  // namespace vmech
