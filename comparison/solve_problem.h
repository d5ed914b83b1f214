#pragma once

#include "vmech/comparison/result.h"
#include "vmech/comparison/target_maker.h"

namespace vmech {

/// Solves one problem of a suite by one solver and judges what came out: e1, e2, KKT error and
/// curvature are those of the returned configuration, whatever the solver says of itself.
///
/// A single target is solved `repetitions` times from the same start, or once if that takes long;
/// time is the median. A path is followed once, every target from the configuration that was found
/// for the last one; a target that is not reached leaves that where it is, and after five of them
/// in a row the path is lost. A jump is a step of more than ten times the path's own, where the
/// grasp tells the configuration. Configurations that differ by motions alone that neither grasp
/// nor loops see (unseen_motions.h) are the same here.
Result SolveProblem(const Suite& suite, const ProblemId& id, const Problem& problem,
                    Subject* subject, SolverEntry solver);

}  // namespace vmech
