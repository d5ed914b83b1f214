#include "vmech/apps/ik/ik.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/kinematics/inverse/hand_tracker.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/unseen_motions.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/plausibility.h"

namespace vmech {
namespace {

/// Residuals below this are those of a hand in reach [-]; a solver leaves their square root of its
/// own tolerance where the grasp is nearly singular.
constexpr double kReached = 1e-7;
/// Poses nearer to each other than this are one [rad and characteristic lengths].
constexpr double kSamePose = 1e-4;
constexpr int kLeadingTargets = 500;

std::vector<double> Numbers(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  std::string word;
  for (char c : text + " ") {
    if (c != ' ' && c != ',' && c != '\t') {
      word += c;
    } else if (!word.empty()) {
      const std::optional<double> number = ParseNumber(word);
      if (!number) {
        throw OptionError(
            fmt::format("{}: {} is not a number; give numbers with blanks between them, as in "
                        "{} \"0.1 0.2 0\"",
                        option, Quoted(word), option));
      }
      numbers.push_back(*number);
      word.clear();
    }
  }
  return numbers;
}

/// What the file says about its units: the mechanism itself is in SI already.
void ReadFileUnits(const std::filesystem::path& path, IkAnswer* answer) {
  Document document(ReadTextFile(path), path.string());
  const Node units = document.root()["units"];
  answer->units = ReadUnits(units);
  answer->length_unit = units["length"].Text("m");
  answer->angle_unit = units["angle"].Text("rad");
}

int GraspIndex(const Mechanism& mechanism, const IkQuestion& question) {
  const std::string& name = question.grasp;
  std::vector<std::string> names;
  for (const Grasp& grasp : mechanism.grasps) names.push_back(grasp.name);
  if (names.empty()) {
    throw FileErrors(question.mechanism.string(),
                     "has no grasp by which to hold the mechanism; add one under `grasps`");
  }
  if (name.empty()) return 0;
  const int index = FindGrasp(mechanism, name);
  if (index >= 0) return index;
  throw OptionError(
      fmt::format("--grasp: there is no grasp {}{}", Quoted(name), DidYouMean(name, names)));
}

/// "joint=value" or "joint.freedom=value" in SI.
struct StartValue {
  int joint, freedom;
  double value;
};

/// The freedoms that `--start` can name: "pin", "tube.rz".
std::vector<std::string> NamesOfStarts(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joint.type); ++k) names.push_back(NameOfFreedom(joint, k));
  }
  return names;
}

/// The joint and the freedom of a name; the value is not yet known.
StartValue FindStart(const Mechanism& mechanism, const std::string& name) {
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    if (joint.type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      if (NameOfFreedom(joint, k) == name) return {static_cast<int>(j), k, 0};
    }
  }
  const int joint = FindJoint(mechanism, name);
  if (joint < 0) {
    throw OptionError(fmt::format("--start: there is no joint {}{}", Quoted(name),
                                  DidYouMean(name, NamesOfStarts(mechanism))));
  }
  const JointType type = mechanism.joints[joint].type;
  throw OptionError(
      type == JointType::kSpherical
          ? fmt::format("--start: joint {} is spherical; state where it starts in the file",
                        Quoted(name))
          : fmt::format("--start: a {} joint has {}; name the one that is meant, as in --start "
                        "{}.{}=30",
                        NameOf(type), fmt::join(NamesOfFreedoms(type), ", "), name,
                        NamesOfFreedoms(type).empty() ? "" : NameOfFreedom(type, 0)));
}

StartValue ReadStart(const Mechanism& mechanism, const Units& units, const std::string& text) {
  const size_t equals = text.find('=');
  StartValue start = FindStart(mechanism, text.substr(0, equals));
  const std::vector<double> value = equals == std::string::npos
                                        ? std::vector<double>()
                                        : Numbers("--start", text.substr(equals + 1));
  if (value.size() != 1) {
    throw OptionError(fmt::format(
        "--start: {} has no single value; give one, as in --start joint=30", Quoted(text)));
  }
  const bool rotates = FreedomsOfType(mechanism.joints[start.joint].type).rotates[start.freedom];
  start.value = value[0] * (rotates ? units.angle : units.length);
  return start;
}

/// Joints with a given start, and those with limits as far as that is possible, stay whole: a
/// limit is kept at a joint of the tree only.
KinematicTree BuildTree(Mechanism mechanism, const std::vector<StartValue>& start, bool with_limits,
                        std::vector<std::string>* warnings) {
  SpanningTreeOptions cuts;
  for (const StartValue& value : start) cuts.keep.push_back(value.joint);
  KinematicTree tree = BuildKinematicTree(mechanism, cuts);
  for (size_t j = 0; with_limits && j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    bool limited = false;
    for (double limit : joint.lower) limited |= std::isfinite(limit);
    for (double limit : joint.upper) limited |= std::isfinite(limit);
    if (!limited || tree.placements[j].tree_node >= 0) continue;
    cuts.keep.push_back(static_cast<int>(j));
    try {
      tree = BuildKinematicTree(mechanism, cuts);
    } catch (const std::invalid_argument&) {
      cuts.keep.pop_back();
      warnings->push_back(fmt::format(
          "the limits of joint '{}' are not kept: its loop has to be cut there", joint.name));
    }
  }
  return tree;
}

/// The mechanism with its loops closed, the given joints where they are to start.
Mechanism AssembledAt(Mechanism mechanism, const std::vector<StartValue>& start,
                      std::vector<std::string>* warnings) {
  AssembleOptions options;
  for (const StartValue& value : start) {
    Joint& joint = mechanism.joints[value.joint];
    joint.start[value.freedom] = value.value;
    joint.start_given = true;
    // The other freedoms of a joint with several follow, and with them, if it must be, this one.
    if (FreedomsOf(joint.type) == 1) options.fixed_joints.push_back(value.joint);
  }
  const AssembledMechanism assembled = RequireAssembled(mechanism, options);
  const std::vector<std::string> notes = assembled.Notes();
  warnings->insert(warnings->end(), notes.begin(), notes.end());
  constexpr bool kMassesDoNotMatter = true;
  const std::vector<std::string> doubts = DoubtsOf(mechanism, kMassesDoNotMatter);
  warnings->insert(warnings->end(), doubts.begin(), doubts.end());
  return assembled.mechanism;
}

Posed ReadTarget(const std::string& text, const Units& units, const Posed& X_WG_start) {
  const std::vector<double> n = Numbers("--target", text);
  if (n.size() != 3 && n.size() != 6 && n.size() != 7) {
    throw OptionError(fmt::format(
        "--target has {} numbers; give a position \"x y z\", with a rotation vector \"x y z rx ry "
        "rz\" or with a quaternion \"x y z qw qx qy qz\"",
        n.size()));
  }
  Posed X_WH{X_WG_start.R, units.length.factor * Vector3d(n[0], n[1], n[2])};
  if (n.size() == 6) {
    const Vector3d turn = units.angle.factor * Vector3d(n[3], n[4], n[5]);
    const Vector3d axis = turn.norm() > 0 ? turn.normalized() : Vector3d::UnitZ();
    X_WH.R = Eigen::AngleAxisd(turn.norm(), axis).toRotationMatrix();
  } else if (n.size() == 7) {
    const Eigen::Quaterniond quaternion(n[3], n[4], n[5], n[6]);
    constexpr double kNothing = 1e-100;  // whose square may vanish
    if (!(quaternion.norm() > kNothing)) {
      throw OptionError("--target: the quaternion is zero; (1, 0, 0, 0) is no rotation");
    }
    X_WH.R = quaternion.normalized().toRotationMatrix();
  }
  return X_WH;
}

InverseKinematicsOptions ReadOptions(const IkQuestion& question) {
  InverseKinematicsOptions options;
  if (question.paper_rotation) options.rotation_error = RotationError::kPaper;
  options.joint_limits = !question.no_limits;
  if (question.stiffness.empty()) return options;
  const std::vector<double> k = Numbers("--stiffness", question.stiffness);
  if (k.size() != 6) {
    throw OptionError(fmt::format(
        "--stiffness has {} numbers; give six, N/m along x, y, z and N m/rad about them",
        k.size()));
  }
  options.stiffness = Eigen::Map<const Vector6d>(k.data());
  try {
    options.Validate();
  } catch (const std::invalid_argument& error) {
    throw OptionError(fmt::format("--stiffness: {}", error.what()));
  }
  return options;
}

Backend ReadSolver(const std::string& name) {
  const std::optional<Backend> backend = BackendFromName(name);
  if (backend) return *backend;
  std::vector<std::string> names;
  std::string all;
  for (Backend b : kAllBackends) {
    names.emplace_back(NameOf(b));
    all += (all.empty() ? "" : ", ") + names.back();
  }
  throw OptionError(fmt::format("--solver: there is no solver {}{}; there are {}", Quoted(name),
                                DidYouMean(name, names), all));
}

/// Largest distance of a link between two poses of the mechanism.
double LinkDistance(const KinematicTree& tree, const VectorXd& a, const VectorXd& b) {
  TreeWorkspace<double> at_a(tree), at_b(tree);
  ForwardKinematics(tree, a.data(), &at_a);
  ForwardKinematics(tree, b.data(), &at_b);
  double distance = 0;
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].link < 0) continue;
    const int node = static_cast<int>(i);
    const Posed X = PoseInWorld(at_a, node, {}), Y = PoseInWorld(at_b, node, {});
    distance = std::max({distance, (X.p - Y.p).norm() / tree.length, (X.R - Y.R).norm()});
  }
  return distance;
}

/// Leads the mechanism from its start to the target and sees where it ends.
IkBranch FindBranch(const InverseKinematicsOptions& options, const IkAnswer& answer,
                    const GraspFrame& grasp, const VectorXd& q_start) {
  TrackOptions track;
  track.kinematics = options;
  HandTracker tracker(answer.tree, grasp, q_start, track);
  const Posed from = tracker.kinematics().GraspPose(q_start);
  const Eigen::Quaterniond R_from(from.R), R_to(answer.X_WH.R);
  TrackStatus status = TrackStatus::kNotRun;
  for (int k = 1; k <= 2 * kLeadingTargets; ++k) {
    const double s = std::min(1.0, static_cast<double>(k) / kLeadingTargets);
    status = tracker.Advance(
        {R_from.slerp(s, R_to).toRotationMatrix(), from.p + s * (answer.X_WH.p - from.p)});
  }
  if (status != TrackStatus::kFollowed) return IkBranch::kUnknown;
  // What neither hand nor loops see may have moved differently on the two ways.
  const VectorXd x = NearestAlongUnseen(&tracker.kinematics(), answer.summary.x, tracker.q());
  const bool same = LinkDistance(answer.tree, tracker.q(), x) < kSamePose;
  return same ? IkBranch::kSame : IkBranch::kOther;
}

/// The same pose with hinges that nothing limits less than half a turn from where they started: a
/// solver's long steps may turn them round.
void TakeBackWholeTurns(const KinematicTree& tree, const VectorXd& q_start, VectorXd* q) {
  const std::vector<Joint>& joints = tree.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type != JointType::kRevolute) continue;
    if (std::isfinite(joints[j].lower[0]) || std::isfinite(joints[j].upper[0])) continue;
    const int i = CoordinateIndex(tree, static_cast<int>(j), 0);
    if (i >= 0) (*q)[i] = q_start[i] + std::remainder((*q)[i] - q_start[i], 2 * std::numbers::pi);
  }
}

void ReportLoops(const KinematicTree& tree, InverseKinematics& problem, IkAnswer* answer) {
  const VectorXd e2 = problem.LoopError(answer->summary.x);
  const VectorXd mu = problem.LoopMultipliers(answer->summary.multipliers);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    for (int i = 0; i < loop.rows; ++i) {
      double& open = IsLengthRow(loop.type, i) ? answer->open_length : answer->open_angle;
      open = std::max(open, std::abs(e2[loop.row + i]));
    }
    answer->cut_wrenches.push_back(
        WrenchOfMultipliers(loop, problem.workspace().loops[l], mu.data() + loop.row));
  }
}

}  // namespace

IkAnswer AnswerIk(const IkQuestion& question) {
  IkAnswer answer;
  Mechanism mechanism = ReadWithSettings(question.set, [&](auto settings) {
    return ReadAs({"ik", {FileKind::kMechanism}}, question.mechanism,
                  [&](const auto& file) { return ReadMechanism(file, settings); });
  });
  if (question.target.empty()) throw OptionError("--target is required: where the hand is");
  ReadFileUnits(question.mechanism, &answer);
  const Backend backend = ReadSolver(question.solver);
  const InverseKinematicsOptions options = ReadOptions(question);
  const int grasp = GraspIndex(mechanism, question);
  answer.grasp = mechanism.grasps[grasp];
  std::vector<StartValue> start;
  for (const std::string& text : question.start) {
    start.push_back(ReadStart(mechanism, answer.units, text));
  }
  if (question.tolerance) mechanism.tolerance = *question.tolerance;
  answer.tree = BuildTree(AssembledAt(std::move(mechanism), start, &answer.warnings), start,
                          options.joint_limits, &answer.warnings);
  const VectorXd q_start = StartCoordinates(answer.tree);

  const GraspFrame frame = GraspFrameOf(answer.tree, grasp);
  InverseKinematics problem(answer.tree, frame, options);
  answer.stiffness = problem.stiffness();
  answer.X_WH = ReadTarget(question.target, answer.units, problem.GraspPose(q_start));
  problem.SetTarget(answer.X_WH);
  answer.summary = Solve(backend, problem, StoppingRule{}, q_start);
  TakeBackWholeTurns(answer.tree, q_start, &answer.summary.x);
  answer.X_WG = problem.GraspPose(answer.summary.x);
  answer.e1 = problem.HandError(answer.summary.x);
  answer.reached = std::sqrt(2 * answer.summary.objective) < kReached;
  ReportLoops(answer.tree, problem, &answer);
  answer.branch = FindBranch(options, answer, frame, q_start);
  return answer;
}

}  // namespace vmech
