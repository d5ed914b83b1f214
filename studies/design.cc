#include "vmech/studies/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {
namespace {

/// The coordinates of a joint in the first pose; of a spherical one the unit quaternion w, x, y, z.
std::vector<double> FirstCoordinates(const Joint& joint, const LoadStudyResult& loads, size_t j) {
  const Vector3d position = loads.poses[0].joints[j].position;
  if (joint.type != JointType::kSpherical) {
    return {position.begin(), position.begin() + FreedomsOf(joint.type)};
  }
  const double angle = position.norm();
  const Vector3d axis = angle > 0 ? Vector3d(position / angle) : Vector3d::UnitX();
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
  return {q.w(), q.x(), q.y(), q.z()};
}

/// Every joint starts where the study's first pose has it, so that other designs are assembled on
/// the same branch.
void StartAtFirstPose(const LoadStudyResult& loads, StudyFile* file) {
  std::vector<Joint>& joints = file->study.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    joints[j].start = FirstCoordinates(joints[j], loads, j);
  }
}

/// May a file of the joint state this start? A motion may leave limits, a file may not.
bool IsWithinLimits(const Joint& joint, const std::vector<double>& start) {
  for (size_t k = 0; k < joint.lower.size(); ++k) {
    if (start[k] < joint.lower[k] || start[k] > joint.upper[k]) return false;
  }
  return true;
}

/// The mechanism of a design as a file of it is written: it starts in the design's own first pose,
/// from which whatever reads the file assembles the same branch.
void StateFirstPose(const StudyFile& original, StudyFile* design) {
  const LoadStudyResult loads = RunLoadStudy(design->study, {});
  std::vector<Joint>& joints = design->study.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    const Joint& before = original.study.mechanism.joints[j];
    const std::vector<double> start = FirstCoordinates(joints[j], loads, j);
    const bool stated = IsWithinLimits(joints[j], start);
    joints[j].start = stated ? start : before.start;
    joints[j].start_given = stated || before.start_given;
  }
}

/// The i-th term of the sequence to a prime base, from 0 to 1: evenly spread [Halton 1960].
double Halton(int i, int base) {
  double term = 0, share = 1;
  for (; i > 0; i /= base) {
    share /= base;
    term += share * (i % base);
  }
  return term;
}

/// The design of a study as a nonlinear program. Objective and constraints are taken in parts of
/// what they are at first, and of their limits.
class DesignProgram final : public NonlinearProgram {
 public:
  DesignProgram(const StudyFile& file, const StudyOutcome& outcome, const DesignTask& task,
                const DesignOptions& options)
      : NonlinearProgram(BoundsOf(task, &DesignVariable::lower),
                         BoundsOf(task, &DesignVariable::upper),
                         static_cast<int>(task.constraints.size())),
        file_(file),
        outcome_(outcome),
        task_(task),
        options_(options) {
    figures_.push_back(task.objective);
    // A smooth peak has a derivative where the pose of the peak changes.
    if (figures_[0].reduction == Reduction::kPeak) figures_[0].reduction = Reduction::kSmoothPeak;
    for (const DesignConstraint& constraint : task.constraints) {
      figures_.push_back(constraint.figure);
    }
    for (const DesignVariable& variable : task.variables) {
      parameters_.push_back(variable.parameter);
    }
  }

  StudyFile At(const VectorXd& x) const {
    StudyFile varied = file_;
    PutAll(parameters_, {x.data(), parameters_.size()}, &varied);
    StartAtFirstPose(outcome_.loads, &varied);
    return varied;
  }

  /// The figures there, objective first, with their slopes.
  Sensitivities FiguresAt(const VectorXd& x, std::vector<Figure> figures) const {
    std::vector<StudyParameter> parameters = parameters_;
    for (size_t k = 0; k < parameters.size(); ++k) {
      parameters[k].value = x[static_cast<Eigen::Index>(k)];
    }
    Sensitivities result = FindSensitivities(At(x), outcome_, std::move(figures),
                                             std::move(parameters), {options_.threads, true});
    for (size_t k = 0; k < parameters_.size(); ++k) {
      if (result.refusals[k].empty()) continue;
      throw std::invalid_argument(
          fmt::format("'{}' cannot be varied: {}", parameters_[k].name, result.refusals[k]));
    }
    return result;
  }

  bool Evaluate(const VectorXd& x, double* f, VectorXd* df, VectorXd* g, MatrixXd* dg) override {
    if (stopped_) return false;
    const EvaluatedDesign design = Look(x);
    if (!design.defined) return false;
    const auto slopes_of = [&](size_t figure) {
      return Eigen::Map<const VectorXd>(design.slopes[figure].data(), df->size());
    };
    if (objective_scale_ == 0) objective_scale_ = std::abs(design.figures[0]);
    if (objective_scale_ == 0) objective_scale_ = 1;
    *f = InSearch(design.figures[0]);
    *df = SlopeInSearch(design.figures[0]) * slopes_of(0);
    for (Eigen::Index i = 0; i < g->size(); ++i) {
      const size_t c = static_cast<size_t>(i);
      (*g)[i] = (design.figures[c + 1] - task_.constraints[c].limit) * ConstraintScale(c);
      dg->row(i) = ConstraintScale(c) * slopes_of(c + 1).transpose();
    }
    return true;
  }

  /// The objective as it is searched, which is to be small.
  double InSearch(double objective) const {
    const double share = objective / objective_scale_;
    return (task_.maximise ? -1 : 1) * (squared() ? share * share : share);
  }
  double SlopeInSearch(double objective) const {
    const double slope = (squared() ? 2 * objective / objective_scale_ : 1) / objective_scale_;
    return (task_.maximise ? -1 : 1) * slope;
  }

  /// From one start. @throws what DesignOptions::progress has thrown.
  ProgramResult Search(const VectorXd& x) {
    ProgramResult found = Minimise(*this, options_.program, x);
    if (error_) std::rethrow_exception(error_);
    return found;
  }

  bool stopped() const { return stopped_; }
  bool smooths_a_peak() const { return figures_[0].reduction == Reduction::kSmoothPeak; }
  void SetPower(double power) { figures_[0].power = power; }

  double ConstraintScale(size_t i) const {
    const DesignConstraint& constraint = task_.constraints[i];
    const double size = constraint.limit != 0 ? std::abs(constraint.limit) : 1;
    return (constraint.at_least ? -1 : 1) / size;
  }

 private:
  bool squared() const { return figures_[0].reduction == Reduction::kRms; }

  /// What a search that went this way has computed; else it is computed.
  EvaluatedDesign Look(const VectorXd& x) {
    EvaluatedDesign design{{x.begin(), x.end()}, false, {}, {}};
    if (known_ < options_.known.size() && IsOf(options_.known[known_], design.values)) {
      return options_.known[known_++];
    }
    known_ = options_.known.size();
    Compute(x, &design);
    Tell(design);
    return design;
  }

  bool IsOf(const EvaluatedDesign& known, const std::vector<double>& values) const {
    return known.values == values && (!known.defined || known.figures.size() == figures_.size());
  }

  /// What is thrown waits until the package has ended, through which it cannot pass.
  void Tell(const EvaluatedDesign& design) {
    try {
      stopped_ = options_.progress && !options_.progress(design);
    } catch (...) {
      stopped_ = true;
      error_ = std::current_exception();
    }
  }

  void Compute(const VectorXd& x, EvaluatedDesign* design) const {
    std::vector<FigureSlopes> figures;
    try {
      figures = FiguresAt(x, figures_).figures;
    } catch (const std::exception&) {
      return;
    }
    design->defined = true;
    for (FigureSlopes& figure : figures) {
      const Eigen::Map<const VectorXd> slopes(figure.slopes.data(), x.size());
      if (!std::isfinite(figure.value) || !slopes.allFinite()) design->defined = false;
      design->figures.push_back(figure.value);
      design->slopes.push_back(std::move(figure.slopes));
    }
    if (!design->defined) design->figures.clear(), design->slopes.clear();
  }

  static VectorXd BoundsOf(const DesignTask& task, double DesignVariable::*bound) {
    VectorXd bounds(static_cast<Eigen::Index>(task.variables.size()));
    for (Eigen::Index k = 0; k < bounds.size(); ++k) {
      bounds[k] = task.variables[static_cast<size_t>(k)].*bound;
    }
    return bounds;
  }

  StudyFile file_;
  const StudyOutcome& outcome_;
  const DesignTask& task_;
  const DesignOptions& options_;
  std::vector<Figure> figures_;
  std::vector<StudyParameter> parameters_;
  double objective_scale_ = 0;
  size_t known_ = 0;  // of DesignOptions::known, those that were passed
  bool stopped_ = false;
  std::exception_ptr error_;
};

void RequireBounds(const DesignVariable& v) {
  constexpr double kFar = 1e6;  // sizes; slopes and steps of a search are parts of the range
  const StudyParameter& p = v.parameter;
  const bool around = v.lower < v.upper && v.lower <= p.value && p.value <= v.upper;
  if (around && v.upper - v.lower <= kFar * p.scale) return;
  throw std::invalid_argument(
      fmt::format("'{0}' is to vary from {1:.6g} to {2:.6g} {3}, but is {4:.6g} {3}: give {5}",
                  p.name, v.lower, v.upper, p.unit, p.value,
                  around ? "bounds that are not a million times as wide" : "bounds around it"));
}

void RequireInBounds(const DesignTask& task) {
  if (task.variables.empty()) throw std::invalid_argument("a design needs a parameter to vary");
  std::set<std::string> names;
  for (const DesignVariable& v : task.variables) {
    if (!names.insert(v.parameter.name).second) {
      throw std::invalid_argument(
          fmt::format("'{}' is to vary twice: give it one pair of bounds", v.parameter.name));
    }
    RequireBounds(v);
  }
}

VectorXd StartOf(const DesignTask& task, int start) {
  VectorXd x(static_cast<Eigen::Index>(task.variables.size()));
  // Primes, one for each variable; of more the sequence repeats them.
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const DesignVariable& v = task.variables[static_cast<size_t>(k)];
    const double share = Halton(start, kPrimes[static_cast<size_t>(k) % std::size(kPrimes)]);
    x[k] = start == 0 ? v.parameter.value : v.lower + share * (v.upper - v.lower);
  }
  return x;
}

/// Objective and constraints as they are asked for.
std::vector<double> ValuesAt(const DesignProgram& program, const DesignTask& task,
                             const VectorXd& x) {
  std::vector<Figure> figures{task.objective};
  for (const DesignConstraint& constraint : task.constraints) figures.push_back(constraint.figure);
  std::vector<double> values;
  for (const FigureSlopes& figure : program.FiguresAt(x, std::move(figures)).figures) {
    values.push_back(figure.value);
  }
  return values;
}

bool IsBetter(const ProgramResult& a, const ProgramResult& b) {
  if (!b.defined || !a.defined) return a.defined;
  if (a.feasible != b.feasible) return a.feasible;
  return a.feasible ? a.f < b.f : a.g.maxCoeff() < b.g.maxCoeff();
}

/// From the best design by a smooth peak to that by the peak itself: by powers that rise, each from
/// where the last one ended.
void Sharpen(DesignProgram* program, ProgramResult* best, int* evaluations) {
  if (!program->smooths_a_peak() || !best->defined) return;
  for (const double power : {512, 8192}) {
    if (program->stopped()) return;
    program->SetPower(power);
    const ProgramResult sharper = program->Search(best->x);
    *evaluations += sharper.evaluations;
    if (sharper.defined && sharper.feasible >= best->feasible) *best = sharper;
  }
}

}  // namespace

DesignResult OptimiseDesign(const StudyFile& file, const StudyOutcome& outcome,
                            const DesignTask& task, const DesignOptions& options) {
  RequireInBounds(task);
  DesignProgram program(file, outcome, task, options);
  DesignResult result;
  const VectorXd x0 = StartOf(task, 0);
  result.before = ValuesAt(program, task, x0);
  ProgramResult best;
  for (int start = 0; start < options.starts && !program.stopped(); ++start) {
    const ProgramResult found = program.Search(StartOf(task, start));
    result.evaluations += found.evaluations;
    DesignRun run{{found.x.begin(), found.x.end()}, 0, found.feasible, found.message};
    if (found.defined) run.objective = ValuesAt(program, task, found.x)[0];
    result.runs.push_back(std::move(run));
    if (start == 0 || IsBetter(found, best)) best = found;
  }
  Sharpen(&program, &best, &result.evaluations);
  result.values.assign(best.x.begin(), best.x.end());
  result.after = ValuesAt(program, task, best.x);
  result.best = program.At(best.x);
  StateFirstPose(file, &result.best);
  result.feasible = best.feasible;
  constexpr double kNothing = 1e-6;  // of the objective of the search, which is 1 at first
  const double f = std::abs(best.f), left = best.optimality * (f > 0 ? f : 1);
  result.optimality = left / std::max(f, kNothing);
  // A multiplier is by how much the objective of the search falls. Its own slope is nothing where a
  // root mean square is zero: there is nothing to gain.
  const double slope = std::abs(program.SlopeInSearch(result.after[0]));
  const double gain = slope > 0 ? 1 / slope : 0;
  for (Eigen::Index i = 0; i < best.lambda.size(); ++i) {
    const double scale = std::abs(program.ConstraintScale(static_cast<size_t>(i)));
    result.gain_by_limit.push_back(best.lambda[i] * scale * gain);
  }
  for (double mu : best.mu) result.gain_by_bound.push_back(mu * gain);
  return result;
}

}  // namespace vmech
