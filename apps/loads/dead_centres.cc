#include "vmech/apps/loads/dead_centres.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kAtRest = 1e-9;                        // of the motor's speed: rounding
constexpr double kSame = 0.1 * std::numbers::pi / 180;  // dead centres of one turn and of the next

/// What the motor and a joint do from pose to pose.
struct Track {
  std::vector<double> angle, rate;
};

/// A cycle is run through twice, so that none of its poses is the first or the last.
Track TrackOf(const LoadStudy& study, const LoadStudyResult& result, size_t joint) {
  Track track;
  const size_t count = result.poses.size();
  const double first = result.poses.front().drives[0].position;
  const double span = result.poses.back().drives[0].position - first;
  const double whole = kTurn * std::round(span / kTurn * static_cast<double>(count) /
                                          static_cast<double>(count - 1));
  for (const int round : {0, 1}) {
    if (round == 1 && study.cycle == 0) break;
    for (const PoseLoads& pose : result.poses) {
      track.angle.push_back(pose.drives[0].position + round * whole);
      track.rate.push_back(pose.joints[joint].rate[0]);
    }
  }
  return track;
}

/// Where the rate between two poses is zero; poses between them stand still.
double AngleOfZero(const Track& track, size_t before, size_t after) {
  if (after > before + 1) return track.angle[before + 1];
  const double share = track.rate[before] / (track.rate[before] - track.rate[after]);
  return track.angle[before] + share * (track.angle[after] - track.angle[before]);
}

/// The angle in 0..2 pi, and 0 for what is 2 pi but for rounding.
double InOneTurn(double angle) {
  const double turned = angle - kTurn * std::floor(angle / kTurn);
  return kTurn - turned < 1e-9 ? 0 : turned;
}

void AddIfNew(double angle, int joint, std::vector<DeadCentre>* centres) {
  const double turned = InOneTurn(angle);
  for (const DeadCentre& known : *centres) {
    const double apart = std::abs(known.angle - turned);
    if (known.joint == joint && std::min(apart, kTurn - apart) < kSame) return;
  }
  centres->push_back({turned, joint});
}

void AddTurnsBack(const Track& track, double still, int joint, std::vector<DeadCentre>* centres) {
  size_t before = track.rate.size();
  for (size_t i = 0; i < track.rate.size(); ++i) {
    if (std::abs(track.rate[i]) <= still) continue;
    if (before < i && std::signbit(track.rate[before]) != std::signbit(track.rate[i])) {
      AddIfNew(AngleOfZero(track, before, i), joint, centres);
    }
    before = i;
  }
}

/// The joint between the ground and a link that the motor moves by others.
bool IsOutput(const LoadStudy& study, size_t joint) {
  const Joint& j = study.mechanism.joints[joint];
  const int ground = study.mechanism.ground;
  return FreedomsOf(j.type) == 1 && static_cast<int>(joint) != study.drives[0].joint &&
         (j.first.link == ground || j.second.link == ground);
}

}  // namespace

bool RunsOneWay(const LoadStudy& study, const LoadStudyResult& result) {
  if (study.drives.size() != 1 || result.poses.size() < 2) return false;
  const auto step = [&](size_t i) {
    return result.poses[i].drives[0].position - result.poses[i - 1].drives[0].position;
  };
  for (size_t i = 1; i < result.poses.size(); ++i) {
    if (step(i) == 0 || std::signbit(step(i)) != std::signbit(step(1))) return false;
  }
  return true;
}

std::vector<DeadCentre> FindDeadCentres(const LoadStudy& study, const LoadStudyResult& result) {
  std::vector<DeadCentre> centres;
  if (!RunsOneWay(study, result)) return centres;
  const JointDrive& drive = study.drives[0];
  if (!IsRotation(study.mechanism.joints[drive.joint].type, drive.freedom)) return centres;
  double speed = 0;
  for (const PoseLoads& pose : result.poses) {
    speed = std::max(speed, std::abs(pose.drives[0].velocity));
  }
  for (size_t j = 0; j < study.mechanism.joints.size(); ++j) {
    if (!IsOutput(study, j)) continue;
    const bool turns = IsRotation(study.mechanism.joints[j].type, 0);
    const double length = turns ? 1 : CharacteristicLength(study.mechanism);
    AddTurnsBack(TrackOf(study, result, j), kAtRest * speed * length, static_cast<int>(j),
                 &centres);
  }
  std::sort(centres.begin(), centres.end(),
            [](const DeadCentre& a, const DeadCentre& b) { return a.angle < b.angle; });
  return centres;
}

}  // namespace vmech
