#include "vmech/dynamics/simulation/equations/index_two.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {

IndexTwo::IndexTwo(const PreparedSimulation& prepared, EquationsOfMotion* equations)
    : prepared_(prepared),
      equations_(*equations),
      rank_(prepared.mobility.rank),
      row_scale_(LoopRowScale(prepared.model.tree)) {
  if (equations->contacts().empty()) return;
  throw std::invalid_argument(
      "the method idas knows no dry friction and no limits of joints, but the mechanism has some; "
      "take adams, bdf or automatic");
}

/// G [constraints, nv] at the pose that is set.
MatrixXd IndexTwo::Rows() const {
  const KinematicTree& tree = equations_.tree();
  const MatrixXd C =
      row_scale_.asDiagonal() * DenseLoopJacobian(tree, equations_.motion().ws().tree);
  MatrixXd G = MatrixXd::Zero(constraints(), tree.nv);
  if (rank_ > 0) G.topRows(rank_) = basis_.transpose() * C;
  const std::vector<int> driven = DrivenVelocities(prepared_.simulation, tree);
  for (int k = 0; k < equations_.drives(); ++k) G(rank_ + k, driven[static_cast<size_t>(k)]) = 1;
  return G;
}

/// The smallest pivot of G over the largest, dimensionless.
double IndexTwo::LeastPivot() const {
  const MatrixXd G = Rows() * VelocityScale(equations_.tree()).asDiagonal();
  if (G.rows() == 0) return 1;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(G.transpose());
  return std::abs(qr.matrixQR()(G.rows() - 1, G.rows() - 1)) / qr.maxPivot();
}

void IndexTwo::ChooseRows() {
  const KinematicTree& tree = equations_.tree();
  const MatrixXd C = row_scale_.asDiagonal() *
                     DenseLoopJacobian(tree, equations_.motion().ws().tree) *
                     VelocityScale(tree).asDiagonal();
  if (rank_ > 0) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(C);
    basis_ = qr.householderQ() * MatrixXd::Identity(C.rows(), rank_);
  }
  best_pivot_ = LeastPivot();
}

bool IndexTwo::ChoosesBadly(double time, const double* y) {
  constexpr double kWorn = 0.5;
  equations_.Place(time, y, y + equations_.tree().nq);
  return LeastPivot() < kWorn * best_pivot_;
}

void IndexTwo::Start(double time, VectorXd* y, VectorXd* slopes) {
  const KinematicTree& tree = equations_.tree();
  y->conservativeResize(size());
  *slopes = VectorXd::Zero(size());
  y->tail(2 * constraints()).setZero();
  equations_.Slopes(time, y->data(), slopes->data());
  from_singular_ = equations_.IsSingular();
  ChooseRows();
  VectorXd F(size());
  Residual(time, y->data(), slopes->data(), F.data());
  // What is left of M v' + h = forces is what the multipliers make up for.
  const VectorXd open = F.segment(tree.nq, tree.nv);
  y->segment(equations_.size(), constraints()) = -MinimumNormSolution(Rows().transpose(), open);
}

bool IndexTwo::Residual(double time, const double* y, const double* slopes, double* F) {
  const KinematicTree& tree = equations_.tree();
  const int nq = tree.nq, nv = tree.nv, n = constraints();
  using Vector = Eigen::Map<const VectorXd>;
  const Vector v(y + nq, nv), l(y + equations_.size(), n), m(y + equations_.size() + n, n);
  equations_.TakeState(time, y, y + nq, slopes + nq);
  if (equations_.IsSingular() && !from_singular_) return false;
  LoadWorkspace<double>& ws = equations_.motion().ws();
  const MatrixXd G = Rows();
  Eigen::Map<VectorXd> out(F, size());
  const VectorXd moved = v + G.transpose() * m;
  CoordinateRates(tree, y, moved.data(), F);
  out.head(nq) -= Vector(slopes, nq);
  out.segment(nq, nv) = ws.tau - ws.passive + G.transpose() * l;
  const Vector powers(slopes + nq + nv, 2);
  out[nq + nv] = powers[0] - equations_.forces().SuppliedPower(equations_.motion());
  out[nq + nv + 1] = powers[1] - equations_.forces().LostPower(equations_.motion());
  out.segment(nq + nv + 2, n) = G * v;
  const VectorXd errors = row_scale_.cwiseProduct(StackedLoopErrors(tree, ws.tree));
  if (rank_ > 0) out.segment(nq + nv + 2 + n, rank_) = basis_.transpose() * errors;
  for (int k = 0; k < equations_.drives(); ++k) {
    const JointDrive& drive = prepared_.simulation.drives[static_cast<size_t>(k)];
    const MotionSample sample = drive.law.At(time);
    out[nq + nv] += l[rank_ + k] * sample.velocity;
    out[nq + nv + 2 + rank_ + k] -= sample.velocity;
    out[nq + nv + 2 + n + rank_ + k] =
        y[CoordinateIndex(tree, drive.joint, drive.freedom)] - sample.position;
  }
  return out.allFinite();
}

std::vector<bool> IndexTwo::Differential() const {
  std::vector<bool> differential(static_cast<size_t>(size()), false);
  std::fill_n(differential.begin(), equations_.size(), true);
  return differential;
}

}  // namespace vmech
