#include "vmech/dynamics/simulation/motion_loads.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"
#include "vmech/dynamics/simulation/recorder.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {
namespace {

/// A unit quaternion (w, x, y, z) of a rotation vector.
Eigen::Vector4d QuaternionOf(const Vector3d& rotation) {
  const double angle = rotation.norm();
  const Vector3d axis = angle > 0 ? Vector3d(rotation / angle) : Vector3d::UnitX();
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
  return {q.w(), q.x(), q.y(), q.z()};
}

/// Is a velocity of the tree that of a translation?
bool IsShift(const KinematicTree& tree, int v) {
  return std::any_of(tree.nodes.begin(), tree.nodes.end(), [v](const TreeNode& node) {
    return node.v == v && node.motion == NodeMotion::kPrismatic;
  });
}

/// The rows of a history, by joint.
class Rows {
 public:
  Rows(const Mechanism& mechanism, const JointHistory& history) : history_(history) {
    first_.push_back(0);
    for (const Joint& joint : mechanism.joints) {
      first_.push_back(first_.back() + static_cast<size_t>(FreedomsOf(joint.type)));
    }
    const size_t rows = history.times.size(), numbers = rows * first_.back();
    if (rows > 0 && history.positions.size() == numbers && history.rates.size() == numbers &&
        history.accelerations.size() == numbers) {
      return;
    }
    throw std::invalid_argument(
        fmt::format("the motion must have a position, a rate and an acceleration for each of {} "
                    "freedoms at each of its times",
                    first_.back()));
  }

  size_t size() const { return history_.times.size(); }
  Vector3d Position(size_t row, int joint) const { return Of(history_.positions, row, joint); }
  Vector3d Rate(size_t row, int joint) const { return Of(history_.rates, row, joint); }
  Vector3d Acceleration(size_t row, int joint) const {
    return Of(history_.accelerations, row, joint);
  }

 private:
  Vector3d Of(const std::vector<double>& values, size_t row, int joint) const {
    const size_t begin = first_[static_cast<size_t>(joint)];
    const size_t end = first_[static_cast<size_t>(joint) + 1];
    const double* const from = values.data() + row * first_.back();
    Vector3d result = Vector3d::Zero();
    std::copy(from + begin, from + end, result.data());
    return result;
  }

  const JointHistory& history_;
  std::vector<size_t> first_;  ///< [joints + 1]
};

/// The simulation at the first pose of a motion.
Simulation AtFirstRow(Simulation simulation, const JointHistory& history, const Rows& rows) {
  simulation.times = history.times;
  simulation.start = SimulationStart::kAsDrawn;
  simulation.start_rates.clear();
  std::vector<Joint>& joints = simulation.mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    const Vector3d position = rows.Position(0, static_cast<int>(j));
    if (joints[j].type == JointType::kSpherical) {
      const Eigen::Vector4d q = QuaternionOf(position);
      joints[j].start.assign(q.begin(), q.end());
    } else {
      joints[j].start.assign(position.begin(), position.begin() + FreedomsOf(joints[j].type));
    }
    joints[j].start_given = true;
  }
  for (JointDrive& drive : simulation.drives) {
    drive.law = MotionLaw::Uniform(rows.Position(0, drive.joint)[drive.freedom], 0);
  }
  return simulation;
}

/// Goes through a motion row by row.
class Passage {
 public:
  Passage(const PreparedSimulation& prepared, const Rows& rows, SimulationResult* result)
      : prepared_(prepared),
        rows_(rows),
        result_(*result),
        equations_(prepared),
        recorder_(prepared, options_, &equations_, result),
        y_(VectorXd::Zero(equations_.size())),
        vdot_(VectorXd::Zero(equations_.tree().nv)) {}

  bool Go(const std::function<bool(size_t done)>& progress) {
    for (size_t row = 0; row < rows_.size(); ++row) {
      Pass(row);
      if (progress && !progress(row + 1)) return false;
    }
    recorder_.Finish();
    RequireBalance();
    return true;
  }

 private:
  double* q() { return y_.data(); }
  double* v() { return y_.data() + equations_.tree().nq; }

  void Pass(size_t row) {
    const double time = prepared_.simulation.times[row];
    Take(row);
    equations_.Place(time, q(), v());
    RequireClosed(time);
    FindContacts(time);
    equations_.Evaluate(time, q(), v());
    equations_.forces().FindJoints(&equations_.motion());
    equations_.motion().ws().vdot = vdot_;
    recorder_.Enter(time, y_.data());
    WeighRest(time);
    if (equations_.ChoosesBadly()) {
      equations_.ChooseFreedoms(Eigen::Map<VectorXd>(q(), equations_.tree().nq));
    }
  }

  void Take(size_t row) {
    const KinematicTree& tree = equations_.tree();
    for (const TreeNode& node : tree.nodes) {
      if (node.motion == NodeMotion::kFixed) continue;
      const Vector3d position = rows_.Position(row, node.joint);
      if (node.motion == NodeMotion::kSpherical) {
        Eigen::Map<Eigen::Vector4d>(q() + node.q) = QuaternionOf(position);
      } else {
        q()[node.q] = position[node.freedom];
      }
      for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
        v()[node.v + k] = rows_.Rate(row, node.joint)[node.freedom + k];
        vdot_[node.v + k] = rows_.Acceleration(row, node.joint)[node.freedom + k];
      }
    }
    std::vector<MotionSample> drives;
    for (const JointDrive& drive : prepared_.simulation.drives) {
      drives.push_back({rows_.Position(row, drive.joint)[drive.freedom],
                        rows_.Rate(row, drive.joint)[drive.freedom],
                        rows_.Acceleration(row, drive.joint)[drive.freedom]});
    }
    equations_.MoveDrives(std::move(drives));
    std::vector<Vector3d> cut;
    for (const Loop& loop : tree.loops) cut.push_back(rows_.Position(row, loop.joint));
    equations_.ContinueCutJoints(std::move(cut));
  }

  /// From the state alone, as all else.
  void FindContacts(double time) {
    Contacts& contacts = equations_.contacts();
    if (contacts.empty()) return;
    const Contacts before = contacts;
    contacts.OpenLimits();
    equations_.FindContacts(time, q(), v());
    before.Compare(contacts, time, equations_.motion(), &result_.events);
  }

  void RequireClosed(double time) {
    constexpr double kOpen = 1e-7;
    const double closure = equations_.motion().closure();
    if (closure <= std::max(kOpen, prepared_.closure_tolerance)) return;
    throw std::invalid_argument(fmt::format(
        "the motion is not one of this mechanism: at t = {:.9g} s its loops are open by {:.3g}, "
        "of a radian or of the mechanism's length",
        time, closure));
  }

  /// What is left along freedoms at which nothing exerts a force, beside the largest load.
  void WeighRest(double time) {
    const KinematicTree& tree = equations_.tree();
    const LoadWorkspace<double>& ws = equations_.motion().ws();
    const bool left_out = !result_.loads.singular_poses.empty() &&
                          result_.loads.singular_poses.back() + 1 == result_.size();
    if (left_out) return;
    for (const JointLoad<double>& joint : ws.loads) {
      largest_load_ =
          std::max(largest_load_, tree.length * joint.W_F.force.norm() + joint.W_F.moment.norm());
    }
    const std::vector<int>& independent = equations_.model().partition.driven;
    for (auto k = static_cast<size_t>(equations_.drives()); k < independent.size(); ++k) {
      const bool rotates = !IsShift(tree, independent[k]);
      const double moment = ws.drive_forces[k] * (rotates ? 1 : tree.length);
      if (std::abs(moment) <= std::abs(rest_.moment)) continue;
      rest_ = {time, ws.drive_forces[k], moment, rotates, NameOfVelocity(tree, independent[k])};
    }
  }

  void RequireBalance() const {
    constexpr double kBalanced = 1e-6;
    if (std::abs(rest_.moment) <= kBalanced * largest_load_) return;
    throw std::invalid_argument(fmt::format(
        "what the study names does not give this motion: at t = {:.9g} s {:.6g} {} are missing "
        "along {}; name what exerts them, as when the motion was made, or a drive there",
        rest_.time, rest_.force, rest_.rotates ? "N m" : "N", rest_.freedom));
  }

  struct Rest {
    double time = 0, force = 0, moment = 0;
    bool rotates = false;
    std::string freedom;
  };

  const PreparedSimulation& prepared_;
  const Rows& rows_;
  SimulationResult& result_;
  SimulationOptions options_;
  EquationsOfMotion equations_;
  Recorder recorder_;
  VectorXd y_, vdot_;
  Rest rest_;
  double largest_load_ = 0;
};

}  // namespace

LoadStudyResult EvaluateMotionLoads(const Simulation& simulation, const JointHistory& history,
                                    const std::function<bool(size_t done)>& progress) {
  const Rows rows(simulation.mechanism, history);
  const PreparedSimulation prepared = PrepareSimulation(AtFirstRow(simulation, history, rows));
  SimulationResult result;
  result.tree = prepared.model.tree;
  if (!Passage(prepared, rows, &result).Go(progress)) {
    throw std::runtime_error("the loads of the motion were stopped before its end");
  }
  LoadStudyResult loads = std::move(result.loads);
  loads.warnings.insert(loads.warnings.end(), result.warnings.begin(), result.warnings.end());
  return loads;
}

}  // namespace vmech
