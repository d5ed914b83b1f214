#include "vmech/solvers/backends/ceres.h"

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "vmech/solvers/backends/package.h"
#include "vmech/solvers/packages/ceres_rows.h"

namespace vmech {
namespace {

// A round that leaves more than this part of the constraint error calls for a larger weight.
constexpr double kSlow = 0.25;
constexpr double kFirstWeight = 10;
constexpr double kWeightGrowth = 10;
constexpr int kMaxFutileRounds = 5;
constexpr double kGradientTolerance = 0.01;  // of Ceres, in terms of the stopping rule's
// Where cost has lost its digits Ceres takes no step, at a KKT error near the root of rounding:
// from nearer than this the conditions of a minimum are solved instead, which vanish there.
constexpr double kNear = 1e-3;
constexpr int kMaxPolishing = 20;

// Ceres reports failures through glog whatever its own options say. A host that has set glog up
// keeps its settings.
void SilenceGlog() {
  static const bool done = [] {
    if (!google::IsGoogleLoggingInitialized()) FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
  static_cast<void>(done);
}

class CeresSolver {
 public:
  CeresSolver(CountedProblem& problem, const CeresOptions& options, VectorXd* x)
      : problem_(problem),
        options_(options),
        x_(*x),
        weight_(options.method == CeresMethod::kExact ? kFirstWeight
                                                      : std::min(kFirstWeight, options.weight)),
        mu_(VectorXd::Zero(problem.sizes().constraints)),
        at_x_(problem.sizes()),
        held_(problem.sizes().tangents, false) {
    for (const Bound& bound : problem.bounds()) {
      x_[bound.coordinate] = std::clamp(x_[bound.coordinate], bound.lower, bound.upper);
    }
  }

  Outcome Weighted() {
    bool ok = MinimizeWithinBounds();
    while (ok && !Spent() && weight_ < options_.weight) {
      weight_ = std::min(kWeightGrowth * weight_, options_.weight);
      ok = MinimizeWithinBounds();
    }
    SolveStatus claim = SolveStatus::kBiased;
    if (Spent()) claim = SolveStatus::kIterationLimit;
    if (!ok) claim = SolveStatus::kFailed;
    return {claim, "the constraints stay open by multiplier / weight^2", iterations_,
            at_x_.c.norm()};
  }

  Outcome Exact() {
    double last_error = std::numeric_limits<double>::infinity();
    for (int futile = 0; futile < kMaxFutileRounds;) {
      if (!MinimizeWithinBounds()) {
        return {SolveStatus::kFailed, "Ceres found no usable point", iterations_};
      }
      if (Done() || Polish()) return {SolveStatus::kConverged, "", iterations_};
      if (Spent()) return {SolveStatus::kIterationLimit, "iterations are spent", iterations_};
      mu_ += weight_ * weight_ * at_x_.c;
      const double error = at_x_.c.lpNorm<Eigen::Infinity>();
      const bool slow = error > kSlow * last_error;
      if (slow && weight_ >= options_.max_weight) ++futile;
      if (slow) weight_ = std::min(kWeightGrowth * weight_, options_.max_weight);
      last_error = error;
    }
    return {SolveStatus::kStalled, "the multiplier updates make no progress", iterations_};
  }

 private:
  bool Spent() const { return iterations_ >= options_.stopping.max_iterations; }

  bool Done() {
    now_ = MeasureOptimality(problem_.bounds(), x_, at_x_);
    return now_.constraint_norm <= options_.stopping.constraint_tolerance &&
           now_.bound_violation <= options_.stopping.constraint_tolerance &&
           now_.kkt_error <= options_.stopping.optimality_tolerance;
  }

  // Solves the conditions of a minimum from near one, within the present face. Stays where that
  // does not end in a minimum.
  bool Polish() {
    const bool near = now_.kkt_error < kNear && now_.constraint_norm < kNear;
    auto manifold = std::make_unique<FreeTangents>(problem_, held_);
    if (!near || manifold->TangentSize() == 0) return false;
    const VectorXd before = x_;
    VectorXd mu = now_.multipliers;
    ceres::Problem rows;
    rows.AddParameterBlock(x_.data(), static_cast<int>(x_.size()), manifold.release());
    std::vector<double*> unknowns{x_.data()};
    if (mu.size() > 0) unknowns.push_back(mu.data());
    rows.AddResidualBlock(new OptimalityRows(problem_, held_), nullptr, unknowns);
    SolveWithCeres(std::min(kMaxPolishing, options_.stopping.max_iterations - iterations_), &rows);
    at_x_.Evaluate(problem_, x_);
    if (at_x_.AllFinite() && Done()) return true;
    x_ = before;
    at_x_.Evaluate(problem_, x_);
    return false;
  }

  // Ceres on one face of the box after another, until no bound has to be taken in or let go.
  bool MinimizeWithinBounds() {
    const int max_rounds = 4 * static_cast<int>(problem_.bounds().size()) + 1;
    for (int round = 0; round < max_rounds && !Spent(); ++round) {
      if (!MinimizeOnFace()) return false;
      at_x_.Evaluate(problem_, x_);
      if (!at_x_.AllFinite()) return false;
      if (!UpdateHeld()) break;
    }
    return true;
  }

  bool MinimizeOnFace() {
    auto manifold = std::make_unique<FreeTangents>(problem_, held_);
    if (manifold->TangentSize() == 0) return true;
    ceres::Problem rows;
    rows.AddParameterBlock(x_.data(), static_cast<int>(x_.size()), manifold.release());
    rows.AddResidualBlock(new WeightedRows(problem_, weight_, mu_, CountNullMotions()), nullptr,
                          x_.data());
    for (const Bound& bound : problem_.bounds()) {
      if (held_[bound.tangent] || bound.lower == bound.upper) continue;
      rows.SetParameterLowerBound(x_.data(), bound.coordinate, bound.lower);
      rows.SetParameterUpperBound(x_.data(), bound.coordinate, bound.upper);
    }
    return SolveWithCeres(options_.stopping.max_iterations - iterations_, &rows);
  }

  int CountNullMotions() {
    at_x_.Evaluate(problem_, x_);
    if (!at_x_.AllFinite()) return 0;
    NullMotions null(problem_.sizes().tangents);
    null.Find(at_x_, NullMotions::Held::Constant(problem_.sizes().tangents, false));
    return null.count();
  }

  bool SolveWithCeres(int max_iterations, ceres::Problem* rows) {
    ceres::Solver::Options options;
    options.logging_type = ceres::SILENT;
    options.minimizer_progress_to_stdout = false;
    options.num_threads = 1;
    options.linear_solver_type = ceres::DENSE_QR;
    options.use_nonmonotonic_steps = true;  // along curved constraints
    options.function_tolerance = 1e-18;
    options.gradient_tolerance = kGradientTolerance * options_.stopping.optimality_tolerance;
    options.parameter_tolerance = 1e-16;
    options.max_num_iterations = max_iterations;
    ceres::Solver::Summary summary;
    ceres::Solve(options, rows, &summary);
    iterations_ += static_cast<int>(summary.iterations.size());
    return summary.IsSolutionUsable();
  }

  // Holds what has arrived at a bound; if nothing has, lets go of what its bound would have to pull
  // the hardest. False if there is neither.
  bool UpdateHeld() {
    const VectorXd slope =
        at_x_.J.transpose() * at_x_.r + at_x_.C.transpose() * (mu_ + weight_ * weight_ * at_x_.c);
    bool arrived = false;
    int pulled = -1;
    double hardest_pull = options_.stopping.optimality_tolerance;
    for (const Bound& bound : problem_.bounds()) {
      const int i = bound.tangent;
      const bool at_lower = x_[bound.coordinate] <= bound.lower;
      const bool at_upper = x_[bound.coordinate] >= bound.upper;
      if ((at_lower || at_upper) && !held_[i]) held_[i] = arrived = true;
      if (at_lower == at_upper) continue;  // at none, or fixed
      const double pull = at_upper ? slope[i] : -slope[i];
      if (pull > hardest_pull) pulled = i, hardest_pull = pull;
    }
    if (arrived) return true;
    if (pulled >= 0) held_[pulled] = false;
    return pulled >= 0;
  }

  CountedProblem& problem_;
  const CeresOptions& options_;
  VectorXd& x_;
  double weight_;
  VectorXd mu_;
  Linearization at_x_;
  Optimality now_;
  std::vector<bool> held_;
  int iterations_ = 0;
};

Outcome SolveByCeres(CountedProblem& problem, const CeresOptions& options, VectorXd* x) {
  SilenceGlog();
  CeresSolver solver(problem, options, x);
  return options.method == CeresMethod::kExact ? solver.Exact() : solver.Weighted();
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::PackageFunction<vmech::CeresOptions> vmech_solve = vmech::SolveByCeres;
}
