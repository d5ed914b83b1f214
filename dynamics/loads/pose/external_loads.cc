#include "vmech/dynamics/loads/pose/external_loads.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {

bool OutsideTable(const ExternalLoad& load, double at) {
  if (load.over == ExternalLoad::Over::kConstant || load.period > 0) return false;
  // A table read from a file in degrees may miss its own end by a rounding.
  const double slack = 1e-9 * (load.at.back() - load.at.front());
  return at < load.at.front() - slack || at > load.at.back() + slack;
}

template <typename T>
Wrench<T> WrenchAt(ExternalLoad::Over over, const LoadTableOf<T>& table, T at) {
  const std::vector<T>& x = table.at;
  if (over == ExternalLoad::Over::kConstant || x.size() < 2) return table.wrenches.front();
  const T zero(0), one(1);
  if (table.period > zero) {
    at -= table.period * std::floor(Lane((at - x.front()) / table.period, 0));
  }
  const auto after = std::upper_bound(x.begin(), x.end(), at);
  size_t i = after == x.begin() ? 0 : static_cast<size_t>(after - x.begin()) - 1;
  // Behind the last row a repeating table leads back to its first.
  const bool wraps = table.period > zero && i + 1 == x.size();
  if (!wraps) i = std::min(i, x.size() - 2);
  const size_t next = wraps ? 0 : i + 1;
  const T width = wraps ? T(x.front() + table.period - x.back()) : T(x[next] - x[i]);
  const T s = width > zero ? T((at - x[i]) / width) : zero;
  const T share = s < zero ? zero : one < s ? one : s;
  const Wrench<T>&a = table.wrenches[i], &b = table.wrenches[next];
  return {(one - share) * a.force + share * b.force, (one - share) * a.moment + share * b.moment};
}

double TableArgument(const LoadModel& model, const ExternalLoad& load, const Motion& motion,
                     size_t pose) {
  switch (load.over) {
    case ExternalLoad::Over::kTime:
      return motion.times[pose];
    case ExternalLoad::Over::kDriveCoordinate:
      return motion.drives[pose * model.drives.size()].position;
    case ExternalLoad::Over::kConstant:
      break;
  }
  return 0;
}

namespace {

/// The slope of TableArgument.
double ArgumentSlope(const LoadModel& model, const ExternalLoad& load,
                     const PrescribedSlopes& slopes, size_t pose) {
  switch (load.over) {
    case ExternalLoad::Over::kTime:
      return slopes.times.empty() ? 0 : slopes.times[pose];
    case ExternalLoad::Over::kDriveCoordinate:
      return slopes.drives.empty() ? 0 : slopes.drives[pose * model.drives.size()].position;
    case ExternalLoad::Over::kConstant:
      break;
  }
  return 0;
}

template <typename T>
Vector3<T> PointOfApplication(const ExternalLoad& load, size_t i, const LoadWorkspace<T>& ws) {
  if constexpr (kIsTaped<T>) {
    return ws.on_tape->points[i];
  } else if constexpr (kIsDual<T>) {
    if (ws.slopes != nullptr) return ws.slopes->external[i].p_L;
  }
  return load.p_L.cast<T>();
}

/// At the poses `pose`, ..., in the load's own axes.
template <typename T>
Wrench<T> WrenchAtPoses(const LoadModel& model, const Motion& motion, size_t pose, size_t i,
                        const LoadWorkspace<T>& ws) {
  const ExternalLoad& load = model.external[i];
  if constexpr (kIsTaped<T>) {
    return ws.on_tape->external[i];
  } else {
    if constexpr (kIsDual<T>) {
      if (ws.slopes != nullptr) return WrenchWithSlope(model, motion, pose, i, *ws.slopes);
    }
    Wrenchd lanes[kLanesOf<T>];
    for (int lane = 0; lane < kLanesOf<T>; ++lane) {
      lanes[lane] = WrenchAt(load, TableArgument(model, load, motion, pose + lane));
    }
    Wrench<T> W;
    for (int k = 0; k < 3; ++k) {
      W.force[k] = FromLanes<T>([&](int lane) { return lanes[lane].force[k]; });
      W.moment[k] = FromLanes<T>([&](int lane) { return lanes[lane].moment[k]; });
    }
    return W;
  }
}

}  // namespace

Wrench<Dual> WrenchWithSlope(const LoadModel& model, const Motion& motion, size_t pose, size_t load,
                             const PrescribedSlopes& slopes) {
  const ExternalLoad& external = model.external[load];
  const Dual argument(TableArgument(model, external, motion, pose),
                      ArgumentSlope(model, external, slopes, pose));
  return WrenchAt<Dual>(external.over, slopes.external[load], argument);
}

template <typename T>
void EvaluateExternalLoads(const LoadModel& model, const Motion& motion, size_t pose,
                           LoadWorkspace<T>* ws) {
  for (size_t i = 0; i < model.external.size(); ++i) {
    const ExternalLoad& load = model.external[i];
    const int node = model.tree.NodeOfLink(load.link);
    if (node < 0) continue;
    const FrameT<T> L = ws->tree.at(node).X * ws->tree.at(node).X_BL;
    FrameT<T> at;
    if (load.axes == ExternalLoad::Axes::kLink) at = L;
    at.p = PointInWorld(L, TripleOf<T>(PointOfApplication(load, i, *ws)));
    ws->external[i] = WrenchFrom(at, WrenchAtPoses(model, motion, pose, i, *ws));
  }
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                      \
  template void EvaluateExternalLoads<T>(const LoadModel&, const Motion&, size_t, \
                                         LoadWorkspace<T>*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)
template Wrenchd WrenchAt<double>(ExternalLoad::Over, const LoadTableOf<double>&, double);

}  // namespace vmech
