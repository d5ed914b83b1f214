#include "vmech/solvers/nullspace.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vmech/base/check_range.h"
#include "vmech/base/linear_algebra/complete_orthogonal.h"
#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/solvers/null_motions.h"
#include "vmech/solvers/optimality.h"
#include "vmech/solvers/run.h"

namespace vmech {
namespace {

constexpr double kSufficientDecrease = 1e-4;
constexpr double kShortestStep = 1e-12;           // of the line search, as a part of the full step
constexpr double kRoundingOfConstraints = 1e-15;  // over their slopes
constexpr double kRounding = 1e-14;       // changes of the merit below this (relative) are noise
constexpr double kClosingDamping = 1e-2;  // of the step that closes c, times |c|^2
constexpr double kLeastDamping = 1e-13;   // of the tangential step, relative to Z'BZ
constexpr double kFirstDamping = 1e-6;    // after the first trouble
constexpr double kDampingGrowth = 10;
constexpr double kLeastWeight = 1e-3;  // of |c| in the merit, where no multiplier asks for one

int Size(const VectorXd& v) {
  return static_cast<int>(v.size());
}

double SquaredNorm(const VectorXd& v) noexcept {
  return Dot(v.data(), v.data(), Size(v));
}

template <typename Numbers>
double MaxAbs(const Numbers& numbers) noexcept {
  double largest = 0;
  for (double number : numbers) largest = std::max(largest, std::abs(number));
  return largest;
}

const char* MessageOf(SolveStatus claim) {
  switch (claim) {
    case SolveStatus::kConverged:
      return "stopping rule met";
    case SolveStatus::kFailed:
      return "not finite";
    case SolveStatus::kStalled:
      return "no step descends";
    default:
      return "iterations are spent";
  }
}

}  // namespace

class NullspaceWorkspace::Solver {
 public:
  explicit Solver(const ConstrainedLeastSquares& problem)
      : at_x_(problem.sizes()),
        at_trial_(problem.sizes()),
        null_(problem.sizes().tangents),
        none_held_(NullMotions::Held::Constant(problem.sizes().tangents, false)),
        held_(problem.sizes().tangents, false) {
    const ProblemSizes& sizes = problem.sizes();
    const int n = sizes.tangents;
    mu_ = step_mu_ = residual_ = VectorXd::Zero(sizes.constraints);
    trial_x_ = VectorXd::Zero(sizes.coordinates);
    gradient_ = slope_ = d_ = trial_d_ = VectorXd::Zero(n);
    B_ = MatrixXd::Zero(n, n);
    for (auto* numbers : {&free_B_, &BZ_, &reduced_, &damped_}) numbers->reserve(n * n);
    for (auto* numbers : {&free_slope_, &v_, &w_}) numbers->reserve(n);
    free_.reserve(n);
  }

  FastOutcome Minimize(ConstrainedLeastSquares& problem, const NullspaceOptions& options,
                       VectorXd* x) {
    problem_ = &problem, options_ = &options;
    null_.ForgetFewest();
    first_look_ = true, some_null_ = false;
    nu_ = 0, damping_ = kLeastDamping;
    at_x_.Evaluate(problem, *x);
    FastOutcome outcome{SolveStatus::kIterationLimit};
    for (; outcome.iterations < options.stopping.max_iterations; ++outcome.iterations) {
      if (Ended(x, &outcome.claim)) break;
    }
    outcome.constraint_norm = MaxAbs(at_x_.c);
    return outcome;
  }

 private:
  // One iteration; true, and says how, if it is the last.
  bool Ended(VectorXd* x, SolveStatus* claim) {
    if (!at_x_.AllFinite()) return *claim = SolveStatus::kFailed, true;
    if (Converged(*x)) return *claim = SolveStatus::kConverged, true;
    BuildModel(*x);
    ComputeStep(*x);
    if (!LineSearch(x)) return *claim = SolveStatus::kStalled, true;
    return false;
  }

  bool Converged(const VectorXd& x) {
    const Optimality& now = meter_.Measure(problem_->bounds(), x, at_x_, options_->rank_tolerance);
    mu_ = now.multipliers;
    const StoppingRule& rule = options_->stopping;
    return now.constraint_norm <= rule.constraint_tolerance &&
           now.bound_violation <= rule.constraint_tolerance &&
           now.kkt_error <= rule.optimality_tolerance;
  }

  // g = J'r and B = J'J, or J'J + S with the multipliers of this point.
  void BuildModel(const VectorXd& x) {
    const int rows = Size(at_x_.r), n = Size(gradient_);
    const double* const J = at_x_.J.data();
    MultiplyTransposed(J, rows, n, at_x_.r.data(), gradient_.data());
    const bool curved = options_->use_second_derivatives && problem_->has_second_derivatives();
    if (curved) problem_->Curvature(x, mu_, &B_);
    if (!curved) B_.setZero();
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i <= j; ++i) {
        const double product = Dot(J + i * rows, J + j * rows, rows);
        B_(i, j) += product;
        if (i != j) B_(j, i) += product;
      }
    }
    LeaveOutNullMotions();
    // Rows that are redundant where c = 0 have pivots of the order of c elsewhere, and would ask
    // for steps of order one: damped by |c|^2 they ask for nothing, and the order of convergence
    // stays two [Yamashita & Fukushima 2001].
    const double squared_C = Dot(at_x_.C.data(), at_x_.C.data(), static_cast<int>(at_x_.C.size()));
    closing_damping_ = kClosingDamping * std::min(SquaredNorm(at_x_.c), squared_C);
  }

  // Looks for them at first, and on if there were any.
  void LeaveOutNullMotions() {
    if (!first_look_ && !some_null_) return;
    null_.Find(at_x_, none_held_);
    some_null_ |= null_.count() > 0;
    first_look_ = false;
    if (null_.count() > 0) null_.Stiffen(B_.cwiseAbs().maxCoeff(), &B_);
  }

  // The step for a working set of held coordinates; the set changes until the step respects every
  // bound and no held coordinate wants to leave its bound (primal-dual active set).
  void ComputeStep(const VectorXd& x) {
    std::fill(held_.begin(), held_.end(), false);
    d_.setZero();
    const size_t max_rounds = 2 * problem_->bounds().size() + 1;
    for (size_t round = 0; round < max_rounds; ++round) {
      SolveEqualityStep();
      if (!UpdateWorkingSet(x)) break;
    }
    ClipToBounds(x, &d_);
  }

  // d over the free coordinates, the held ones given.
  void SolveEqualityStep() {
    ChooseFree();
    FactorConstraints();
    const int n = Size(d_), m = Size(at_x_.c), free = static_cast<int>(free_.size());
    // C_free v = -(c + C d_held), slope = g + B d_held
    slope_ = gradient_;
    for (int i = 0; i < m; ++i) residual_[i] = -at_x_.c[i];
    for (int j = 0; j < n; ++j) {
      if (!held_[j]) continue;
      AddScaled(-d_[j], at_x_.C.data() + j * m, 0, m, residual_.data());
      AddScaled(d_[j], B_.data() + j * n, 0, n, slope_.data());
    }
    v_.resize(free);
    factors_->Solve(residual_.data(), v_.data());
    AddTangential();
    for (int k = 0; k < free; ++k) d_[free_[k]] = v_[k];
    if (free < n) FindForcesOfBounds();
  }

  void ChooseFree() {
    free_.clear();
    for (int i = 0; i < Size(d_); ++i) {
      if (!held_[i]) free_.push_back(i);
    }
  }

  // Where all are free, those of the measurement serve.
  void FactorConstraints() {
    const int n = Size(d_), m = Size(at_x_.c), free = static_cast<int>(free_.size());
    if (free == n) {
      factors_ = &meter_.factors();
      factors_->SetRank(options_->rank_tolerance);
    } else {
      factors_ = &free_factors_;
      auto transposed = factors_->Prepare(m, free);
      for (int k = 0; k < free; ++k) transposed.row(k) = at_x_.C.col(free_[k]).transpose();
      factors_->Factor(options_->rank_tolerance);
    }
    factors_->SetDamping(closing_damping_);
  }

  // v += Z w, Z'(B + damping) Z w = -Z'(slope + B v), over the free coordinates. The damping grows
  // until the matrix is positive definite, and while the line search has to shorten steps.
  void AddTangential() {
    const auto Z = factors_->Z();
    const int free = static_cast<int>(Z.rows()), q = static_cast<int>(Z.cols());
    if (q == 0) return;
    ReduceModel(Z.data(), free, q);
    const double scale = std::max(MaxAbs(reduced_), 1e-30);
    for (;; damping_ = std::max(kDampingGrowth * damping_, kFirstDamping)) {
      damped_ = reduced_;
      for (int k = 0; k < q; ++k) damped_[k * q + k] += damping_ * scale;
      if (FactorLdlt<0>(q, damped_.data())) break;
    }
    SolveLdlt<0>(damped_.data(), q, w_.data());
    AddProduct(Z.data(), free, q, w_.data(), v_.data());
  }

  // Z'BZ and w = -(Z' slope + (BZ)' v)
  void ReduceModel(const double* Z, int free, int q) {
    free_B_.resize(free * free), free_slope_.resize(free);
    BZ_.assign(free * q, 0), reduced_.resize(q * q), w_.resize(q);
    for (int j = 0; j < free; ++j) {
      free_slope_[j] = slope_[free_[j]];
      for (int i = 0; i < free; ++i) free_B_[j * free + i] = B_(free_[i], free_[j]);
    }
    for (int k = 0; k < q; ++k) {
      double* const BZ_k = BZ_.data() + k * free;
      AddProduct(free_B_.data(), free, free, Z + k * free, BZ_k);
      MultiplyTransposed(Z, free, q, BZ_k, reduced_.data() + k * q);
      w_[k] = -Dot(Z + k * free, free_slope_.data(), free) - Dot(BZ_k, v_.data(), free);
    }
  }

  // C_free' mu = -(g + B d)_free; what is left of the slope acts on the bounds.
  void FindForcesOfBounds() {
    const int n = Size(d_), m = Size(at_x_.c);
    slope_ = gradient_;
    AddProduct(B_.data(), n, n, d_.data(), slope_.data());
    free_slope_.resize(free_.size());
    for (size_t k = 0; k < free_.size(); ++k) free_slope_[k] = -slope_[free_[k]];
    factors_->SolveTransposed(free_slope_.data(), step_mu_.data());
    for (int j = 0; j < n; ++j) slope_[j] += Dot(at_x_.C.data() + j * m, step_mu_.data(), m);
  }

  // Holds coordinates that the step takes beyond a bound, frees those whose bound pulls them.
  bool UpdateWorkingSet(const VectorXd& x) {
    bool changed = false;
    for (const Bound& bound : problem_->bounds()) {
      const int i = bound.tangent;
      const double to_lower = bound.lower - x[bound.coordinate];
      const double to_upper = bound.upper - x[bound.coordinate];
      if (!held_[i] && (d_[i] < to_lower || d_[i] > to_upper)) {
        d_[i] = d_[i] < to_lower ? to_lower : to_upper;
        held_[i] = changed = true;
      } else if (held_[i] && to_lower < to_upper) {
        const bool at_upper = d_[i] == to_upper;
        if ((at_upper ? 1 : -1) * slope_[i] > 0) held_[i] = false, changed = true;
      }
    }
    return changed;
  }

  void ClipToBounds(const VectorXd& x, VectorXd* d) const {
    const double largest = MaxAbs(*d);
    if (largest > options_->max_step) *d *= options_->max_step / largest;
    for (const Bound& bound : problem_->bounds()) {
      const double value = x[bound.coordinate];
      (*d)[bound.tangent] =
          std::max(bound.lower - value, std::min((*d)[bound.tangent], bound.upper - value));
    }
  }

  // Linearises at x + trial_d, with derivatives: most trials are taken.
  bool TrialDescends(const VectorXd& x, double allowed) {
    problem_->Plus(x, trial_d_, &trial_x_);
    at_trial_.Evaluate(*problem_, trial_x_);
    return Merit(at_trial_) <= allowed;
  }

  double Merit(const Linearization& at) const {
    return 0.5 * SquaredNorm(at.r) + nu_ * std::sqrt(SquaredNorm(at.c));
  }

  // Backtracking on 1/2 |r|^2 + nu |c|; the full step gets a second-order correction before it is
  // shortened, so that curved constraints do not refuse good steps (Maratos).
  bool LineSearch(VectorXd* x) {
    const double c_norm = std::sqrt(SquaredNorm(at_x_.c));
    residual_ = at_x_.c;
    AddProduct(at_x_.C.data(), Size(residual_), Size(d_), d_.data(), residual_.data());
    const double slope = RaiseWeight(c_norm - std::sqrt(SquaredNorm(residual_)));
    const double merit = Merit(at_x_);
    // Beside a small objective the rounding of c would be taken for a constraint that gets worse.
    const double noise =
        kRounding * std::abs(merit) + kRoundingOfConstraints * nu_ * at_x_.C.norm();
    for (double t = 1; t > kShortestStep; t *= 0.5) {
      const double allowed = merit + kSufficientDecrease * t * slope + noise;
      for (int i = 0; i < Size(d_); ++i) trial_d_[i] = t * d_[i];
      bool good = TrialDescends(*x, allowed);
      if (!good && t == 1 && at_trial_.c.allFinite()) {
        CorrectTrial(*x);
        good = TrialDescends(*x, allowed);
      }
      if (!good) continue;
      *x = trial_x_;
      at_x_.Swap(&at_trial_);
      AdaptDamping(t);
      return MaxAbs(d_) > 0;
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
    const double needed = 1.5 * std::sqrt(SquaredNorm(mu_));
    nu_ = std::max({needed, 0.5 * (nu_ + needed), kLeastWeight});
    const double objective_slope = Dot(gradient_.data(), d_.data(), Size(d_));
    if (reduction > 0 && objective_slope - nu_ * reduction > -0.5 * nu_ * reduction) {
      nu_ = std::max(nu_, 2 * objective_slope / reduction);
    }
    return std::min(0.0, objective_slope - nu_ * reduction);
  }

  // d - C^+ c(x + d)
  void CorrectTrial(const VectorXd& x) {
    for (int i = 0; i < Size(residual_); ++i) residual_[i] = -at_trial_.c[i];
    factors_->Solve(residual_.data(), v_.data());
    for (size_t k = 0; k < free_.size(); ++k) trial_d_[free_[k]] += v_[k];
    ClipToBounds(x, &trial_d_);
  }

  ConstrainedLeastSquares* problem_ = nullptr;
  const NullspaceOptions* options_ = nullptr;
  Linearization at_x_, at_trial_;
  OptimalityMeter meter_;
  CompleteOrthogonal free_factors_, *factors_ = nullptr;
  VectorXd mu_, step_mu_, gradient_, slope_, residual_, d_, trial_d_, trial_x_;
  MatrixXd B_;
  NullMotions null_;
  NullMotions::Held none_held_;
  bool first_look_ = true, some_null_ = false;  // null motions have been found once
  double nu_ = 0, damping_ = kLeastDamping, closing_damping_ = 0;
  std::vector<bool> held_;
  std::vector<int> free_;
  std::vector<double> free_B_, free_slope_, v_, w_, BZ_, reduced_, damped_;  // of the free ones
};

NullspaceWorkspace::NullspaceWorkspace(const ConstrainedLeastSquares& problem)
    : solver_(std::make_unique<Solver>(problem)) {}
NullspaceWorkspace::NullspaceWorkspace(NullspaceWorkspace&&) noexcept = default;
NullspaceWorkspace& NullspaceWorkspace::operator=(NullspaceWorkspace&&) noexcept = default;
NullspaceWorkspace::~NullspaceWorkspace() = default;

void NullspaceOptions::Validate() const {
  CheckRange("NullspaceOptions", "rank_tolerance", rank_tolerance, 1e-14, 1e-2);
  CheckRange("NullspaceOptions", "max_step", max_step, 1e-12,
             std::numeric_limits<double>::infinity());
  stopping.Validate();
}

FastOutcome Solve(ConstrainedLeastSquares& problem, const NullspaceOptions& options, VectorXd* x,
                  NullspaceWorkspace* workspace) noexcept {
  return workspace->solver_->Minimize(problem, options, x);
}

Summary Solve(ConstrainedLeastSquares& problem, const NullspaceOptions& options,
              const VectorXd& x0) {
  options.Validate();
  return Run("nullspace", problem, options.stopping, x0, [&](CountedProblem& counted, VectorXd* x) {
    NullspaceWorkspace workspace(counted);
    const FastOutcome fast = Solve(counted, options, x, &workspace);
    return Outcome{fast.claim, MessageOf(fast.claim), fast.iterations};
  });
}

}  // namespace vmech
