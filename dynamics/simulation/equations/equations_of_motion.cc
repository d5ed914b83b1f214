#include "vmech/dynamics/simulation/equations/equations_of_motion.h"

#include <algorithm>
#include <cmath>

#include "vmech/dynamics/loads/pose/passive_loads.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

/// Pivots are squares of sines. How loops bend is known to rounding over a pivot: nothing is left
/// of it below the first. Below the second an opening of loops, which counts for more by the
/// inverse root, is closed before anything else.
constexpr double kSingular = 1e-8;
constexpr double kNearlySingular = 1e-2;
/// As near as the few evaluations of a leap may come.
constexpr double kNearest = 1e-9;
/// Dimensionless pivots at a singular pose that count as zero.
constexpr double kSingularRank = 1e-4;
/// A choice of freedoms is bad at this share of its best pivot; and, near poses at which loops lose
/// rank, at the other one: there it must not be the choice that ends what can be evaluated.
constexpr double kWorn = 1e-2, kWornNearSingular = 0.5;
constexpr double kNearSingular = 1e-4;

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
      contacts_(prepared.simulation, tree_),
      under_load_(HasLoadFriction(tree_.mechanism)),
      regular_(std::make_unique<Choice>(prepared, prepared.model.partition)),
      now_(regular_.get()) {
  HoldContacts();
  regular_->motion.SetPose(prepared.mobility.q_general.data());
  regular_->motion.MeasureColumns();
  regular_->best_pivot = regular_->motion.smallest_pivot();
}

std::vector<RateRow> EquationsOfMotion::HeldRows() const {
  std::vector<RateRow> rows;
  for (const int v : driven_) rows.push_back({v, -1, 0});
  for (const RateRow& row : contacts_.Held()) rows.push_back(row);
  return rows;
}

void EquationsOfMotion::HoldContacts() {
  regular_->motion.Hold(HeldRows());
  held_rates_.assign(regular_->motion.held().size(), 0.0);
  held_slopes_ = held_rates_;
}

bool EquationsOfMotion::IsSingular() const {
  return regular_->motion.smallest_pivot() < kSingular;
}

void EquationsOfMotion::FindContacts(double time, const double* q, double* v) {
  contacts_.HoldAllAtRest(now_->motion);
  do {
    HoldContacts();
    Place(time, q, v);
    KeepHeldRates(q, v);
    Evaluate(time, q, v);
  } while (contacts_.Release(now_->motion, drives()));
  HoldContacts();
  Place(time, q, v);
  std::copy(now_->motion.ws().v.begin(), now_->motion.ws().v.end(), v);
}

/// What is to come to rest still moves by rounding as it does: whether it can be held is asked
/// before it is, since holding what turns while the mechanism moves would stop the mechanism.
void EquationsOfMotion::KeepHeldRates(const double* q, const double* v) {
  ConstrainedMotion& motion = now_->motion;
  motion.SetPose(q);
  motion.TakeVelocities(v);
  for (size_t k = driven_.size(); k < held_rates_.size(); ++k) {
    held_rates_[k] = motion.RateOf(motion.held()[k]);
  }
}

std::unique_ptr<EquationsOfMotion::Choice> EquationsOfMotion::MakeChoice(const VectorXd& q,
                                                                         double tolerance) const {
  auto choice =
      std::make_unique<Choice>(prepared_, vmech::ChooseFreedoms(tree_, q, driven_, tolerance));
  choice->motion.Hold(now_->motion.held());
  choice->motion.TakeColumnSizes(regular_->motion);
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
  const double pivot = regular_->motion.smallest_pivot();
  return pivot < (pivot < kNearSingular ? kWornNearSingular : kWorn) * regular_->best_pivot;
}

MotionSample EquationsOfMotion::DriveAt(size_t drive, double time) const {
  if (!given_drives_.empty()) return given_drives_[drive];
  return prepared_.simulation.drives[drive].law.At(time);
}

void EquationsOfMotion::FindDriveMotion(double time) {
  for (size_t k = 0; k < driven_.size(); ++k) {
    const MotionSample sample = DriveAt(k, time);
    held_rates_[k] = sample.velocity;
    held_slopes_[k] = sample.acceleration;
  }
}

void EquationsOfMotion::SetPose(const double* q) {
  now_ = regular_.get();
  now_->motion.SetPose(q);
  leads_over_ = false;
  if (tree_.loops.empty()) return;
  CloseIfNearlySingular();
  const bool singular = now_->motion.smallest_pivot() < Nearest();
  leads_over_ = singular && avoids_singular_;
  if (!singular || leads_over_) return;
  // More motions are free at this pose: what loops do not decide, inertia does.
  ++singular_poses;
  singular_ = MakeChoice(now_->motion.ws().q, kSingularRank);
  singular_->forces.ContinueFrom(regular_->forces);
  now_ = singular_.get();
}

/// The pivot below which a pose is taken as singular.
double EquationsOfMotion::Nearest() const {
  return comes_nearest_ ? kNearest : kSingular;
}

void EquationsOfMotion::CloseIfNearlySingular() {
  constexpr double kClosed = 1e-15;
  const double pivot = now_->motion.smallest_pivot();
  if (pivot >= kNearlySingular || pivot < Nearest()) return;
  const VectorXd& q = now_->motion.ws().q;
  closed_.assign(q.begin(), q.end());
  now_->motion.Close(kClosed, closed_.data());
}

void EquationsOfMotion::GoOnFromHere() {
  regular_->motion.MeasureColumns();
  // Behind a singular pose, at which no choice was better, this one is judged by its best again.
  regular_->best_pivot = std::max(regular_->best_pivot, regular_->motion.smallest_pivot());
  from_singular_ = now_ == singular_.get();
}

void EquationsOfMotion::Place(double time, const double* q, const double* v) {
  SetPose(q);
  GoOnFromHere();
  FindDriveMotion(time);
  now_->motion.SetVelocities(v, held_rates_.data());
  now_->forces.FindJoints(&now_->motion);
}

void EquationsOfMotion::TakeState(double time, const double* q, const double* v,
                                  const double* vdot) {
  ++evaluations;
  now_ = regular_.get();
  ConstrainedMotion& motion = now_->motion;
  LoadWorkspace<double>& ws = motion.ws();
  motion.SetPose(q);
  motion.TakeVelocities(v);
  now_->forces.FindJoints(&motion);
  now_->forces.Evaluate(time, &motion);
  now_->forces.Apply(&motion);
  std::copy(vdot, vdot + tree_.nv, ws.vdot.data());
  ForwardAccelerations(tree_, ws.vdot.data(), &ws.tree);
  NewtonEuler(tree_, ws.inertias, ws.applied.data(), &ws.tree, ws.tau.data());
}

bool EquationsOfMotion::Evaluate(double time, const double* q, const double* v) {
  ++evaluations;
  SetPose(q);
  FindDriveMotion(time);
  ConstrainedMotion& motion = now_->motion;
  motion.SetVelocities(v, held_rates_.data());
  now_->forces.FindJointsThatCount(&motion);
  contacts_.SetSliding(&motion);
  now_->forces.Evaluate(time, &motion);
  if (under_load_) return AccelerateUnderLoad();
  now_->forces.Apply(&motion);
  motion.Accelerate(motion.ws().passive, held_slopes_.data());
  return true;
}

/// Friction follows the joints' wrenches, and they the accelerations under friction.
bool EquationsOfMotion::AccelerateUnderLoad() {
  ConstrainedMotion& motion = now_->motion;
  LoadWorkspace<double>& ws = motion.ws();
  JointFrames(tree_, ws.tree, &ws.joints);
  ws.reactions.Factor(ws.tree, ws.joints);
  const bool settled = friction_.Run(tree_.length, &ws.loads, [&] {
    now_->forces.Apply(&motion);
    motion.Accelerate(ws.passive, held_slopes_.data());
    held_along_ = now_->forces.motors();
    contacts_.AddHeldForces(motion, drives(), &held_along_);
    ws.exerted = held_along_.data();
    EquilibriumPass(now_->model, &ws);
  });
  now_->forces.Apply(&motion);
  motion.Accelerate(ws.passive, held_slopes_.data());
  return settled && LockingJoint(now_->model, ws, true) < 0;
}

std::vector<Vector3d> EquationsOfMotion::BesideSprings() const {
  std::vector<Vector3d> beside = now_->forces.BesideSprings(now_->motion);
  contacts_.AddHeldForces(now_->motion, drives(), &beside);
  return beside;
}

void EquationsOfMotion::Impact(double time, const double* q, const double* v,
                               const std::vector<Contacts::Hit>& hits) {
  std::vector<RateRow> rows = HeldRows();
  FindDriveMotion(time);
  std::vector<double> rates = held_rates_;
  for (const Contacts::Hit& hit : hits) {
    rows.push_back(hit.row);
    rates.push_back(hit.rate);
  }
  SetPose(q);
  now_->motion.Hold(rows);
  now_->motion.SetPose(q);
  now_->motion.SetVelocities(v, rates.data());
}

bool EquationsOfMotion::Slopes(double time, const double* y, double* slopes) {
  const double* const v = y + tree_.nq;
  avoids_singular_ = !from_singular_;
  const bool found = Evaluate(time, y, v);
  avoids_singular_ = false;
  if (!found || leads_over_) return false;
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
    q[CoordinateIndex(tree_, drive.joint, drive.freedom)] = DriveAt(k, time).position;
  }
  SetPose(q);
  return now_->motion.Close(std::max(kClosed, 0.1 * prepared_.closure_tolerance), q);
}

double EquationsOfMotion::RateDrift(const double* v) const {
  const TreeWorkspace<double>& ws = now_->motion.ws().tree;
  double largest = 0;
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    const Vector6d* column = ws.columns(l);
    Vector6d rates = Vector6d::Zero();
    for (const LoopColumn& c : loop.columns) rates += *column++ * v[c.v];
    for (int i = 0; i < loop.rows; ++i) {
      const double unit = IsLengthRow(loop.type, i) ? 1 / tree_.length : 1;
      largest = std::max(largest, unit * std::abs(rates[i]));
    }
  }
  return largest;
}

double EquationsOfMotion::KineticEnergyHere() const {
  const LoadWorkspace<double>& ws = now_->motion.ws();
  return KineticEnergy(tree_, ws.inertias, ws.tree);
}

double EquationsOfMotion::WeightEnergyHere() const {
  const LoadWorkspace<double>& ws = now_->motion.ws();
  const Vector3d& gravity = tree_.mechanism.gravity_W;
  double mass = 0;
  for (const TreeNode& node : tree_.nodes) mass += node.mass;
  const Vector3d moved = ws.tree.reference - tree_.reference;
  return WeightEnergy(gravity, ws.inertias) - mass * gravity.dot(moved);
}

}  // namespace vmech
