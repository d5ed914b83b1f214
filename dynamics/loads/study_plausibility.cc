#include "vmech/dynamics/loads/study_plausibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/mechanisms/plausibility.h"

namespace vmech {
namespace {

using Doubts = std::vector<std::string>;

constexpr double kStill = 1e-9;  // [m, rad]

void DoubtPoses(const LoadStudy& study, Doubts* doubts) {
  constexpr size_t kFew = 16;
  if (study.cycle == 0 || study.times.size() >= kFew) return;
  doubts->push_back(
      fmt::format("{} poses in a cycle: peaks between them are missed; 16 find them roughly, 360 "
                  "well (`steps`)",
                  study.times.size()));
}

bool JointMoves(const LoadStudyResult& result, size_t joint) {
  const Vector3d& start = result.poses.front().joints[joint].position;
  return std::any_of(result.poses.begin(), result.poses.end(), [&](const PoseLoads& pose) {
    return (pose.joints[joint].position - start).cwiseAbs().maxCoeff() > kStill;
  });
}

std::vector<bool> JointsThatMove(const LoadStudyResult& result) {
  std::vector<bool> move;
  for (size_t j = 0; j < result.poses.front().joints.size(); ++j) {
    move.push_back(JointMoves(result, j));
  }
  return move;
}

/// The links that are one with the ground where `joins` of a joint says so of its two links.
template <typename Joins>
std::vector<bool> OneWithGround(const Mechanism& mechanism, const Joins& joins) {
  std::vector<bool> one(mechanism.links.size(), false);
  one[mechanism.ground] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (size_t j = 0; j < mechanism.joints.size(); ++j) {
      const Joint& joint = mechanism.joints[j];
      if (one[joint.first.link] == one[joint.second.link] || !joins(j)) continue;
      one[joint.first.link] = one[joint.second.link] = grown = true;
    }
  }
  return one;
}

/// A drive that holds its joint still is meant to, and a weld as well.
void DoubtStillLinks(const LoadStudy& study, const LoadStudyResult& result, Doubts* doubts) {
  const Mechanism& mechanism = study.mechanism;
  const std::vector<bool> moves = JointsThatMove(result);
  if (std::find(moves.begin(), moves.end(), true) == moves.end()) return;
  std::set<size_t> driven;
  for (const JointDrive& drive : study.drives) driven.insert(drive.joint);
  const auto still = OneWithGround(mechanism, [&](size_t j) { return !moves[j]; });
  const auto held = OneWithGround(mechanism, [&](size_t j) {
    return mechanism.joints[j].type == JointType::kWeld || (driven.count(j) > 0 && !moves[j]);
  });
  std::vector<std::string> names;
  for (size_t i = 0; i < still.size(); ++i) {
    if (still[i] && !held[i]) names.push_back(mechanism.links[i].name);
  }
  if (names.empty()) return;
  doubts->push_back(
      fmt::format("the mechanism moves, but '{}' not: `vmech check` tells which joints are locked; "
                  "another anchor "
                  "or another drive may be meant",
                  fmt::join(names, "', '")));
}

void DoubtTable(const std::string& what, const TableRoughness& roughness, Doubts* doubts) {
  constexpr double kMostly = 0.5;
  if (roughness.acceleration == 0 || roughness.noise < kMostly * roughness.acceleration) return;
  doubts->push_back(fmt::format(
      "{}: the accelerations of its table are mostly rounding: {:.2g} in the mean, {:.2g} of it "
      "from the scatter of the figures (m/s^2, rad/s^2). Give more digits, or rows farther apart",
      what, roughness.acceleration, roughness.noise));
}

void DoubtTables(const LoadStudy& study, Doubts* doubts) {
  for (const JointDrive& drive : study.drives) {
    const std::string& name = study.mechanism.joints[drive.joint].name;
    DoubtTable(fmt::format("drive at '{}'", name), drive.law.roughness(), doubts);
  }
  if (!study.hand) return;
  DoubtTable("positions of the hand", study.hand->law.position_roughness(), doubts);
  DoubtTable("orientations of the hand", study.hand->law.rotation_roughness(), doubts);
}

}  // namespace

std::vector<std::string> DoubtsOf(const LoadStudy& study, const LoadStudyResult& result) {
  Doubts doubts = DoubtsOf(study.mechanism, !study.external.empty());
  DoubtPoses(study, &doubts);
  DoubtStillLinks(study, result, &doubts);
  DoubtTables(study, &doubts);
  return doubts;
}

}  // namespace vmech
