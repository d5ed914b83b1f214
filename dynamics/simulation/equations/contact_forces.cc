#include "vmech/dynamics/simulation/equations/contact_forces.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

constexpr int kSweeps = 20000;
constexpr double kConverged = 1e-15;

/// The nearest force that the contact can exert.
void Limit(const HeldContact& contact, Vector3d* F) {
  if (contact.kind == HeldContact::Kind::kStop) {
    (*F)[0] = contact.side * std::min(0.0, contact.side * (*F)[0]);
  }
  if (contact.kind != HeldContact::Kind::kFriction) return;
  double share2 = 0;
  for (int k = 0; k < contact.count; ++k) {
    const double limit = contact.limits[k];
    if (limit > 0) share2 += (*F)[k] * (*F)[k] / (limit * limit);
    if (limit <= 0) (*F)[k] = 0;
  }
  if (share2 > 1) *F /= std::sqrt(share2);
}

/// Forces that a slope u of the contact's rates asks for, in the metric in which its limits are a
/// ball, so that friction ends up against the sliding.
Vector3d Step(const HeldContact& contact, const MatrixXd& W, const VectorXd& u) {
  Vector3d step = Vector3d::Zero();
  double per_force = 0, largest2 = 0;
  const bool shared = contact.kind == HeldContact::Kind::kFriction && contact.count > 1;
  for (int k = 0; k < contact.count; ++k) {
    const double scale2 = shared ? contact.limits[k] * contact.limits[k] : 1;
    per_force += scale2 * W(contact.first + k, contact.first + k);
    step[k] = -scale2 * u[contact.first + k];
    largest2 = std::max(largest2, scale2);
  }
  if (!(per_force > 0)) return Vector3d::Zero();
  return step / per_force;
}

}  // namespace

ContactForces SolveContacts(const MatrixXd& W, const VectorXd& b,
                            const std::vector<HeldContact>& contacts, const VectorXd& start) {
  ContactForces result{start, b + W * start};
  VectorXd &F = result.F, &u = result.u;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (const HeldContact& contact : contacts) {
      Vector3d next = Step(contact, W, u);
      next.head(contact.count) += F.segment(contact.first, contact.count);
      Limit(contact, &next);
      for (int k = 0; k < contact.count; ++k) {
        const int row = contact.first + k;
        const double step = next[k] - F[row];
        F[row] = next[k];
        u += step * W.col(row);
        change = std::max(change, std::abs(step) * W(row, row));
      }
    }
    if (change <= kConverged * (b.lpNorm<Eigen::Infinity>() + u.lpNorm<Eigen::Infinity>())) break;
  }
  return result;
}

}  // namespace vmech
