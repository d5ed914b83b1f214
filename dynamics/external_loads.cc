#include "vmech/dynamics/external_loads.h"

#include <algorithm>
#include <cmath>

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

double TableArgument(const ExternalLoad& load, const PoseInput& input) {
  switch (load.over) {
    case ExternalLoad::Over::kTime:
      return input.time;
    case ExternalLoad::Over::kDriveCoordinate:
      return input.drives.front().position;
    case ExternalLoad::Over::kConstant:
      break;
  }
  return 0;
}

void EvaluateExternalLoads(const LoadModel& model, const PoseInput& input, const LoadWorkspace& ws,
                           std::vector<Wrenchd>* external_W) {
  for (size_t i = 0; i < model.external.size(); ++i) {
    const ExternalLoad& load = model.external[i];
    const Wrenchd w = WrenchAt(load, TableArgument(load, input));
    const int node = model.tree.NodeOfLink(load.link);
    (*external_W)[i] = w;
    if (load.axes == ExternalLoad::Axes::kWorld || node < 0) continue;
    const Matrix3d R_WL = ws.tree.nodes[node].X_WB.R * model.tree.nodes[node].X_BL.R;
    (*external_W)[i] = {R_WL * w.force, R_WL * w.moment};
  }
}

}  // namespace vmech
