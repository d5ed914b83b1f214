#include "vmech/comparison/target_maker.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/loops/unseen_motions.h"

namespace vmech {
namespace {

constexpr double kDetermined = 1e-7;  // smallest singular value that tells rounding from motion
constexpr double kStride = 0.25;      // of a walk that loses its way [rad, characteristic lengths]
constexpr double kTurn = 0.5;         // per step of a walk [rad]
constexpr double kPathTurn = 0.05;    // per step of a path

KinematicTree AssembledTree(const SuiteMechanism& given) {
  const AssembledMechanism assembled = AssembleMechanism(given.mechanism);
  if (!assembled.summary.closed) {
    throw std::runtime_error(given.name + ": " + assembled.summary.message);
  }
  return BuildKinematicTree(assembled.mechanism);
}

VectorXd RandomConfiguration(Subject* subject, PortableRandom* random) {
  constexpr int kLongest = 48;
  ClosedWalk walk = subject->WalkFrom(subject->q_start(), random);
  for (int steps = 1 + random->Below(kLongest); steps > 0; --steps) {
    walk.Step(kStride * random->Between(0.5, 1.5), kTurn);
  }
  return walk.q();
}

/// A closed configuration at a distance, in small steps that stay on the branch.
VectorXd AtDistance(Subject* subject, const VectorXd& q, double distance, PortableRandom* random) {
  ClosedWalk walk = subject->WalkFrom(q, random);
  const int steps = std::max(1, static_cast<int>(std::ceil(distance / kStride)));
  for (int i = 0; i < steps; ++i) walk.Step(distance / steps, 0);
  return walk.q();
}

VectorXd StartFor(Subject* subject, const TargetBlock& block, const VectorXd& q,
                  PortableRandom* random) {
  if (block.start == StartKind::kFar) return RandomConfiguration(subject, random);
  return AtDistance(subject, q, block.start_distance, random);
}

void AddTarget(Subject* subject, const VectorXd& q, Problem* problem) {
  problem->targets.push_back(subject->problem().GraspPose(q));
  problem->own.push_back(q);
}

/// Moves a target off the grasp by `offset` in a direction in which the grasp cannot go.
void PushOff(Subject* subject, double offset, PortableRandom* random, Problem* problem) {
  constexpr double kNoMotion = 1e-9;
  const VectorXd& q = problem->own[0];
  const LeftSingularVectors svd = FindLeftSingularVectors(subject->GraspMotions(q));
  const Eigen::Index rank = (svd.values.array() > kNoMotion).count();
  const Eigen::Index barred = svd.vectors.cols() - rank;
  if (barred == 0) {
    problem->defect = "the grasp can go in every direction: nothing nearby is out of its reach";
    return;
  }
  const VectorXd u =
      offset * (svd.vectors.rightCols(barred) * random->NormalVector(barred)).normalized();
  Posed& X_WH = problem->targets[0];
  X_WH.p += subject->tree().length * u.head<3>();
  if (u.size() < 6 || u.tail<3>().norm() == 0) return;
  const Vector3d turn = u.tail<3>();
  X_WH.R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * X_WH.R;
}

/// Goes to ever less determined configurations, by shrinking steps in random free directions.
VectorXd Downhill(Subject* subject, VectorXd q, double closeness, PortableRandom* random) {
  constexpr double kShortest = 1e-6;
  constexpr int kTries = 6;
  double least = subject->Determination(q);
  for (double size = kStride; size > kShortest && least > closeness; size /= 2) {
    for (int i = 0; i < kTries && least > closeness; ++i) {
      ClosedWalk walk = subject->WalkFrom(q, random);
      if (!walk.Step(size, 0)) continue;
      const double value = subject->Determination(walk.q());
      if (value < least) least = value, q = walk.q(), i = -1;
    }
  }
  return q;
}

VectorXd NearlySingular(Subject* subject, const TargetBlock& block, PortableRandom* random,
                        std::string* defect) {
  constexpr int kCandidates = 12;
  VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kCandidates; ++i) {
    VectorXd q = RandomConfiguration(subject, random);
    const double value = subject->Determination(q);
    if (value < least) least = value, best = std::move(q);
  }
  best = Downhill(subject, best, block.closeness, random);
  least = subject->Determination(best);
  if (least > block.closeness) {
    *defect = fmt::format("no singular pose found: the smallest singular value came down to {:.2g}",
                          least);
  }
  return best;
}

/// A velocity that changed its sign: the joint turns back. -1 if there is none.
int TurningBack(const KinematicTree& tree, const VectorXd& before, const VectorXd& after) {
  constexpr double kMoves = 1e-9;  // of a step: the joint moves at all
  for (const TreeNode& node : tree.nodes) {
    if (node.motion != NodeMotion::kRevolute && node.motion != NodeMotion::kPrismatic) continue;
    const double a = before[node.v], b = after[node.v];
    if (a * b < 0 && std::min(std::abs(a), std::abs(b)) > kMoves) return node.v;
  }
  return -1;
}

/// The configurations around the first turning point on the way from a random one; empty if there
/// is none.
std::vector<VectorXd> PathThroughDeadCentre(Subject* subject, const TargetBlock& block,
                                            PortableRandom* random) {
  constexpr double kLongestWay = 15;  // [rad, lengths]: more than a cycle
  const int before = block.steps / 2;
  ClosedWalk walk = subject->WalkFrom(RandomConfiguration(subject, random), random);
  std::deque<VectorXd> path{walk.q()};
  if (!walk.Step(block.step, 0)) return {};
  VectorXd direction = walk.direction();
  bool found = false;
  for (double way = 0; !found && way < kLongestWay; way += block.step) {
    path.push_back(walk.q());
    if (!walk.Step(block.step, 0)) return {};
    const bool onward = walk.direction().dot(direction) > 0;  // not back from a limit
    found = static_cast<int>(path.size()) > before && onward &&
            TurningBack(subject->tree(), direction, walk.direction()) >= 0;
    direction = walk.direction();
    if (static_cast<int>(path.size()) > before + 1) path.pop_front();
  }
  if (!found) return {};
  while (static_cast<int>(path.size()) < block.steps + 1) {
    path.push_back(walk.q());
    if (!walk.Step(block.step, 0)) return {};
  }
  return {path.begin(), path.end()};
}

std::vector<VectorXd> Path(Subject* subject, const TargetBlock& block, PortableRandom* random) {
  ClosedWalk walk = subject->WalkFrom(RandomConfiguration(subject, random), random);
  std::vector<VectorXd> path{walk.q()};
  for (int i = 0; i < block.steps; ++i) {
    walk.Step(block.step, kPathTurn);
    path.push_back(walk.q());
  }
  return path;
}

/// The first configuration of a path is the start, the others give the targets.
Problem PathProblem(Subject* subject, const TargetBlock& block, PortableRandom* random) {
  Problem problem;
  std::vector<VectorXd> path;
  if (block.kind == TargetKind::kTracking) {
    path = Path(subject, block, random);
  } else if (FreeMotionBasis(subject->tree(), subject->q_start()).cols() != 1) {
    problem.defect = "a mechanism with several freedoms has no dead centres";
  } else if (path = PathThroughDeadCentre(subject, block, random); path.empty()) {
    problem.defect = "no joint turns back";
  }
  if (path.empty()) return problem;
  problem.start = path.front();
  for (size_t i = 1; i < path.size(); ++i) AddTarget(subject, path[i], &problem);
  return problem;
}

Problem PoseProblem(Subject* subject, const TargetBlock& block, PortableRandom* random) {
  Problem problem;
  const VectorXd q = block.kind == TargetKind::kSingular
                         ? NearlySingular(subject, block, random, &problem.defect)
                         : RandomConfiguration(subject, random);
  if (!problem.defect.empty()) return problem;
  AddTarget(subject, q, &problem);
  if (block.kind == TargetKind::kUnreachable) PushOff(subject, block.offset, random, &problem);
  problem.start = StartFor(subject, block, q, random);
  return problem;
}

}  // namespace

Subject::Subject(const SuiteMechanism& given)
    : tree_(AssembledTree(given)),
      problem_(tree_, GraspFrame{tree_.NodeOfLink(given.grasp.link),
                                 tree_.X_node_link(given.grasp.link) * given.grasp.X_LG,
                                 given.grasp.kind}),
      q_start_(StartCoordinates(tree_)),
      rank_(AnalyseMobility(tree_, q_start_).rank),
      unseen_(FindUnseenMotions(&problem_, q_start_).count()) {}

ClosedWalk Subject::WalkFrom(const VectorXd& q, PortableRandom* random) const {
  return {tree_, problem_.bounds(), rank_, q, random};
}

MatrixXd Subject::GraspMotions(const VectorXd& q) {
  MatrixXd J(problem_.sizes().residuals, tree_.nv);
  problem_.SetTarget(problem_.GraspPose(q));
  problem_.Evaluate(q, nullptr, &J, nullptr, nullptr);
  return J * VelocityScale(tree_).asDiagonal() * FreeMotionBasis(tree_, q);
}

double Subject::Determination(const VectorXd& q) {
  const MatrixXd JZ = GraspMotions(q);
  const Eigen::Index seen = std::min(JZ.cols() - unseen_, JZ.rows());
  return seen <= 0 ? 0 : FindLeftSingularVectors(JZ).values[seen - 1];
}

Problem MakeProblem(Subject* subject, const TargetBlock& block, uint64_t seed) {
  PortableRandom random(seed);
  if (block.kind == TargetKind::kSingular &&
      subject->Determination(RandomConfiguration(subject, &random)) < kDetermined) {
    Problem none;
    none.defect = "the grasp does not tell the configuration, so that every pose is singular";
    return none;
  }
  Problem problem =
      block.is_path() ? PathProblem(subject, block, &random) : PoseProblem(subject, block, &random);
  for (const VectorXd& q : problem.own) {
    problem.determined = problem.determined && subject->Determination(q) > kDetermined;
  }
  return problem;
}

}  // namespace vmech
