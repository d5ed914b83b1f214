#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/load_workspace.h"
#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {

/// Dry friction at rest is what it must be to hold, within what it can be. Let n_c be the rates of
/// a resting contact c per unit speed of the drives that stand still (columns), f_c its limits, and
/// e what those drives would have to exert without friction at rest. Friction
///
///   F_c = f_c^2 n_c y / w_c,   (sum_c n_c' f_c^2 n_c / w_c) y = e,   sum_c w_c = 1
///
/// leaves nothing to the drives, for any weights. They are chosen such that all contacts that a
/// beginning motion -y would move use the same share s = |f_c n_c y| / w_c of what they can exert;
/// with one drive s = |e| / sum_c |f_c n_c|. Where s > 1 friction is all that it can be, F_c / s,
/// and the drives exert the rest, (1 - 1/s) e. Neither depends on how the free motions are counted
/// or an anchor is turned about its axis.
///
/// At a reversal e holds the inertia forces: friction is that value between the two before and
/// after which leaves least to the drive. A joint that rests while all drives move (a slider at its
/// end) has no share in their forces; its friction is taken as zero, halfway.

/// Indices in v of the drives (all free motions, if a hand drives) that stand still at a pose:
/// their speed is rounding beside the largest of the study, kRest times it.
std::vector<int> StandingDrives(const LoadModel& model, const Motion& motion, size_t pose);
/// The share of the largest speed below which a speed is rounding.
inline constexpr double kRest = 1e-9;

/// Does any drive stand still in the poses that begin with this one, as many as `lanes`?
bool AnyStands(const LoadModel& model, const Motion& motion, size_t pose, int lanes);

/// The speed of a drive that counts as one: 1 rad/s, or the characteristic length in a second.
double CreepSpeed(const LoadModel& model, int v);

/// Tells sliding contacts from resting ones; writes ws->sliding, and of single poses ws->resting
/// from the creep of ws.
template <typename T>
void FindContacts(const LoadModel& model, const Motion& motion, LoadWorkspace<T>* ws);

/// Adds to ws->along what friction at rest exerts, under the wrenches of ws->loads. Needs ws->tau
/// and ws->passive without it; writes ws->held_by_friction.
void HoldByFriction(const LoadModel& model, LoadWorkspace<double>* ws);

}  // namespace vmech
