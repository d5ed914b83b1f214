#include "vmech/dynamics/loads/load_peaks.h"

#include <algorithm>
#include <cmath>

namespace vmech {

LoadPeaks FindPeaks(const LoadArrays& loads) {
  const size_t joints = loads.joint_count(), row = 6 * joints;
  const auto length = static_cast<Eigen::Index>(row);
  Eigen::ArrayXd components = Eigen::ArrayXd::Zero(length);
  double squared = 0;
  for (size_t i = 0; i < loads.pose_count(); ++i) {
    const double* w = loads.wrenches.data() + i * row;
    components = components.max(Eigen::Map<const Eigen::ArrayXd>(w, length).abs());
    for (size_t j = 0; j < joints; ++j, w += 6) {
      squared = std::max(squared, w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    }
  }
  for (const HandLoad& hand : loads.hands) {
    squared = std::max(squared, hand.wrench.force.squaredNorm());
  }
  LoadPeaks peaks{std::vector<Vector6d>(joints), std::sqrt(squared)};
  for (size_t j = 0; j < joints; ++j) {
    peaks.components[j] = components.segment<6>(static_cast<Eigen::Index>(6 * j));
  }
  return peaks;
}

}  // namespace vmech
