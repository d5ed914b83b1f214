#include "vmech/studies/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace vmech {
namespace {

/// Every joint starts where the study's first pose has it, so that other designs are assembled on
/// the same branch.
void StartAtFirstPose(const StudyOutcome& outcome, StudyFile* file) {
  std::vector<Joint>& joints = file->study.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type == JointType::kSpherical) continue;
    const Vector3d position = outcome.loads.poses[0].joints[j].position;
    for (size_t k = 0; k < joints[j].start.size(); ++k) {
      joints[j].start[k] = position[static_cast<int>(k)];
    }
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
    StartAtFirstPose(outcome_, &varied);
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
    if (stopped_ || (options_.progress && !options_.progress(++evaluations_))) stopped_ = true;
    Sensitivities result;
    try {
      if (stopped_) return false;
      result = FiguresAt(x, figures_);
    } catch (const std::exception&) {
      return false;
    }
    const FigureSlopes& objective = result.figures[0];
    if (objective_scale_ == 0) objective_scale_ = std::abs(objective.value);
    if (objective_scale_ == 0) objective_scale_ = 1;
    const double sign = (task_.maximise ? -1 : 1) / objective_scale_;
    *f = sign * objective.value;
    *df = sign * Eigen::Map<const VectorXd>(objective.slopes.data(), df->size());
    for (Eigen::Index i = 0; i < g->size(); ++i) {
      const FigureSlopes& figure = result.figures[static_cast<size_t>(i) + 1];
      const double scale = ConstraintScale(static_cast<size_t>(i));
      (*g)[i] = (figure.value - task_.constraints[static_cast<size_t>(i)].limit) * scale;
      dg->row(i) = scale * Eigen::Map<const VectorXd>(figure.slopes.data(), df->size()).transpose();
    }
    return std::isfinite(*f) && df->allFinite() && g->allFinite() && dg->allFinite();
  }

  double ConstraintScale(size_t i) const {
    const DesignConstraint& constraint = task_.constraints[i];
    const double size = constraint.limit != 0 ? std::abs(constraint.limit) : 1;
    return (constraint.at_least ? -1 : 1) / size;
  }

  double objective_scale() const { return objective_scale_; }

 private:
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
  int evaluations_ = 0;
  bool stopped_ = false;
};

void RequireInBounds(const DesignTask& task) {
  if (task.variables.empty()) throw std::invalid_argument("a design needs a parameter to vary");
  for (const DesignVariable& v : task.variables) {
    if (v.lower < v.upper && v.lower <= v.parameter.value && v.parameter.value <= v.upper) continue;
    throw std::invalid_argument(fmt::format(
        "'{0}' is to vary from {1:.6g} to {2:.6g} {3}, but is {4:.6g} {3}: give bounds around it",
        v.parameter.name, v.lower, v.upper, v.parameter.unit, v.parameter.value));
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

}  // namespace

DesignResult OptimiseDesign(const StudyFile& file, const StudyOutcome& outcome,
                            const DesignTask& task, const DesignOptions& options) {
  RequireInBounds(task);
  DesignProgram program(file, outcome, task, options);
  DesignResult result;
  const VectorXd x0 = StartOf(task, 0);
  result.before = ValuesAt(program, task, x0);
  ProgramResult best;
  for (int start = 0; start < options.starts; ++start) {
    const ProgramResult found = Minimise(program, options.program, StartOf(task, start));
    result.evaluations += found.evaluations;
    DesignRun run{{found.x.begin(), found.x.end()}, 0, found.feasible, found.message};
    if (found.defined) run.objective = ValuesAt(program, task, found.x)[0];
    result.runs.push_back(std::move(run));
    if (start == 0 || IsBetter(found, best)) best = found;
  }
  result.values.assign(best.x.begin(), best.x.end());
  result.after = ValuesAt(program, task, best.x);
  result.best = program.At(best.x);
  std::vector<Joint>& joints = result.best.study.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    joints[j].start = file.study.mechanism.joints[j].start;
  }
  result.feasible = best.feasible;
  result.optimality = best.optimality;
  for (Eigen::Index i = 0; i < best.lambda.size(); ++i) {
    const double scale = std::abs(program.ConstraintScale(static_cast<size_t>(i)));
    result.gain_by_limit.push_back(best.lambda[i] * scale * program.objective_scale());
  }
  for (double mu : best.mu) result.gain_by_bound.push_back(mu * program.objective_scale());
  return result;
}

}  // namespace vmech
