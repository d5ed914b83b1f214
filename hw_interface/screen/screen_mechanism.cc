#include "vmech/hw_interface/screen/screen_mechanism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/screen/slide_joint.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/link_poses.h"

namespace vmech {
namespace {

constexpr double kStretch = 5e-4;        // of the characteristic length, under the whole weight
constexpr double kSlip = 0.05;           // of the characteristic length: the longest stretch
constexpr double kFrequency = 100;       // of the whole mass on the spring, at least [rad/s]
constexpr double kSmooth = 0.01;         // of the longest stretch: of a design's change in a step
constexpr double kMouseLag = 15e-3;      // with which the hand follows the mouse [s]
constexpr double kPathPeriod = 5e-3;     // between rows of the recorded path [s]
constexpr size_t kLongestPath = 200000;  // rows

/// What the real-time path cannot render is left out, and said.
Mechanism LeaveOut(Mechanism mechanism, const SpanningTree& spanning,
                   std::vector<std::string>* notes) {
  for (Joint& joint : mechanism.joints) {
    if (joint.load_friction.coefficient == 0) continue;
    joint.load_friction = {};
    notes->push_back(fmt::format(
        "joint '{}': friction in proportion to the load is left out on the screen", joint.name));
  }
  for (const int cut : spanning.cuts) {
    Joint& joint = mechanism.joints[cut];
    if (std::none_of(joint.passive.begin(), joint.passive.end(), HasPassive)) continue;
    for (Passive& passive : joint.passive) passive = {};
    notes->push_back(fmt::format(
        "joint '{}' is cut; its springs and friction are left out on the screen", joint.name));
  }
  return mechanism;
}

std::unique_ptr<KinematicTree> MakeTree(Mechanism mechanism, std::vector<std::string>* notes) {
  SpanningTreeOptions cuts = KeepPassiveJoints(mechanism);
  cuts.prefer.insert(cuts.prefer.begin(), cuts.keep.begin(), cuts.keep.end());
  cuts.keep.clear();
  const SpanningTree spanning = FindSpanningTree(mechanism, cuts);
  return std::make_unique<KinematicTree>(
      BuildKinematicTree(LeaveOut(std::move(mechanism), spanning, notes), cuts));
}

void RequireFinite(std::string_view what, const Vector3d& value) {
  if (value.allFinite()) return;
  throw std::invalid_argument(fmt::format("{} has to be three finite numbers, not {} {} {}", what,
                                          value[0], value[1], value[2]));
}

/// Rates of all joints' freedoms, joint after joint.
std::vector<double> RatesOf(const KinematicTree& tree, const VectorXd& v,
                            TreeWorkspace<double>* ws) {
  const std::vector<Joint>& joints = tree.mechanism.joints;
  std::vector<Vector3d> rates(joints.size(), Vector3d::Zero());
  for (const TreeNode& node : tree.nodes) {
    const int count = VelocitiesOf(node.motion);
    for (int k = 0; k < count; ++k) rates[node.joint][node.freedom + k] = v[node.v + k];
  }
  ForwardVelocities(tree, v.data(), ws);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    rates[tree.loops[l].joint] = CutJointRates(tree, *ws, static_cast<int>(l));
  }
  std::vector<double> all;
  for (size_t j = 0; j < joints.size(); ++j) {
    all.insert(all.end(), rates[j].begin(), rates[j].begin() + FreedomsOf(joints[j].type));
  }
  return all;
}

/// Joints that stand at a limit, or beyond.
std::vector<int> JointsAtLimits(const Mechanism& mechanism) {
  constexpr double kAt = 1e-4;  // [m], [rad]
  std::vector<int> at;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    for (size_t k = 0; k < joint.lower.size() && joint.type != JointType::kSpherical; ++k) {
      if (joint.start[k] > joint.lower[k] + kAt && joint.start[k] < joint.upper[k] - kAt) continue;
      at.push_back(static_cast<int>(j));
      break;
    }
  }
  return at;
}

/// A rod between two balls, whose spin tells no modes apart.
bool IsRod(const Mechanism& mechanism, int link) {
  int balls = 0;
  for (const Joint& joint : mechanism.joints) {
    if (joint.first.link != link && joint.second.link != link) continue;
    if (joint.type != JointType::kSpherical) return false;
    ++balls;
  }
  return balls == 2;
}

}  // namespace

ScreenMechanism::ScreenMechanism(Mechanism assembled)
    : tree_(MakeTree(std::move(assembled), &notes_)), start_(StartCoordinates(*tree_)) {
  const Mechanism& m = mechanism();
  for (size_t i = 0; i < m.links.size(); ++i) {
    if (static_cast<int>(i) != m.ground) mass_ += m.links[i].mass_properties.mass;
  }
  Reset();
}

GraspFrame ScreenMechanism::FrameAt(int link, const Vector3d& p_L) const {
  return {tree_->NodeOfLink(link), tree_->X_node_link(link) * Posed{Matrix3d::Identity(), p_L},
          GraspKind::kPoint};
}

HandCoupling ScreenMechanism::MouseSpring() const {
  constexpr double kWithoutMass = 1000;  // [N/m]
  const double weight = mass_ * mechanism().gravity_W.norm();
  const double K =
      mass_ > 0 ? std::max(weight / (kStretch * tree_->length), mass_ * kFrequency * kFrequency)
                : kWithoutMass;
  HandCoupling spring;
  spring.stiffness.head<3>().setConstant(K);
  spring.max_force = kSlip * K * tree_->length;
  spring.damping.head<3>().setConstant(mass_ > 0 ? 2 * std::sqrt(K * mass_) : kMouseLag * K);
  return spring;
}

void ScreenMechanism::SetInMotion() {
  if (dynamics_) return;
  const int any = mechanism().ground == 0 ? 1 : 0;
  dynamics_ = std::make_unique<CoupledDynamics>(*tree_, FrameAt(any, Vector3d::Zero()),
                                                MouseSpring(), kStep, q_);
}

void ScreenMechanism::StandAt(const VectorXd& q) {
  dynamics_.reset();
  hand_.reset();
  q_ = q;
  mode_ = ScreenMode::kFrozen;
  stopped_ = false;
}

void ScreenMechanism::Grab(int link, const Vector3d& p_L) {
  const int links = static_cast<int>(mechanism().links.size());
  if (link < 0 || link >= links) {
    throw std::invalid_argument(fmt::format("there is no link {}; there are {}", link, links));
  }
  if (tree_->NodeOfLink(link) < 0) {
    throw std::invalid_argument(
        fmt::format("'{}' is the ground, which nothing moves", mechanism().links[link].name));
  }
  RequireFinite("the point of the link", p_L);
  SetInMotion();
  const GraspFrame grasp = FrameAt(link, p_L);
  dynamics_->GraspAt(grasp);
  TreeWorkspace<double> ws(*tree_);
  ForwardKinematics(*tree_, dynamics_->q().data(), &ws);
  const Vector3d point = PoseInWorld(ws, grasp.node, grasp.X_BG).p;
  hand_ = Hand{link, p_L, point, point};
  mode_ = ScreenMode::kHeld;
  path_ = {link, p_L, dynamics_->q(), {0}, {point}};
  path_time_ = 0;
}

void ScreenMechanism::Drag(const Vector3d& p_W) {
  RequireFinite("the hand", p_W);
  if (hand_) hand_->target = p_W;
}

void ScreenMechanism::Release(bool keep) {
  if (!hand_) return;
  if (keep) {
    hand_->target = hand_->at = dynamics_->X_WG().p;
    return;
  }
  dynamics_->LetGo();
  hand_.reset();
  mode_ = ScreenMode::kSwinging;
}

void ScreenMechanism::Swing() {
  if (mass_ == 0) {
    throw std::invalid_argument("no link has a mass: nothing would move by itself");
  }
  SetInMotion();
  dynamics_->LetGo();
  hand_.reset();
  mode_ = ScreenMode::kSwinging;
}

void ScreenMechanism::Freeze() {
  StandAt(VectorXd(q()));
}

void ScreenMechanism::Reset() {
  VectorXd q = start_;
  if (design_ && !Assemble(*tree_, AssemblyOptions(), &q).closed) {
    throw std::runtime_error("its loops do not close near its start any more; it stays here");
  }
  StandAt(q);
  time_ = 0;
}

void ScreenMechanism::CheckFreedom(int joint, int freedom) const {
  const std::vector<Joint>& joints = mechanism().joints;
  if (joint < 0 || joint >= static_cast<int>(joints.size())) {
    throw std::invalid_argument(
        fmt::format("there is no joint {}; there are {}", joint, joints.size()));
  }
  if (freedom >= 0 && freedom < FreedomsOf(joints[joint].type)) return;
  throw std::invalid_argument(fmt::format("joint '{}' has no freedom {}; it has {}",
                                          joints[joint].name, freedom,
                                          FreedomsOf(joints[joint].type)));
}

void ScreenMechanism::Slide(int joint, int freedom, double value) {
  CheckFreedom(joint, freedom);
  if (!std::isfinite(value)) {
    throw std::invalid_argument("a joint's coordinate has to be a finite number");
  }
  const SlideResult slid = SlideJoint(MechanismAt(q()), joint, freedom, value);
  VectorXd q = StartCoordinates(BuildKinematicTree(slid.mechanism, {{}, tree_->spanning.cuts, {}}));
  StandAt(q);
  stopped_ = slid.stopped;
}

AssemblyModes ScreenMechanism::FindModes(const VectorXd& q) const {
  AssemblyModesOptions options;
  options.max_starts = 4000;
  options.patience = 400;
  for (const int v : PartitionAtPose(*tree_, q).driven) {
    const auto node =
        std::find_if(tree_->nodes.begin(), tree_->nodes.end(), [&](const TreeNode& n) {
          return n.v >= 0 && v >= n.v && v < n.v + VelocitiesOf(n.motion);
        });
    if (node->motion != NodeMotion::kSpherical) options.fixed.push_back(v);
  }
  for (int link = 0; link < static_cast<int>(mechanism().links.size()); ++link) {
    if (!IsRod(mechanism(), link)) options.links.push_back(link);
  }
  return FindAssemblyModes(*tree_, options, q);
}

void ScreenMechanism::GoTo(const VectorXd& q) {
  if (q.size() != tree_->nq || !q.allFinite()) {
    throw std::invalid_argument(fmt::format("a pose has {} finite coordinates", tree_->nq));
  }
  StandAt(q);
}

/// The hand follows the mouse, whose moves come in jumps.
MovingFrame ScreenMechanism::MoveHand() noexcept {
  if (!hand_) return {};
  const Vector3d velocity = (hand_->target - hand_->at) / kMouseLag;
  const Posed X_WH{Matrix3d::Identity(), hand_->at};
  hand_->at += (1 - std::exp(-kStep / kMouseLag)) * (hand_->target - hand_->at);
  return {FrameOf(X_WH), ScrewOf(Stacked<double>(velocity, Vector3d::Zero()))};
}

std::vector<int> ScreenMechanism::AllGrasps() const {
  std::vector<int> all(mechanism().grasps.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void ScreenMechanism::VaryTo(const HeldDesign& start, const HeldDesign& design) {
  if (!design_) design_.emplace(start);
  design_->GoTo(design);
}

/// A step on the way to another design; the mouse's spring is to be stretched no faster than a hand
/// feels smoothly. True if the mechanism has changed.
bool ScreenMechanism::Vary() {
  if (!design_ || !design_->moves()) return false;
  const WrenchLimit most = {kSmooth * MouseSpring().max_force};
  const double work = dynamics_->design_work();
  const bool changed = design_->Advance([&](const HeldDesign& from, const HeldDesign& to) noexcept {
    return dynamics_->ChangeDesign(from, to, most);
  });
  design_work_ += dynamics_->design_work() - work;
  return changed;
}

/// The tree with the numbers of the design; who refers to it goes by its topology alone. A drag
/// begins anew: it is one of one mechanism.
void ScreenMechanism::TakeDesign() {
  const std::vector<int> cuts = tree_->spanning.cuts;
  *tree_ = BuildKinematicTree(MechanismWith(design_->now(), *tree_, AllGrasps()), {{}, cuts, {}});
  path_ = {};
  path_time_ = 0;
  if (hand_) path_ = {hand_->link, hand_->p_L, dynamics_->q(), {0}, {dynamics_->X_WG().p}};
}

void ScreenMechanism::Advance(int steps) {
  if (!moves()) return;
  SetInMotion();
  bool changed = false;
  CoupledStatus status = CoupledStatus::kMoved;
  for (int i = 0; i < steps && status != CoupledStatus::kFailed; ++i) {
    changed = Vary() || changed;
    if (mode_ == ScreenMode::kFrozen) continue;
    status = dynamics_->Step(MoveHand());
    time_ += kStep;
    stopped_ = status == CoupledStatus::kStopped;
    Record();
  }
  if (changed) TakeDesign();
  const bool failed = status == CoupledStatus::kFailed;
  if (failed || mode_ == ScreenMode::kFrozen) Freeze();
  if (failed) {
    throw std::runtime_error("the motion came to no finite numbers; the mechanism stands still");
  }
}

void ScreenMechanism::Record() {
  if (!hand_ || path_.times.size() >= kLongestPath) return;
  const double next = static_cast<double>(path_.times.size()) * kPathPeriod;
  path_time_ += kStep;
  if (path_time_ + kStep / 2 < next) return;
  path_.times.push_back(path_time_);
  path_.points.push_back(dynamics_->X_WG().p);
}

Mechanism ScreenMechanism::MechanismAt(const VectorXd& q) const {
  Mechanism now = mechanism();
  SetStarts(*tree_, q, &now);
  return now;
}

ScreenState ScreenMechanism::State() const {
  const VectorXd q = this->q();
  ScreenState state;
  state.time = time_;
  state.mode = mode_;
  state.links = LinkPoses(*tree_, q);
  state.stopped = stopped_;
  const Mechanism now = MechanismAt(q);
  state.coordinates = StartOfFreedoms(now);
  state.at_limit = JointsAtLimits(now);
  TreeWorkspace<double> ws(*tree_);
  ForwardKinematics(*tree_, q.data(), &ws);
  LoopErrors(*tree_, &ws);
  state.closure = LargestLoopError(*tree_, ws);
  const VectorXd v = dynamics_ ? VectorXd(dynamics_->v()) : VectorXd::Zero(tree_->nv);
  state.rates = RatesOf(*tree_, v, &ws);
  if (!dynamics_) return state;
  state.wrenches = dynamics_->joints();
  state.certainty = JudgeCertainty(*tree_, PartitionAtPose(*tree_, q), q);
  if (!hand_) return state;
  state.link = hand_->link;
  state.point = dynamics_->X_WG().p;
  state.target = hand_->target;
  state.force = dynamics_->w().head<3>();
  return state;
}

}  // namespace vmech
