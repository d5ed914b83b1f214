#include "vmech/dynamics/simulation/equations_of_motion.h"

#include <algorithm>
#include <cmath>

#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

/// Pivots are squares of sines. How loops bend is known to rounding over a pivot: nothing is left
/// of it below the first. Below the second an opening of loops, which counts for more by the
/// inverse root, is closed before anything else.
constexpr double kSingular = 1e-10;
constexpr double kNearlySingular = 1e-2;
/// Dimensionless pivots at a singular pose that count as zero.
constexpr double kSingularRank = 1e-4;
/// A choice of freedoms is bad at this share of its best pivot.
constexpr double kWorn = 1e-2;

LoadModel WithPartition(LoadModel model, const CoordinatePartition& partition) {
  model.partition = partition;
  model.drives.resize(partition.driven.size());
  return model;
}

}  // namespace

EquationsOfMotion::Choice::Choice(const PreparedSimulation& prepared,
                                  const CoordinatePartition& partition)
    : model(WithPartition(prepared.model, partition)),
      forces(prepared.simulation, &model),
      motion(model) {}

EquationsOfMotion::EquationsOfMotion(const PreparedSimulation& prepared)
    : prepared_(prepared),
      tree_(prepared.model.tree),
      driven_(DrivenVelocities(prepared.simulation, tree_)),
      regular_(std::make_unique<Choice>(prepared, prepared.model.partition)),
      now_(regular_.get()),
      held_rates_(driven_.size()),
      held_slopes_(driven_.size()) {
  std::vector<RateRow> rows;
  for (const int v : driven_) rows.push_back({v, -1, 0});
  regular_->motion.Hold(rows);
  regular_->motion.SetPose(prepared.mobility.q_general.data());
  regular_->best_pivot = regular_->motion.smallest_pivot();
}

std::unique_ptr<EquationsOfMotion::Choice> EquationsOfMotion::MakeChoice(const VectorXd& q,
                                                                         double tolerance) const {
  auto choice =
      std::make_unique<Choice>(prepared_, vmech::ChooseFreedoms(tree_, q, driven_, tolerance));
  choice->motion.Hold(now_->motion.held());
  choice->motion.SetPose(q.data());
  choice->best_pivot = choice->motion.smallest_pivot();
  return choice;
}

bool EquationsOfMotion::ChooseFreedoms(const VectorXd& q) {
  std::unique_ptr<Choice> better = MakeChoice(q, kRankTolerance);
  const bool same_rank =
      better->model.partition.driven.size() == regular_->model.partition.driven.size();
  regular_->motion.SetPose(q.data());
  const double here = regular_->motion.smallest_pivot();
  if (!same_rank || better->best_pivot <= here) {
    regular_->best_pivot = here;  // as good as any
    return false;
  }
  better->forces.ContinueFrom(regular_->forces);
  regular_ = std::move(better);
  now_ = regular_.get();
  ++partitions;
  return true;
}

bool EquationsOfMotion::ChoosesBadly() const {
  return regular_->motion.smallest_pivot() < kWorn * regular_->best_pivot;
}

void EquationsOfMotion::FindDriveMotion(double time) {
  for (size_t k = 0; k < driven_.size(); ++k) {
    const MotionSample sample = prepared_.simulation.drives[k].law.At(time);
    held_rates_[k] = sample.velocity;
    held_slopes_[k] = sample.acceleration;
  }
}

void EquationsOfMotion::SetPose(const double* q) {
  now_ = regular_.get();
  now_->motion.SetPose(q);
  if (tree_.loops.empty()) return;
  CloseIfNearlySingular();
  if (now_->motion.smallest_pivot() >= kSingular) return;
  // More motions are free at this pose: what loops do not decide, inertia does.
  ++singular_poses;
  singular_ = MakeChoice(now_->motion.ws().q, kSingularRank);
  singular_->forces.ContinueFrom(regular_->forces);
  now_ = singular_.get();
}

void EquationsOfMotion::CloseIfNearlySingular() {
  constexpr double kClosed = 1e-15;
  const double pivot = now_->motion.smallest_pivot();
  if (pivot >= kNearlySingular || pivot < kSingular) return;
  const VectorXd& q = now_->motion.ws().q;
  closed_.assign(q.begin(), q.end());
  now_->motion.Close(kClosed, closed_.data());
}

void EquationsOfMotion::Place(double time, const double* q, const double* v) {
  SetPose(q);
  from_singular_ = now_ == singular_.get();
  FindDriveMotion(time);
  now_->motion.SetVelocities(v, held_rates_.data());
}

void EquationsOfMotion::Evaluate(double time, const double* q, const double* v) {
  ++evaluations;
  SetPose(q);
  FindDriveMotion(time);
  now_->motion.SetVelocities(v, held_rates_.data());
  now_->forces.Evaluate(time, &now_->motion);
  now_->motion.Accelerate(now_->motion.ws().passive, held_slopes_.data());
}

bool EquationsOfMotion::Slopes(double time, const double* y, double* slopes) {
  const double* const v = y + tree_.nq;
  Evaluate(time, y, v);
  if (now_ == singular_.get() && !from_singular_) return false;
  const LoadWorkspace<double>& ws = now_->motion.ws();
  CoordinateRates(tree_, ws.q.data(), ws.v.data(), slopes);
  std::copy(ws.vdot.data(), ws.vdot.data() + tree_.nv, slopes + tree_.nq);
  double* const powers = slopes + tree_.nq + tree_.nv;
  powers[0] = now_->forces.SuppliedPower(now_->motion);
  for (size_t k = 0; k < driven_.size(); ++k) {
    powers[0] += now_->motion.held_forces()[static_cast<Eigen::Index>(k)] * held_rates_[k];
  }
  powers[1] = now_->forces.LostPower(now_->motion);
  return std::all_of(slopes, slopes + size(), [](double slope) { return std::isfinite(slope); });
}

double EquationsOfMotion::Close(double time, double* q) {
  constexpr double kClosed = 1e-14;
  for (size_t k = 0; k < driven_.size(); ++k) {
    const JointDrive& drive = prepared_.simulation.drives[k];
    q[CoordinateIndex(tree_, drive.joint, drive.freedom)] = drive.law.At(time).position;
  }
  SetPose(q);
  return now_->motion.Close(std::max(kClosed, 0.1 * prepared_.closure_tolerance), q);
}

double EquationsOfMotion::KineticEnergyHere() const {
  const LoadWorkspace<double>& ws = now_->motion.ws();
  return KineticEnergy(tree_, ws.inertias, ws.tree);
}

double EquationsOfMotion::WeightEnergyHere() const {
  return WeightEnergy(tree_, now_->motion.ws().inertias);
}

double EquationsOfMotion::Energy() const {
  return KineticEnergyHere() + WeightEnergyHere() + now_->forces.SpringEnergy(now_->motion);
}

}  // namespace vmech
