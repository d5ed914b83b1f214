#pragma once

#include <string>
#include <vector>

#include "vmech/studies/sensitivities.h"

namespace vmech {

/// A parameter among those that move a figure.
struct RankedParameter {
  size_t parameter = 0;
  double elasticity = 0;  ///< percent of the figure by a percent of the parameter
};

/// The parameters that move a figure by at least `least` percent by a percent, the strongest first,
/// at most `most` of them.
std::vector<RankedParameter> RankParameters(const Sensitivities& result, const FigureSlopes& figure,
                                            size_t most, double least);

/// Parameters that have no derivative for the same reason.
struct SharedRefusal {
  std::string parameters;  ///< "crank/pin.z, rod/pin.z"
  std::string reason;
};
std::vector<SharedRefusal> SharedRefusals(const Sensitivities& result);

}  // namespace vmech
