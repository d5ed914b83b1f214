#include "vmech/hw_interface/rendering/contact_law.h"

#include <algorithm>

namespace vmech {
namespace {

/// 1 + a d', d the length of `way`, never below zero.
double Stiffening(const Vector3d& way, const Vector3d& rate, double loss) {
  const double d = way.norm();
  return d > 0 ? std::max(0.0, 1 + loss * way.dot(rate) / d) : 1;
}

}  // namespace

Vector6d ContactLaw::Wrench(const Vector6d& e1, const Vector6d& rate) const noexcept {
  Vector6d w_c = stiffness.cwiseProduct(e1);
  if (kind == ContactKind::kViscoelastic) w_c += damping.cwiseProduct(rate);
  if (kind == ContactKind::kHuntCrossley) {
    w_c.head<3>() *= Stiffening(e1.head<3>(), rate.head<3>(), loss);
    w_c.tail<3>() *= Stiffening(e1.tail<3>(), rate.tail<3>(), angular_loss);
  }
  return w_c;
}

}  // namespace vmech
