#include "vmech/dynamics/loads/open_components.h"
#include "vmech/dynamics/loads/load_result.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

constexpr double kZero = 1e-9;  // of the largest force, as reports show it

/// The largest size of every component over the study.
std::vector<Vector6d> Peaks(const LoadStudyResult& result) {
  std::vector<Vector6d> peaks(result.certainty.size(), Vector6d::Zero());
  for (const PoseLoads& pose : result.poses) {
    for (size_t j = 0; j < peaks.size(); ++j) {
      peaks[j] = peaks[j].cwiseMax(pose.joints[j].Stacked().cwiseAbs());
    }
  }
  return peaks;
}

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
                                                    const RuleDependence* dependence,
                                                    double length) {
  const std::vector<Vector6d> peaks = Peaks(result);
  const double force = kZero * LargestForce(peaks);
  std::vector<std::array<bool, 6>> open(result.certainty.size());
  for (size_t j = 0; j < open.size(); ++j) {
    for (size_t k = 0; k < 6; ++k) {
      if (result.certainty[j][k] != Certainty::kNotDetermined) continue;
      const bool loaded =
          !(peaks[j][static_cast<Eigen::Index>(k)] <= (k < 3 ? force : force * length));
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
