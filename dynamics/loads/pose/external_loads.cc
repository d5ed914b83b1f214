#include "vmech/dynamics/loads/pose/external_loads.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {

bool OutsideTable(const ExternalLoad& load, double at) {
  if (load.over == ExternalLoad::Over::kConstant || load.period > 0) return false;
  // A table read from a file in degrees may miss its own end by a rounding.
  const double slack = 1e-9 * (load.at.back() - load.at.front());
  return at < load.at.front() - slack || at > load.at.back() + slack;
}

Wrenchd WrenchAt(const ExternalLoad& load, double at) {
  const std::vector<double>& x = load.at;
  if (load.over == ExternalLoad::Over::kConstant || x.size() < 2) return load.wrenches.front();
  if (load.period > 0) at -= load.period * std::floor((at - x.front()) / load.period);
  const auto after = std::upper_bound(x.begin(), x.end(), at);
  size_t i = after == x.begin() ? 0 : static_cast<size_t>(after - x.begin()) - 1;
  // Behind the last row a repeating table leads back to its first.
  const bool wraps = load.period > 0 && i + 1 == x.size();
  if (!wraps) i = std::min(i, x.size() - 2);
  const size_t next = wraps ? 0 : i + 1;
  const double width = wraps ? x.front() + load.period - x.back() : x[next] - x[i];
  const double s = width > 0 ? std::clamp((at - x[i]) / width, 0.0, 1.0) : 0.0;
  const Wrenchd &a = load.wrenches[i], &b = load.wrenches[next];
  return {(1 - s) * a.force + s * b.force, (1 - s) * a.moment + s * b.moment};
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

template <typename T>
void EvaluateExternalLoads(const LoadModel& model, const Motion& motion, size_t pose,
                           LoadWorkspace<T>* ws) {
  for (size_t i = 0; i < model.external.size(); ++i) {
    const ExternalLoad& load = model.external[i];
    Wrenchd lanes[kLanesOf<T>];
    for (int lane = 0; lane < kLanesOf<T>; ++lane) {
      lanes[lane] = WrenchAt(load, TableArgument(model, load, motion, pose + lane));
    }
    Wrench<T> W;
    for (int k = 0; k < 3; ++k) {
      W.force[k] = FromLanes<T>([&](int lane) { return lanes[lane].force[k]; });
      W.moment[k] = FromLanes<T>([&](int lane) { return lanes[lane].moment[k]; });
    }
    const int node = model.tree.NodeOfLink(load.link);
    if (node < 0) continue;
    const FrameT<T> L = ws->tree.at(node).X * ws->tree.at(node).X_BL;
    FrameT<T> at;
    if (load.axes == ExternalLoad::Axes::kLink) at = L;
    at.p = PointInWorld(L, TripleOf<T>(load.p_L.cast<T>()));
    ws->external[i] = WrenchFrom(at, W);
  }
}

template void EvaluateExternalLoads<double>(const LoadModel&, const Motion&, size_t,
                                            LoadWorkspace<double>*);
template void EvaluateExternalLoads<Dual>(const LoadModel&, const Motion&, size_t,
                                          LoadWorkspace<Dual>*);
template void EvaluateExternalLoads<Lanes4>(const LoadModel&, const Motion&, size_t,
                                            LoadWorkspace<Lanes4>*);

}  // namespace vmech
