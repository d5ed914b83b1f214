#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/mechanism.h"
#include "vmech/solvers/stopping_rule.h"

namespace vmech {

/// How the targets of a block are made. Closed configurations are random ones, reached from the
/// mechanism's start by a walk over closed configurations; a target is the pose of the grasp there.
enum class TargetKind {
  kReachable,    ///< a closed configuration
  kUnreachable,  ///< off it by a distance, in a direction in which the grasp cannot go
  kSingular,     ///< a closed configuration near which a motion of the mechanism stops the grasp
  kDeadCentre,   ///< a path through a pose at which a joint turns back
  kTracking,     ///< a path
};

/// Where a solver begins.
enum class StartKind {
  kNear,  ///< a closed configuration at a distance from that of the target
  kFar,   ///< a closed configuration that has nothing to do with it
};

/// The kind of target in words.
std::string_view NameOf(TargetKind kind);
/// The kind of start in words.
std::string_view NameOf(StartKind start);

/// Targets of one kind. Distances and steps are measured over all coordinates of the tree, in
/// radians and characteristic lengths.
struct TargetBlock {
  std::string name;                          ///< unique in the suite
  TargetKind kind = TargetKind::kReachable;  ///< where targets lie
  StartKind start = StartKind::kNear;        ///< where solves start
  int count = 1;                             ///< problems per mechanism
  double start_distance = 0.1;  ///< kNear: of the start from the target's configuration
  double offset = 0.1;          ///< kUnreachable: of the target from the grasp [as above]
  double closeness = 1e-3;      ///< kSingular: largest smallest singular value; see target_maker.h
  int steps = 50;               ///< kTracking, kDeadCentre: targets on the path
  double step = 0.02;           ///< kTracking, kDeadCentre: from one target to the next

  /// True if the targets follow one another on a path.
  bool is_path() const { return kind == TargetKind::kTracking || kind == TargetKind::kDeadCentre; }
};

/// A mechanism of a suite.
struct SuiteMechanism {
  std::string name;         ///< unique in the suite
  Mechanism mechanism;      ///< assembled from its start values
  Grasp grasp;              ///< whose pose the targets are
  std::vector<int> blocks;  ///< of the suite, that this mechanism takes part in
};

/// What `vmech compare` is to compute: every block of every mechanism by every solver.
struct Suite {
  std::filesystem::path path;  ///< of the suite's file
  std::string name;            ///< of the suite
  std::string description;     ///< free text, may be empty
  uint64_t seed = 1;           ///< of all random numbers
  StoppingRule stopping;       ///< the same for every solver
  /// Largest distance of grasp and hand that counts as reached [characteristic lengths, rad].
  double reach_tolerance = 1e-6;
  int repetitions = 3;                     ///< solves whose median time is reported
  std::vector<SuiteMechanism> mechanisms;  ///< in the order of the file
  std::vector<TargetBlock> blocks;         ///< in the order of the file
  uint64_t digest = 0;                     ///< of the suite's file and of those it names
};

/// One problem of a suite, by indices.
struct ProblemId {
  int mechanism = 0;  ///< index in Suite::mechanisms
  int block = 0;      ///< index in Suite::blocks
  int index = 0;      ///< counted from 0, below TargetBlock::count
  /// In the order of tables.
  friend auto operator<=>(const ProblemId&, const ProblemId&) = default;  // NOLINT
};

/// All problems of a suite, in order.
std::vector<ProblemId> ProblemsOf(const Suite& suite);

}  // namespace vmech
