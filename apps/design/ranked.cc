#include "vmech/apps/design/ranked.h"

#include <algorithm>
#include <cmath>

namespace vmech {

std::vector<RankedParameter> RankParameters(const Sensitivities& result, const FigureSlopes& figure,
                                            size_t most, double least) {
  std::vector<RankedParameter> ranked;
  for (size_t p = 0; p < result.parameters.size(); ++p) {
    const double elasticity = figure.Elasticity(p, result.parameters[p]);
    if (std::abs(elasticity) >= least) ranked.push_back({p, elasticity});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const RankedParameter& a, const RankedParameter& b) {
                     return std::abs(a.elasticity) > std::abs(b.elasticity);
                   });
  ranked.resize(std::min(ranked.size(), most));
  return ranked;
}

std::vector<SharedRefusal> SharedRefusals(const Sensitivities& result) {
  std::vector<SharedRefusal> shared;
  for (size_t p = 0; p < result.parameters.size(); ++p) {
    const std::string &name = result.parameters[p].name, &reason = result.refusals[p];
    if (reason.empty()) continue;
    const auto same = std::find_if(shared.begin(), shared.end(),
                                   [&](const SharedRefusal& r) { return r.reason == reason; });
    if (same == shared.end()) {
      shared.push_back({name, reason});
    } else {
      same->parameters += ", " + name;
    }
  }
  return shared;
}

}  // namespace vmech
