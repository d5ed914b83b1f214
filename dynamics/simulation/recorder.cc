#include "vmech/dynamics/simulation/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vmech/dynamics/loads/load_peaks.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/reactions/certainty.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {
namespace {

void Append(const VectorXd& values, std::vector<double>* to) {
  to->insert(to->end(), values.begin(), values.end());
}

template <typename Values>
void Cut(size_t poses, size_t room, Values* values) {
  values->resize(values->size() / room * poses);
}

void CutTo(size_t poses, LoadArrays* arrays) {
  const size_t room = arrays->pose_count();
  const auto cut = [&](auto&... values) { (Cut(poses, room, &values), ...); };
  cut(arrays->times, arrays->drives, arrays->drive_forces, arrays->wrenches, arrays->positions,
      arrays->rates, arrays->accelerations, arrays->powers, arrays->power_errors,
      arrays->power_error_scales, arrays->smallest_pivots, arrays->closures, arrays->links);
}

double Largest(const LoadArrays::Array& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

}  // namespace

Recorder::Recorder(const PreparedSimulation& prepared, const SimulationOptions& options,
                   EquationsOfMotion* equations, SimulationResult* result)
    : prepared_(prepared), options_(options), equations_(*equations), result_(*result) {
  if (!options.loads) return;
  const Mechanism& mechanism = prepared.model.tree.mechanism;
  LoadArrays::Shape shape;
  shape.poses = prepared.simulation.times.size() + 1;
  shape.drives = prepared.simulation.drives.size();
  shape.freedoms = FreedomsOfJoints(mechanism);
  shape.links = options.link_motions ? mechanism.links.size() : 0;
  arrays_ = std::make_shared<LoadArrays>(shape);
  arrays_->times.resize(shape.poses);
  arrays_->drives.resize(shape.poses * shape.drives);
}

void Recorder::Record(double time, double* y) {
  const KinematicTree& tree = equations_.tree();
  double* const v = y + tree.nq;
  const double closure = equations_.Close(time, y);
  equations_.forces().Remember(equations_.motion());
  equations_.Evaluate(time, y, v);
  equations_.forces().FindJoints(&equations_.motion());
  const VectorXd& rates = equations_.motion().ws().v;
  std::copy(rates.begin(), rates.end(), v);
  result_.statistics.largest_closure = std::max(result_.statistics.largest_closure, closure);
  Enter(time, y);
}

void Recorder::Enter(double time, const double* y) {
  const LoadWorkspace<double>& ws = equations_.motion().ws();
  result_.times.push_back(time);
  Append(ws.q, &result_.q);
  Append(ws.v, &result_.v);
  Append(ws.vdot, &result_.vdot);
  if (prepared_.simulation.hand) result_.hand.push_back(equations_.forces().hand());
  for (size_t i = 0; i < prepared_.simulation.motors.size(); ++i) {
    result_.motor_forces.push_back(equations_.forces().MotorForce(i));
  }
  RecordEnergies(y);
  if (options_.loads) RecordLoads(time);
}

void Recorder::RecordEnergies(const double* y) {
  const double* const energies = y + equations_.tree().nq + equations_.tree().nv;
  EnergySample sample;
  sample.kinetic = equations_.KineticEnergyHere();
  sample.weight = equations_.WeightEnergyHere();
  sample.springs = equations_.forces().SpringEnergy(equations_.motion());
  sample.supplied = energies[0];
  sample.dissipated = energies[1];
  if (result_.energies.empty()) first_energy_ = sample.Total();
  sample.error = sample.Total() - first_energy_ - sample.supplied + sample.dissipated;
  result_.energies.push_back(sample);
}

void Recorder::RecordLoads(double time) {
  const size_t pose = result_.times.size() - 1;
  LoadWorkspace<double>& ws = equations_.motion().ws();
  const Motion motion = equations_.forces().PoseOf(time, equations_.motion());
  arrays_->times[pose] = time;
  for (size_t k = 0; k < arrays_->drive_count; ++k) {
    arrays_->drives[pose * arrays_->drive_count + k] = equations_.DriveAt(k, time);
  }
  const std::vector<Vector3d> beside = equations_.BesideSprings();
  ws.exerted = beside.data();
  for (Vector3d& sliding : ws.sliding) sliding.setZero();
  if (EvaluatePoseLoads(equations_.model(), motion, 0, &ws)) {
    StorePoseLoads(equations_.model(), motion, pose, ws, arrays_.get());
  } else {
    LeaveOut(pose);
  }
  ws.exerted = nullptr;
}

/// At a dead centre of what moves nothing can be said of the wrenches.
void Recorder::LeaveOut(size_t pose) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto leave_out = [&](LoadArrays::Array& values) {
    const auto count = static_cast<ptrdiff_t>(values.size() / arrays_->pose_count());
    const auto first = values.begin() + static_cast<ptrdiff_t>(pose) * count;
    std::fill(first, first + count, none);
  };
  for (LoadArrays::Array* values : {&arrays_->wrenches, &arrays_->drive_forces, &arrays_->positions,
                                    &arrays_->rates, &arrays_->accelerations, &arrays_->powers}) {
    leave_out(*values);
  }
  arrays_->power_errors[pose] = arrays_->power_error_scales[pose] = 0;
  arrays_->smallest_pivots[pose] = arrays_->closures[pose] = 0;
  result_.loads.singular_poses.push_back(pose);
  result_.warnings.push_back(
      fmt::format("at t = {:.6g} s the loops are singular: the joints' wrenches are not determined "
                  "there and are left out",
                  arrays_->times[pose]));
}

void Recorder::JudgeLoads() {
  constexpr size_t kJudged = 13;
  LoadStudyResult& loads = result_.loads;
  const KinematicTree& tree = equations_.tree();
  const std::vector<int> driven = DrivenVelocities(prepared_.simulation, tree);
  const size_t count = std::min(result_.size(), kJudged);
  for (size_t i = 0; i < count; ++i) {
    const VectorXd q = result_.Q(i * result_.size() / count);
    const auto here = JudgeCertainty(tree, ChooseFreedoms(tree, q, driven, kRankTolerance), q,
                                     prepared_.model.rounding);
    if (loads.certainty.empty()) loads.certainty = here;
    for (size_t j = 0; j < here.size(); ++j) {
      for (int k = 0; k < 6; ++k) {
        Certainty& verdict = loads.certainty[j][k];
        if (here[j][k] == Certainty::kNotDetermined || verdict == Certainty::kSingular) {
          verdict = here[j][k];
        }
      }
    }
  }
  loads.drive_certainty.assign(prepared_.simulation.drives.size(), Certainty::kCertain);
  if (FrictionFollowsTheRule()) {
    DoubtAll(
        "dry friction goes with loads that statics does not determine, and so does the motion");
  } else if (HeldMoreThanOnce()) {
    DoubtAll(
        "several contacts of a loop stick or stand at limits at once, and share what holds it");
  }
  loads.open = FindOpenComponents(loads, FindPeaks(loads.poses.arrays()), nullptr, tree.length);
}

/// Friction moves the mechanism: where it goes with a load that the rule settles, all else does.
bool Recorder::FrictionFollowsTheRule() const {
  const std::vector<Joint>& joints = equations_.tree().mechanism.joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].load_friction.coefficient == 0) continue;
    for (const Certainty verdict : result_.loads.certainty[j]) {
      if (verdict == Certainty::kNotDetermined) return true;
    }
  }
  return false;
}

/// Does a mechanism with loops ever have two or more freedoms that contacts hold? They may be of
/// one loop, and nothing tells then how much each of them exerts.
bool Recorder::HeldMoreThanOnce() const {
  const KinematicTree& tree = equations_.tree();
  if (tree.loops.empty()) return false;
  int held = 0;
  for (const SimulationEvent& event : result_.events) {
    using Kind = SimulationEvent::Kind;
    const auto freedoms = [&] { return FreedomsOf(tree.mechanism.joints[event.at.joint].type); };
    if (event.kind == Kind::kSticks) held += freedoms();
    if (event.kind == Kind::kSlips) held -= freedoms();
    if (event.kind == Kind::kLimitCloses) ++held;
    if (event.kind == Kind::kLimitOpens) --held;
    if (held > 1) return true;
  }
  return false;
}

void Recorder::DoubtAll(const std::string& why) {
  LoadStudyResult& loads = result_.loads;
  for (JointCertainty& verdicts : loads.certainty) {
    for (Certainty& verdict : verdicts) {
      if (verdict == Certainty::kCertain) verdict = Certainty::kNotDetermined;
    }
  }
  for (Certainty& verdict : loads.drive_certainty) verdict = Certainty::kNotDetermined;
  result_.warnings.push_back(fmt::format("no load is certain: {}; the figures follow the rule '{}'",
                                         why, NameOf(prepared_.simulation.rule)));
}

void Recorder::Finish() {
  if (!options_.loads || result_.times.empty()) return;
  LoadStudyResult& loads = result_.loads;
  CutTo(result_.size(), arrays_.get());
  loads.mobility = prepared_.mobility.mobility;
  loads.redundant_equations = prepared_.mobility.redundant;
  const Mechanism& mechanism = prepared_.model.tree.mechanism;
  for (const Loop& loop : prepared_.model.tree.loops) {
    loads.cut_joints.push_back(mechanism.joints[loop.joint].name);
  }
  const double length = prepared_.simulation.norm_length;
  loads.norm_length = length > 0 ? length : prepared_.model.tree.length;
  const double largest = Largest(arrays_->power_error_scales);
  for (double& error : arrays_->power_errors) error = largest > 0 ? error / largest : 0;
  loads.max_closure = Largest(arrays_->closures);
  loads.max_power_error = Largest(arrays_->power_errors);
  loads.poses = PoseSeries(arrays_);
  JudgeLoads();
}

}  // namespace vmech
