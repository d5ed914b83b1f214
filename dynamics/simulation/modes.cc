#include "vmech/dynamics/simulation/modes.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/dynamics/simulation/equations/small_motions.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"

namespace vmech {
namespace {

/// Of the largest eigenvalue: less is rounding.
constexpr double kNone = 1e-9;

/// Motions that have inertia; along the others springs give way at once.
struct Condensed {
  MatrixXd M, D, K;
  MatrixXd motions;            ///< [freedoms, those with inertia]
  bool is_damped_off = false;  ///< dampers act along the others
};

/// `scale`: what of each freedom counts as one; inertia is compared in these units.
Condensed Condense(const MatrixXd& M, const MatrixXd& D, const MatrixXd& K, const VectorXd& scale,
                   double no_inertia) {
  const auto unit = scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> inertia(MatrixXd(unit * M * unit));
  const auto n = M.rows(), without = (inertia.eigenvalues().array() <= no_inertia).count();
  const MatrixXd light = unit * inertia.eigenvectors().leftCols(without);
  MatrixXd motions = unit * inertia.eigenvectors().rightCols(n - without);
  const MatrixXd K_light = light.transpose() * K * light;
  const double stiffest = (unit * K * unit).lpNorm<Eigen::Infinity>();
  if (without > 0 && K_light.lpNorm<Eigen::Infinity>() > kNone * stiffest) {
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> given_way(K_light);
    given_way.setThreshold(kNone);
    motions -= light * given_way.solve(light.transpose() * K * motions);
  }
  const bool damped = without > 0 && (light.transpose() * D * unit).lpNorm<Eigen::Infinity>() >
                                         kNone * (unit * D * unit).lpNorm<Eigen::Infinity>();
  const auto reduced = [&](const MatrixXd& A) -> MatrixXd {
    return motions.transpose() * A * motions;
  };
  return {reduced(M), reduced(D), reduced(K), motions, damped};
}

Mode MakeMode(std::complex<double> eigenvalue, const Eigen::VectorXcd& x, const MatrixXd& N,
              const VectorXd& scale) {
  Mode mode;
  mode.eigenvalue = eigenvalue;
  mode.frequency = std::abs(eigenvalue.imag()) / (2 * std::numbers::pi);
  const double size = std::abs(eigenvalue);
  mode.damping_ratio = size > 0 ? -eigenvalue.real() / size : 0;
  mode.shape = N * x;
  Eigen::Index largest = 0;
  mode.shape.cwiseQuotient(scale.cast<std::complex<double>>()).cwiseAbs().maxCoeff(&largest);
  mode.shape *= scale[largest] / mode.shape[largest];
  return mode;
}

/// K x = w^2 M x: to the last digits, and pairs that meet at zero are exactly there.
void AddUndamped(const Condensed& c, const MatrixXd& N, const VectorXd& scale, Modes* modes) {
  const MatrixXd K = 0.5 * (c.K + c.K.transpose());
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K, c.M);
  const double largest = eigen.eigenvalues().lpNorm<Eigen::Infinity>();
  for (Eigen::Index i = 0; i < K.rows(); ++i) {
    const double square = eigen.eigenvalues()[i];
    std::complex<double> eigenvalue = 0;
    if (std::abs(square) > kNone * largest) eigenvalue = std::sqrt(std::complex<double>(-square));
    const Eigen::VectorXcd x = eigen.eigenvectors().col(i).cast<std::complex<double>>();
    modes->modes.push_back(MakeMode(eigenvalue, N * x, modes->free_motions, scale));
    if (square < -kNone * largest) modes->stability = Stability::kUnstable;
    if (eigenvalue == 0.0 && modes->stability == Stability::kStable) {
      modes->stability = Stability::kNeutral;
    }
  }
}

/// [x; x']' = [0 1; -M^-1 K  -M^-1 D] [x; x'].
void AddDamped(const Condensed& c, const MatrixXd& N, const VectorXd& scale, Modes* modes) {
  const Eigen::Index n = c.M.rows();
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  const Eigen::LLT<MatrixXd> inertia(c.M);
  A.bottomLeftCorner(n, n) = -inertia.solve(c.K);
  A.bottomRightCorner(n, n) = -inertia.solve(c.D);
  const Eigen::EigenSolver<MatrixXd> eigen(A);
  const double largest = eigen.eigenvalues().lpNorm<Eigen::Infinity>();
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    std::complex<double> eigenvalue = eigen.eigenvalues()[i];
    if (eigenvalue.imag() < 0) continue;  // the other one of a pair
    if (std::abs(eigenvalue) <= kNone * largest) eigenvalue = 0;
    const Eigen::VectorXcd x = eigen.eigenvectors().col(i).head(n);
    modes->modes.push_back(MakeMode(eigenvalue, N * x, modes->free_motions, scale));
    if (eigenvalue.real() > kNone * largest) modes->stability = Stability::kUnstable;
    if (eigenvalue == 0.0 && modes->stability == Stability::kStable) {
      modes->stability = Stability::kNeutral;
    }
  }
}

bool IsSymmetric(const MatrixXd& K) {
  return (K - K.transpose()).lpNorm<Eigen::Infinity>() <= kNone * K.lpNorm<Eigen::Infinity>();
}

/// Of a mechanism without inertia along any freedom.
Stability JudgeBySprings(const MatrixXd& K) {
  const VectorXd k =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (K + K.transpose())).eigenvalues();
  const double none = kNone * k.lpNorm<Eigen::Infinity>();
  if (k.minCoeff() < -none) return Stability::kUnstable;
  return k.minCoeff() > none ? Stability::kStable : Stability::kNeutral;
}

void FindModesOf(SmallMotions* motions, Modes* modes) {
  const VectorXd& scale = motions->scale();
  modes->mass = motions->Inertia();
  modes->stiffness = motions->Stiffness();
  modes->damping = motions->Damping();
  modes->free_motions = motions->FreeMotions();
  for (const int v : motions->velocities()) {
    modes->freedoms.push_back(NameOfVelocity(motions->tree(), v));
  }
  const Condensed c = Condense(modes->mass, modes->damping, modes->stiffness, scale,
                               motions->prepared().model.no_inertia);
  if (c.is_damped_off) {
    modes->warnings.push_back(
        "dampers act along motions without inertia, whose decay is not among the modes, nor what "
        "it does to the others; give the links that take part in them mass and inertia");
  }
  if (c.M.rows() == 0) {
    modes->stability = JudgeBySprings(modes->stiffness);
    return;
  }
  const VectorXd all = VelocityScale(motions->tree());
  const bool undamped = c.D.lpNorm<Eigen::Infinity>() == 0 && IsSymmetric(c.K);
  (undamped ? AddUndamped : AddDamped)(c, c.motions, all, modes);
  std::stable_sort(modes->modes.begin(), modes->modes.end(), [](const Mode& a, const Mode& b) {
    return std::abs(a.eigenvalue) < std::abs(b.eigenvalue);
  });
}

}  // namespace

Modes FindModes(const Simulation& simulation) {
  constexpr double kBalanced = 1e-6;
  SmallMotions motions(AtItsStart(simulation));
  Modes modes;
  modes.tree = motions.tree();
  modes.q = motions.q();
  if (motions.freedoms() == 0) return modes;
  FindModesOf(&motions, &modes);
  const VectorXd force = motions.Force(motions.q(), VectorXd::Zero(motions.freedoms()));
  modes.residual = force.lpNorm<Eigen::Infinity>();
  if (modes.residual >
      kBalanced * modes.stiffness.lpNorm<Eigen::Infinity>() * motions.scale().maxCoeff()) {
    modes.warnings.push_back(fmt::format(
        "the pose is no equilibrium: {:.3g} N or N m are left along a free motion, and the "
        "mechanism moves off; start at its equilibrium, or take the modes for those of a moment",
        modes.residual));
  }
  return modes;
}

}  // namespace vmech
