#include "vmech/dynamics/loads/open_components.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

constexpr double kZero = 1e-9;  // of the largest force, as reports show it

double LargestForce(const std::vector<Vector6d>& peaks) {
  double largest = 0;
  for (const Vector6d& peak : peaks) largest = std::max(largest, peak.head<3>().maxCoeff());
  return largest;
}

}  // namespace

bool AnyNotDetermined(const LoadStudyResult& result) {
  return std::any_of(
      result.certainty.begin(), result.certainty.end(), [](const JointCertainty& joint) {
        return std::find(joint.begin(), joint.end(), Certainty::kNotDetermined) != joint.end();
      });
}

std::vector<std::array<bool, 6>> FindOpenComponents(const LoadStudyResult& result,
                                                    const LoadPeaks& peaks,
                                                    const RuleDependence* dependence,
                                                    double length) {
  const double force = kZero * LargestForce(peaks.components);
  std::vector<std::array<bool, 6>> open(result.certainty.size());
  for (size_t j = 0; j < open.size(); ++j) {
    for (size_t k = 0; k < 6; ++k) {
      if (result.certainty[j][k] != Certainty::kNotDetermined) continue;
      const double peak = peaks.components[j][static_cast<Eigen::Index>(k)];
      const bool loaded = !(peak <= (k < 3 ? force : force * length));
      open[j][k] = loaded || dependence == nullptr || dependence->joints[j][k];
    }
  }
  return open;
}

JointCertainty VerdictsThatMatter(const LoadStudyResult& result, size_t joint) {
  JointCertainty verdicts = result.certainty[joint];
  for (size_t k = 0; k < verdicts.size() && !result.open.empty(); ++k) {
    if (verdicts[k] == Certainty::kNotDetermined && !result.open[joint][k]) {
      verdicts[k] = Certainty::kCertain;
    }
  }
  return verdicts;
}

}  // namespace vmech
