#include "vmech/kinematics/loops/assembled_mechanism.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/loop_walk.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

constexpr double kExactFigures = 1e-13;
constexpr double kReconciled = 1e-12;  // to which reconciled loops close at least
constexpr double kSilent = 1e-9;       // of rounded figures [characteristic lengths, rad]
constexpr double kMovedStart = 1e-6;   // that is worth a word [m, rad]
constexpr double kNearlyClosed = 1e-3;

bool StatesStart(const Joint& joint) {
  return joint.start_given || joint.start != ZeroCoordinates(joint.type);
}

/// Cut where no start is stated, and not where a file may want it: what is assembled does not
/// depend on the cuts that are computed with.
KinematicTree TreeForAssembly(Mechanism mechanism, const AssembleOptions& options) {
  SpanningTreeOptions cuts;
  cuts.keep = options.fixed_joints;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    if (StatesStart(mechanism.joints[j])) cuts.prefer.push_back(static_cast<int>(j));
  }
  mechanism.preferred_cuts.clear();
  return BuildKinematicTree(std::move(mechanism), cuts);
}

AssemblyOptions ClosingOptions(const KinematicTree& tree, const AssembleOptions& options) {
  AssemblyOptions closing = options.closing;
  for (const int joint : options.fixed_joints) {
    for (int k = 0; k < FreedomsOf(tree.mechanism.joints[joint].type); ++k) {
      closing.fixed.push_back(VelocityIndex(tree, joint, k));
    }
  }
  return closing;
}

void SetTreeStarts(const KinematicTree& tree, const VectorXd& q, Mechanism* mechanism) {
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    std::vector<double>& start = mechanism->joints[node.joint].start;
    const int count = node.motion == NodeMotion::kSpherical ? 4 : 1;
    for (int i = 0; i < count; ++i) start[node.freedom + i] = q[node.q + i];
  }
}

/// An angle in the turn that is nearest to what is stated, or else in one within the limits.
double InTurnOf(const Joint& joint, int freedom, double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double near = angle + kTurn * std::round((joint.start[freedom] - angle) / kTurn);
  const double lower = joint.lower[freedom], upper = joint.upper[freedom];
  if (near >= lower && near <= upper) return near;
  const double raised = near + kTurn * std::ceil((lower - near) / kTurn);
  return std::isfinite(lower) && raised <= upper ? raised : near;
}

/// Cut joints stand where their anchors do.
void SetCutStarts(const KinematicTree& tree, const VectorXd& q, Mechanism* mechanism) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  LoopErrors(tree, &ws);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    Joint& joint = mechanism->joints[tree.loops[l].joint];
    const Vector3d values = CutJointCoordinates(tree.loops[l], ws.loops[l]);
    if (joint.type == JointType::kSpherical) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(values.norm(), values.stableNormalized()));
      joint.start = {turn.w(), turn.x(), turn.y(), turn.z()};
      continue;
    }
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      const bool turns = FreedomsOfType(joint.type).rotates[k] && joint.type != JointType::kScrew;
      joint.start[k] = turns ? InTurnOf(joint, k, values[k]) : values[k];
    }
  }
}

/// Turn between two unit quaternions w, x, y, z.
double TurnBetween(const std::vector<double>& a, const std::vector<double>& b) {
  const Eigen::Quaterniond qa(a[0], a[1], a[2], a[3]), qb(b[0], b[1], b[2], b[3]);
  return qa.angularDistance(qb);
}

/// Of the stated starts, or of all.
std::vector<MovedStart> FindMovedStarts(const Mechanism& stated, const Mechanism& assembled,
                                        bool all) {
  std::vector<MovedStart> moved;
  for (size_t j = 0; j < stated.joints.size(); ++j) {
    const Joint &before = stated.joints[j], &after = assembled.joints[j];
    if (!all && !StatesStart(before)) continue;
    if (before.type == JointType::kSpherical) {
      moved.push_back({static_cast<int>(j), 0, 0, TurnBetween(before.start, after.start)});
      continue;
    }
    for (int k = 0; k < FreedomsOf(before.type); ++k) {
      moved.push_back({static_cast<int>(j), k, before.start[k], after.start[k]});
    }
  }
  const auto way = [](const MovedStart& m) { return std::abs(m.to - m.from); };
  std::erase_if(moved, [&](const MovedStart& m) { return way(m) <= kMovedStart; });
  std::stable_sort(moved.begin(), moved.end(),
                   [&](const MovedStart& a, const MovedStart& b) { return way(a) > way(b); });
  return moved;
}

std::string BeyondTolerance(const Mechanism& m, const Reconciliation& found,
                            const std::vector<AxisMisfit>& misfits) {
  return fmt::format(
      "the loops close only if anchors are moved by {:.2g} (root mean square, in rad and in parts "
      "of the mechanism's length), most at joint '{}': {}. More than the tolerance of {:.2g} is "
      "not taken for rounding: correct the figures, or allow it by `tolerance` in the mechanism "
      "file or --tolerance",
      found.correction, m.joints[found.joint].name, DescribeMisfits(m, misfits), m.tolerance);
}

/// Where closing leads that stops before it would follow rounded figures along the motion.
VectorXd NearlyClosed(const KinematicTree& tree, AssemblyOptions closing) {
  VectorXd q = StartCoordinates(tree);
  closing.tolerance = kNearlyClosed;
  Assemble(tree, closing, &q);
  return q;
}

/// A mechanism at work.
class Assembler {
 public:
  Assembler(const Mechanism& mechanism, const AssembleOptions& options)
      : options_(options),
        tree_(TreeForAssembly(mechanism, options)),
        closing_(ClosingOptions(tree_, options)),
        q_(StartCoordinates(tree_)) {
    result_.mechanism = mechanism;
  }

  AssembledMechanism Run() {
    result_.summary = Assemble(tree_, closing_, &q_);
    if (!result_.summary.closed || !EveryLoopMoves(tree_, q_)) TakeRounding();
    if (!result_.summary.closed) return result_;
    const Mechanism stated = result_.mechanism;
    const bool as_stated =
        result_.correction == 0 && result_.summary.start_error <= closing_.tolerance;
    if (!as_stated) SetTreeStarts(tree_, q_, &result_.mechanism);
    SetCutStarts(tree_, q_, &result_.mechanism);
    result_.moved_starts = FindMovedStarts(stated, result_.mechanism, result_.summary.starts > 1);
    return result_;
  }

 private:
  /// Loops that do not close, or do not move, for the rounding of their figures.
  void TakeRounding() {
    const Mechanism& drawn = tree_.mechanism;
    const Reconciliation found = Reconcile(tree_, NearlyClosed(tree_, closing_));
    if (!found.closes || (result_.summary.closed && found.correction < kExactFigures)) return;
    std::vector<AxisMisfit> misfits = FindAxisMisfits(drawn, found.mechanism);
    if (found.correction > drawn.tolerance) {
      if (!result_.summary.closed) {
        result_.summary.message = BeyondTolerance(drawn, found, misfits);
      }
      return;
    }
    const KinematicTree tree = TreeForAssembly(found.mechanism, options_);
    VectorXd q = found.q;
    const VectorXd stated = StartCoordinates(tree_);
    for (const int joint : options_.fixed_joints) {
      for (int k = 0; k < FreedomsOf(drawn.joints[joint].type); ++k) {
        const int i = CoordinateIndex(tree, joint, k);
        if (i >= 0) q[i] = stated[i];
      }
    }
    AssemblyOptions closing = closing_;
    closing.tolerance = std::max({closing.tolerance, kReconciled, 10 * found.misfit});
    AssemblySummary summary = Assemble(tree, closing, &q);
    if (!summary.closed) return;
    summary.start_error = result_.summary.start_error;
    summary.iterations += result_.summary.iterations;
    result_.summary = summary;
    result_.correction = found.correction;
    result_.closure_tolerance = closing.tolerance;
    result_.misfits = std::move(misfits);
    result_.mechanism.links = found.mechanism.links;
    tree_ = tree;
    q_ = q;
  }

  AssembleOptions options_;
  KinematicTree tree_;
  AssemblyOptions closing_;
  VectorXd q_;
  AssembledMechanism result_;
};

std::string MovedStartText(const Mechanism& m, const MovedStart& moved) {
  const Joint& joint = m.joints[moved.joint];
  if (joint.type == JointType::kSpherical) {
    return fmt::format("'{}' turned by {:.6g} {}", joint.name, moved.to / m.units.radians,
                       m.units.angle);
  }
  return fmt::format("'{}' from {} to {}", NameOfFreedom(joint, moved.freedom),
                     FormatCoordinate(m.units, joint, moved.freedom, moved.from),
                     FormatCoordinate(m.units, joint, moved.freedom, moved.to));
}

}  // namespace

void SetStarts(const KinematicTree& tree, const VectorXd& q, Mechanism* mechanism) {
  SetTreeStarts(tree, q, mechanism);
  SetCutStarts(tree, q, mechanism);
}

std::vector<double> StartOfFreedoms(const Mechanism& mechanism) {
  std::vector<double> all;
  for (const Joint& joint : mechanism.joints) {
    const std::vector<double>& start = joint.start;
    if (joint.type != JointType::kSpherical) {
      all.insert(all.end(), start.begin(), start.end());
      continue;
    }
    const Eigen::AngleAxisd turn(Eigen::Quaterniond(start[0], start[1], start[2], start[3]));
    const Vector3d vector = turn.angle() * turn.axis();
    all.insert(all.end(), vector.begin(), vector.end());
  }
  return all;
}

std::vector<std::string> AssembledMechanism::Notes() const {
  std::vector<std::string> notes;
  if (summary.closed && summary.starts > 1) {
    notes.push_back(fmt::format(
        "the start values lead to no assembled pose (singular, or too far off); of {} other starts "
        "the nearest pose is taken; give start values to choose another",
        summary.starts - 1));
  }
  if (!moved_starts.empty()) {
    std::string text;
    for (const MovedStart& moved : moved_starts) {
      text += (text.empty() ? "" : ", ") + MovedStartText(mechanism, moved);
    }
    notes.push_back("to close the loops the assembly moved " + text);
  }
  if (correction > kSilent) {
    notes.push_back(fmt::format(
        "the loops close but for the rounding of their figures: {}; anchors are moved by {:.2g} "
        "(root mean square, in rad and in parts of the mechanism's length)",
        DescribeMisfits(mechanism, misfits), correction));
  }
  for (const std::string& text : StartsOutsideLimits(mechanism)) notes.push_back(text);
  return notes;
}

std::vector<std::string> StartsOutsideLimits(const Mechanism& mechanism) {
  constexpr double kOnLimit = 1e-9;  // [m, rad]
  std::vector<std::string> outside;
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kSpherical) continue;
    for (size_t k = 0; k < joint.start.size(); ++k) {
      const double start = joint.start[k], lower = joint.lower[k], upper = joint.upper[k];
      if (start >= lower - kOnLimit && start <= upper + kOnLimit) continue;
      const auto text = [&](double value) {
        return FormatCoordinate(mechanism.units, joint, static_cast<int>(k), value);
      };
      outside.push_back(fmt::format("joint '{}' starts at {}, outside its limits {} to {}",
                                    NameOfFreedom(joint, static_cast<int>(k)), text(start),
                                    text(lower), text(upper)));
    }
  }
  return outside;
}

AssembledMechanism AssembleMechanism(const Mechanism& mechanism, const AssembleOptions& options) {
  RequireValid(mechanism);
  for (int joint : options.fixed_joints) {
    RequireIndex("AssembleOptions.fixed_joints", joint, mechanism.joints.size());
  }
  return Assembler(mechanism, options).Run();
}

AssembledMechanism RequireAssembled(const Mechanism& mechanism, const AssembleOptions& options) {
  AssembledMechanism assembled = AssembleMechanism(mechanism, options);
  if (!assembled.summary.closed) throw std::runtime_error(assembled.summary.message);
  return assembled;
}

}  // namespace vmech
