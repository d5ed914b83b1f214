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

/// Calls visit(number, unit) for each component of the loads' wrenches; dividing by the unit makes
/// moments forces.
template <typename T, typename Visit>
void VisitWrenches(double length, std::vector<JointLoad<T>>* loads, const Visit& visit) {
  for (JointLoad<T>& load : *loads) {
    for (T& component : load.W_F.force) visit(component, 1.0);
    for (T& component : load.W_F.moment) visit(component, length);
  }
}

}  // namespace

struct FrictionIteration::Map {
  std::function<void(VectorXd* x)> read;
  std::function<void(const VectorXd& x)> write;
  const std::function<void()>& pass;

  /// `part(component)` is a reference to what is iterated.
  template <typename T, typename Part>
  static Map Of(double length, std::vector<JointLoad<T>>* loads, const std::function<void()>& pass,
                const Part& part) {
    return {[=](VectorXd* x) {
              x->resize(static_cast<Eigen::Index>(6 * loads->size()));
              double* at = x->data();
              VisitWrenches(length, loads, [&](T& c, double unit) { *at++ = part(c) / unit; });
            },
            [=](const VectorXd& x) {
              const double* at = x.data();
              VisitWrenches(length, loads, [&](T& c, double unit) { part(c) = *at++ * unit; });
            },
            pass};
  }
};

bool FrictionIteration::Run(double length, std::vector<JointLoad<double>>* loads,
                            const std::function<void()>& pass) {
  return Solve(Map::Of(length, loads, pass, [](double& c) -> double& { return c; }));
}

bool FrictionIteration::Run(double length, std::vector<JointLoad<Dual>>* loads,
                            const std::function<void()>& pass) {
  return Solve(Map::Of(length, loads, pass, [](Dual& c) -> double& { return c.value; })) &&
         Solve(Map::Of(length, loads, pass, [](Dual& c) -> double& { return c.slope; }));
}

bool FrictionIteration::Solve(const Map& map) {
  map.read(&start_);
  if (Iterate(map, &FrictionIteration::RelaxByAitken)) return true;
  map.write(start_);
  return Iterate(map, &FrictionIteration::MixByAnderson);
}

bool FrictionIteration::Iterate(const Map& map, void (FrictionIteration::*step)(int)) {
  x_ = start_;
  for (int i = 0; i < kMaxIterations; ++i) {
    map.pass();
    map.read(&G_);
    residual_ = G_ - x_;
    if (!residual_.allFinite()) return false;
    if (Settled()) return true;
    (this->*step)(i);
    map.write(x_);
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
