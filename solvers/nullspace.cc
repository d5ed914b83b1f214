#include "vmech/solvers/nullspace.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "vmech/base/check_range.h"
#include "vmech/base/linear_algebra/complete_orthogonal.h"
#include "vmech/solvers/null_motions.h"
#include "vmech/solvers/optimality.h"
#include "vmech/solvers/run.h"

namespace vmech {
namespace {

constexpr double kSufficientDecrease = 1e-4;
constexpr double kShortestStep = 1e-12;   // of the line search, as a part of the full step
constexpr double kRounding = 1e-14;       // changes of the merit below this (relative) are noise
constexpr double kClosingDamping = 1e-2;  // of the step that closes c, times |c|^2
constexpr double kLeastDamping = 1e-13;   // of the tangential step, relative to Z'BZ
constexpr double kFirstDamping = 1e-6;    // after the first trouble
constexpr double kDampingGrowth = 10;
constexpr double kLeastWeight = 1e-3;  // of |c| in the merit, where no multiplier asks for one

class NullspaceSolver {
 public:
  NullspaceSolver(CountedProblem& problem, const NullspaceOptions& options)
      : problem_(problem),
        options_(options),
        at_x_(problem.sizes()),
        mu_(VectorXd::Zero(problem.sizes().constraints)),
        null_(problem.sizes().tangents),
        held_(problem.sizes().tangents, false) {}

  Outcome Minimize(VectorXd* x) {
    Outcome outcome{SolveStatus::kIterationLimit, "iterations are spent"};
    for (; outcome.iterations < options_.stopping.max_iterations; ++outcome.iterations) {
      at_x_.Evaluate(problem_, *x);
      if (!at_x_.AllFinite()) return Stop(SolveStatus::kFailed, "not finite", outcome);
      if (Converged(*x)) return Stop(SolveStatus::kConverged, "stopping rule met", outcome);
      BuildModel(*x);
      ComputeStep(*x);
      if (!LineSearch(x)) return Stop(SolveStatus::kStalled, "no step descends", outcome);
    }
    return outcome;
  }

 private:
  static Outcome Stop(SolveStatus claim, const char* why, Outcome outcome) {
    outcome.claim = claim;
    outcome.message = why;
    return outcome;
  }

  bool Converged(const VectorXd& x) {
    const Optimality now = MeasureOptimality(problem_.bounds(), x, at_x_, options_.rank_tolerance);
    mu_ = now.multipliers;
    const StoppingRule& rule = options_.stopping;
    return now.constraint_norm <= rule.constraint_tolerance &&
           now.bound_violation <= rule.constraint_tolerance &&
           now.kkt_error <= rule.optimality_tolerance;
  }

  // g = J'r and B = J'J, or J'J + S with the multipliers of this point.
  void BuildModel(const VectorXd& x) {
    gradient_ = at_x_.J.transpose() * at_x_.r;
    B_ = at_x_.J.transpose() * at_x_.J;
    if (options_.use_second_derivatives && problem_.has_second_derivatives()) {
      MatrixXd S = MatrixXd::Zero(B_.rows(), B_.cols());
      problem_.Curvature(x, mu_, &S);
      B_ += S;
    }
    LeaveOutNullMotions();
    // Rows that are redundant where c = 0 have pivots of the order of c elsewhere, and would ask
    // for steps of order one: damped by |c|^2 they ask for nothing, and the order of convergence
    // stays two [Yamashita & Fukushima 2001].
    closing_damping_ = kClosingDamping * std::min(at_x_.c.squaredNorm(), at_x_.C.squaredNorm());
  }

  // Looks for them at first, and on if there were any.
  void LeaveOutNullMotions() {
    if (!first_look_ && !some_null_) return;
    null_.Find(at_x_, NullMotions::Held::Constant(gradient_.size(), false));
    some_null_ |= null_.count() > 0;
    first_look_ = false;
    null_.Stiffen(B_.cwiseAbs().maxCoeff(), &B_);
  }

  // The step for a working set of held coordinates; the set changes until the step respects every
  // bound and no held coordinate wants to leave its bound (primal-dual active set).
  void ComputeStep(const VectorXd& x) {
    held_.assign(held_.size(), false);
    d_ = VectorXd::Zero(gradient_.size());
    const size_t max_rounds = 2 * problem_.bounds().size() + 1;
    for (size_t round = 0; round < max_rounds; ++round) {
      SolveEqualityStep();
      if (!UpdateWorkingSet(x)) break;
    }
    ClipToBounds(x, &d_);
  }

  // d over the free coordinates, the held ones given.
  void SolveEqualityStep() {
    free_.clear();
    for (int i = 0; i < d_.size(); ++i) {
      if (!held_[i]) free_.push_back(i);
    }
    VectorXd d_held = d_;
    d_held(free_).setZero();
    const CompleteOrthogonal C(at_x_.C(Eigen::all, free_), options_.rank_tolerance);
    const VectorXd v = C.Solve(-(at_x_.c + at_x_.C * d_held), closing_damping_);
    d_(free_) = v + Tangential(C, gradient_ + B_ * d_held, v);
    // C_free' mu = -(g + B d)_free
    const VectorXd slope = gradient_ + B_ * d_;
    step_mu_ = C.SolveTransposed(-slope(free_), closing_damping_);
    reduced_slope_ = slope + at_x_.C.transpose() * step_mu_;
    factors_ = C;
  }

  // Z w with Z'(B + damping) Z w = -Z'(slope + B v). The damping grows until the matrix is positive
  // definite, and while the line search has to shorten steps.
  VectorXd Tangential(const CompleteOrthogonal& C, const VectorXd& slope, const VectorXd& v) {
    if (C.Z.cols() == 0) return VectorXd::Zero(v.size());
    const MatrixXd BZ = B_(free_, free_) * C.Z;
    const MatrixXd reduced = C.Z.transpose() * BZ;
    const VectorXd rhs = -(C.Z.transpose() * slope(free_) + BZ.transpose() * v);
    const double scale = std::max(reduced.cwiseAbs().maxCoeff(), 1e-30);
    for (;; damping_ = std::max(kDampingGrowth * damping_, kFirstDamping)) {
      MatrixXd damped = reduced;
      damped.diagonal().array() += damping_ * scale;
      const Eigen::LLT<MatrixXd> llt(damped);
      if (llt.info() == Eigen::Success) return C.Z * llt.solve(rhs);
    }
  }

  // Holds coordinates that the step takes beyond a bound, frees those whose bound pulls them.
  bool UpdateWorkingSet(const VectorXd& x) {
    bool changed = false;
    for (const Bound& bound : problem_.bounds()) {
      const int i = bound.tangent;
      const double to_lower = bound.lower - x[bound.coordinate];
      const double to_upper = bound.upper - x[bound.coordinate];
      if (!held_[i] && (d_[i] < to_lower || d_[i] > to_upper)) {
        d_[i] = d_[i] < to_lower ? to_lower : to_upper;
        held_[i] = changed = true;
      } else if (held_[i] && to_lower < to_upper) {
        const bool at_upper = d_[i] == to_upper;
        if ((at_upper ? 1 : -1) * reduced_slope_[i] > 0) held_[i] = false, changed = true;
      }
    }
    return changed;
  }

  void ClipToBounds(const VectorXd& x, VectorXd* d) const {
    const double largest = d->cwiseAbs().maxCoeff();
    if (largest > options_.max_step) *d *= options_.max_step / largest;
    for (const Bound& bound : problem_.bounds()) {
      const double value = x[bound.coordinate];
      (*d)[bound.tangent] =
          std::max(bound.lower - value, std::min((*d)[bound.tangent], bound.upper - value));
    }
  }

  double Merit(const VectorXd& x, double nu) {
    VectorXd r(at_x_.r.size()), c(at_x_.c.size());
    problem_.Evaluate(x, &r, nullptr, &c, nullptr);
    trial_c_ = c;
    return 0.5 * r.squaredNorm() + nu * c.norm();
  }

  // Backtracking on 1/2 |r|^2 + nu |c|; the full step gets a second-order correction before it is
  // shortened, so that curved constraints do not refuse good steps (Maratos).
  bool LineSearch(VectorXd* x) {
    const double c_norm = at_x_.c.norm();
    const double reduction = c_norm - (at_x_.c + at_x_.C * d_).norm();
    const double slope = RaiseWeight(reduction);
    const double merit = 0.5 * at_x_.r.squaredNorm() + nu_ * c_norm;
    const double noise = kRounding * std::abs(merit);
    VectorXd trial(x->size());
    for (double t = 1; t > kShortestStep; t *= 0.5) {
      const double allowed = merit + kSufficientDecrease * t * slope + noise;
      problem_.Plus(*x, t * d_, &trial);
      bool good = Merit(trial, nu_) <= allowed;
      if (!good && t == 1 && trial_c_.allFinite()) {
        problem_.Plus(*x, Corrected(*x), &trial);
        good = Merit(trial, nu_) <= allowed;
      }
      if (!good) continue;
      *x = trial;
      AdaptDamping(t);
      return d_.cwiseAbs().maxCoeff() > 0;
    }
    return false;
  }

  void AdaptDamping(double part_taken) {
    if (part_taken == 1)
      damping_ = std::max(damping_ / (kDampingGrowth * kDampingGrowth), kLeastDamping);
    if (part_taken < 0.25) damping_ = std::max(damping_ * kDampingGrowth, kFirstDamping);
  }

  // nu above the multipliers, and such that d is a direction of descent; returns the slope of the
  // merit along d. The multipliers are those of this point, which redundant rows have no part in:
  // those of the step grow without bound where such a row is nearly but not quite redundant.
  double RaiseWeight(double reduction) {
    const double needed = 1.5 * mu_.norm();
    nu_ = std::max({needed, 0.5 * (nu_ + needed), kLeastWeight});
    const double objective_slope = gradient_.dot(d_);
    if (reduction > 0 && objective_slope - nu_ * reduction > -0.5 * nu_ * reduction) {
      nu_ = std::max(nu_, 2 * objective_slope / reduction);
    }
    return std::min(0.0, objective_slope - nu_ * reduction);
  }

  // d - C^+ c(x + d)
  VectorXd Corrected(const VectorXd& x) const {
    VectorXd d = d_;
    const VectorXd correction = factors_.Solve(-trial_c_, closing_damping_);
    for (size_t i = 0; i < free_.size(); ++i) d[free_[i]] += correction[i];
    ClipToBounds(x, &d);
    return d;
  }

  CountedProblem& problem_;
  const NullspaceOptions& options_;
  Linearization at_x_;
  VectorXd mu_, step_mu_, gradient_, reduced_slope_, d_, trial_c_;
  MatrixXd B_;
  NullMotions null_;
  bool first_look_ = true, some_null_ = false;  // null motions have been found once
  double nu_ = 0, damping_ = kLeastDamping, closing_damping_ = 0;
  std::vector<bool> held_;
  std::vector<int> free_;
  CompleteOrthogonal factors_{MatrixXd(), 1};
};

}  // namespace

void NullspaceOptions::Validate() const {
  CheckRange("NullspaceOptions", "rank_tolerance", rank_tolerance, 1e-14, 1e-2);
  CheckRange("NullspaceOptions", "max_step", max_step, 1e-12,
             std::numeric_limits<double>::infinity());
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const NullspaceOptions& options,
              const VectorXd& x0) {
  options.Validate();
  return Run("nullspace", problem, options.stopping, x0, [&](CountedProblem& counted, VectorXd* x) {
    return NullspaceSolver(counted, options).Minimize(x);
  });
}

}  // namespace vmech
