#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/comparison/solver_entry.h"
#include "vmech/comparison/suite.h"

namespace vmech {

/// What became of a problem in the hands of a solver, judged at the returned configuration.
enum class Verdict {
  kSolved,        ///< loops closed and the target reached; of a path: every target, without a jump
  kUnreachable,   ///< loops closed, the nearest pose to a target that is out of reach
  kLocalMinimum,  ///< a constrained minimum, but the target could have been reached
  kSaddle,        ///< stationary, loops closed, but not a minimum
  kBiased,        ///< loops open by the bias of a penalty
  kLost,          ///< a path: some targets not reached
  kJumped,        ///< a path: every target reached, but on another branch from one to the next
  kInfeasible,    ///< stopped where the loops cannot be closed nearby
  kIterationLimit,  ///< as SolveStatus, and so are the following
  kStalled,
  kFailed,
  kUnsuitable,
  kUnavailable,
  kNotPosed,  ///< the mechanism has no problem of this kind
};

/// Which of the configurations that reach a target was found.
enum class Branch {
  kUnknown,  ///< nothing was found
  kOwn,      ///< that from which the target was made
  kOther,    ///< another one
  kFree,     ///< the grasp does not tell the configuration, as at a singular pose
};

/// The verdict in words.
std::string_view NameOf(Verdict verdict);
/// The branch in words.
std::string_view NameOf(Branch branch);
Verdict VerdictFromName(std::string_view name);  ///< @throws std::invalid_argument
Branch BranchFromName(std::string_view name);    ///< @throws std::invalid_argument

/// One problem and one solver. Of a path, counts and time are sums, errors the largest.
struct Result {
  ProblemId problem;                   ///< of the suite
  SolverEntry solver;                  ///< that was asked
  Verdict verdict = Verdict::kFailed;  ///< how it ended
  std::string message;                 ///< of the solver; empty where it succeeded
  int targets = 1;                     ///< how many a path has; else 1
  int reached = 0;                     ///< how many of these were reached
  int jumps = 0;                       ///< of a path: to another branch from one target to the next
  int iterations = 0;                  ///< of the solver's own count
  int evaluations = 0;                 ///< of residuals
  int jacobian_evaluations = 0;        ///< of residuals' Jacobians
  double time = 0;                     ///< median of the repetitions [s]
  double e1_position = 0;              ///< from the grasp to the hand [m]
  double e1_rotation = 0;              ///< [rad]; 0 for a point grasp
  double e2 = 0;                       ///< largest loop error [characteristic lengths, rad]
  double kkt = 0;                      ///< Summary::kkt_error
  Branch branch = Branch::kUnknown;    ///< assembly branch that was ended on
  /// From the target's own configuration, along what grasp or loops see (unseen_motions.h) [rad,
  /// characteristic lengths].
  double distance = 0;
};

/// True if a solver did what the kind of problem asks for: reached the target, or came to the
/// nearest pose where it is out of reach.
bool Succeeded(const Result& result, TargetKind kind);
/// False where nothing can be held against the solver: no such problem, or no such solver.
bool Counts(const Result& result);

}  // namespace vmech
