#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vmech/solvers/programs/minimise.h"
#include "vmech/studies/sensitivities.h"

namespace vmech {

/// A parameter that a design may choose, between bounds in its unit.
struct DesignVariable {
  StudyParameter parameter;     ///< of the mechanism or the study
  double lower = 0, upper = 0;  ///< in the parameter's unit, lower < upper
};

/// figure <= limit, or figure >= limit, in the figure's unit.
struct DesignConstraint {
  Figure figure;          ///< what is limited
  bool at_least = false;  ///< figure >= limit, else <=
  double limit = 0;       ///< in the figure's unit
};

/// What a design is to be best at, and what it must keep.
struct DesignTask {
  Figure objective;                           ///< what is to be small
  bool maximise = false;                      ///< large instead
  std::vector<DesignVariable> variables;      ///< at least one
  std::vector<DesignConstraint> constraints;  ///< may be empty
};

/// A design that the search has looked at.
struct EvaluatedDesign {
  std::vector<double> values;   ///< [variables] in their units
  bool defined = false;         ///< it can be assembled and moved; else there are no figures
  std::vector<double> figures;  ///< the objective, smooth, then the constraints'
  std::vector<std::vector<double>> slopes;  ///< [figures, variables]
};

/// How a design is searched.
struct DesignOptions {
  int threads = 1;         ///< >= 1, among which the derivatives of a design are shared out
  int starts = 1;          ///< the design as it is, and others that are spread over the bounds
  ProgramOptions program;  ///< of each start
  /// What an interrupted search for the same had looked at, in its order: the search goes the same
  /// way without computing it again, and on from there.
  std::vector<EvaluatedDesign> known;
  /// Called with every design that was computed; false stops the search with the best so far.
  std::function<bool(const EvaluatedDesign& design)> progress;
};

/// What came of one start.
struct DesignRun {
  std::vector<double> values;  ///< [variables] in their units
  double objective = 0;        ///< the peak itself where a peak is asked for
  bool feasible = false;       ///< it keeps what it must
  std::string message;         ///< how the search ended, a sentence
};

/// What came of the search for a design.
struct DesignResult {
  /// The study with the best design; its joints start in its own first pose, but for those whose
  /// limits the motion leaves.
  StudyFile best;
  std::vector<double> values;  ///< [variables]
  bool feasible = false;       ///< it keeps what it must
  /// The objective, then the constraints' figures: as it was and as it is.
  std::vector<double> before, after;  ///< [1 + constraints] in their units
  /// By how much the objective would fall (rise, if maximised) for each unit by which a limit is
  /// loosened; zero where it does not bind.
  std::vector<double> gain_by_limit;
  /// The same for the bounds of the variables: positive at an upper bound, negative at a lower one.
  std::vector<double> gain_by_bound;
  /// As ProgramResult::optimality, but beside a millionth of the objective as it was, where less is
  /// left of it (of a root mean square: of its square).
  double optimality = 0;
  std::vector<DesignRun> runs;  ///< of every start, the best among them
  int evaluations = 0;          ///< of designs, all starts together
};

/// Searches the design of a study within bounds by exact derivatives, on the assembly branch of the
/// study as it is; bearings are those of `outcome`. A design that cannot be assembled or moved
/// draws the search back.
/// An objective that is a root mean square is searched by its square, which is smooth at zero.
/// @throws std::invalid_argument for a variable or figure that has no derivatives, or whose bounds
/// do not hold its value; std::runtime_error if the package of the method is not there.
DesignResult OptimiseDesign(const StudyFile& file, const StudyOutcome& outcome,
                            const DesignTask& task, const DesignOptions& options);

}  // namespace vmech
