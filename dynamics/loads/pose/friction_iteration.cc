#include "vmech/dynamics/loads/pose/friction_iteration.h"

#include <algorithm>

#include "vmech/base/linear_algebra/linear_algebra.h"

namespace vmech {
namespace {

constexpr int kMaxIterations = 200;
/// Small enough to stay with the equilibrium that grows out of the one without friction: beyond the
/// cone of friction there is a second, in which the loads have turned round.
constexpr double kFirstRelaxation = 0.25;
constexpr int kMixed = 8;             // iterates
constexpr double kTolerance = 1e-13;  // change of the largest joint load, relative

void Read(const std::vector<JointLoad<double>>& loads, double length, VectorXd* x) {
  x->resize(static_cast<Eigen::Index>(6 * loads.size()));
  for (size_t j = 0; j < loads.size(); ++j) {
    const Wrenchd& W = loads[j].W_F;
    x->segment<6>(static_cast<Eigen::Index>(6 * j)) << W.force, W.moment / length;
  }
}

void Write(const VectorXd& x, double length, std::vector<JointLoad<double>>* loads) {
  for (size_t j = 0; j < loads->size(); ++j) {
    const auto at = static_cast<Eigen::Index>(6 * j);
    (*loads)[j].W_F = {x.segment<3>(at), x.segment<3>(at + 3) * length};
  }
}

}  // namespace

bool FrictionIteration::Run(double length, std::vector<JointLoad<double>>* loads,
                            const std::function<void()>& pass) {
  Read(*loads, length, &start_);
  if (Iterate(length, loads, pass, &FrictionIteration::RelaxByAitken)) return true;
  Write(start_, length, loads);
  return Iterate(length, loads, pass, &FrictionIteration::MixByAnderson);
}

bool FrictionIteration::Iterate(double length, std::vector<JointLoad<double>>* loads,
                                const std::function<void()>& pass,
                                void (FrictionIteration::*step)(int)) {
  x_ = start_;
  for (int i = 0; i < kMaxIterations; ++i) {
    pass();
    Read(*loads, length, &G_);
    residual_ = G_ - x_;
    if (!residual_.allFinite()) return false;
    if (Settled()) return true;
    (this->*step)(i);
    Write(x_, length, loads);
  }
  return false;
}

bool FrictionIteration::Settled() const {
  return residual_.size() == 0 ||
         residual_.cwiseAbs().maxCoeff() <= kTolerance * G_.cwiseAbs().maxCoeff();
}

void FrictionIteration::RelaxByAitken(int iteration) {
  if (iteration == 0) {
    beta_ = kFirstRelaxation;
  } else {
    const double along = last_residual_.dot(residual_ - last_residual_);
    const double across = (residual_ - last_residual_).squaredNorm();
    if (across > 0) beta_ *= -along / across;
  }
  last_residual_ = residual_;
  x_ += beta_ * residual_;
}

/// x += beta r - (dX + beta dR) g with g of min |r - dR g|.
void FrictionIteration::MixByAnderson(int iteration) {
  if (iteration == 0) {
    steps_ = MatrixXd::Zero(x_.size(), kMixed);
    changes_ = steps_;
  } else {
    changes_.col((iteration - 1) % kMixed) = residual_ - last_residual_;
  }
  last_residual_ = residual_;
  VectorXd step = kFirstRelaxation * residual_;
  const int count = std::min(iteration, kMixed);
  if (count > 0) {
    const VectorXd g = MinimumNormSolution(changes_.leftCols(count), residual_);
    step -= (steps_.leftCols(count) + kFirstRelaxation * changes_.leftCols(count)) * g;
  }
  steps_.col(iteration % kMixed) = step;
  x_ += step;
}

}  // namespace vmech
