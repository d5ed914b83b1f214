#include "vmech/hw_interface/audit/audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/dynamics/in_hand/virtual_coupling.h"
#include "vmech/dynamics/reactions/joint_wrenches.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr double kExact = 1e-9;       // m, rad and shares: what rounding and printing leave
constexpr double kNewton = 0.05;      // of the largest force: a step of the period is no limit
constexpr double kConstraint = 1e-6;  // of the largest wrench
constexpr double kEnergyGain = 0.01;  // of the hand's work

/// The mechanism in one tick.
struct MechanismState {
  explicit MechanismState(const KinematicTree& tree)
      : ws(tree), inertias(tree), joints(tree.mechanism.joints.size()) {
    SetGravity(tree.mechanism.gravity_W, &ws);
  }

  /// `v`: the velocity of its inertia.
  void Set(const KinematicTree& tree, const VectorXd& q, const VectorXd& v) {
    ForwardKinematics(tree, q.data(), &ws);
    ForwardVelocities(tree, v.data(), &ws);
    LoopErrors(tree, &ws);
    BodyInertias(tree, ws, &inertias);
    JointFrames(tree, ws, &joints);
    closure = LargestLoopError(tree, ws);
    kinetic = KineticEnergy(tree, inertias, ws);
    weight = WeightEnergy(tree.mechanism.gravity_W, inertias);
    momenta.clear();
    for (size_t i = 0; i < ws.nodes.size(); ++i) {
      momenta.push_back(i == 0 ? Screw{} : inertias.bodies[i] * ws.nodes[i].V);
    }
  }

  TreeWorkspace<double> ws;
  TreeInertias<double> inertias;
  std::vector<JointState<double>> joints;
  std::vector<Screw> momenta;  // of the nodes, about the reference point; node i at i + 1
  double closure = 0, kinetic = 0, weight = 0;
};

class Judgement {
 public:
  Judgement(std::string what, double bound, std::string unit)
      : finding_{std::move(what), 0, bound, std::move(unit), 0} {}
  /// A number that is none is the worst of all.
  void Add(double value, std::uint64_t tick) {
    if (value <= finding_.worst) return;
    if (std::isnan(finding_.worst)) return;
    finding_.worst = value;
    finding_.tick = tick;
  }
  const AuditFinding& finding() const { return finding_; }

 private:
  AuditFinding finding_;
};

/// -1: the recording has none of this name.
int ChannelOf(const RecordingHeader& header, std::string_view name) {
  const auto found = std::find(header.channels.begin(), header.channels.end(), name);
  return found == header.channels.end() ? -1 : static_cast<int>(found - header.channels.begin());
}

double Distance(const Posed& A, const Posed& B) {
  return HandError(A, B).cwiseAbs().maxCoeff();
}

/// Forces, and moments over a length.
double Size(const Screw& W, double length) {
  return std::max(Length(W.linear), Length(W.angular) / length);
}

bool HasLimits(const Joint& joint) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return std::any_of(joint.lower.begin(), joint.lower.end(), finite) ||
         std::any_of(joint.upper.begin(), joint.upper.end(), finite);
}

/// Nothing acts along its freedoms but what the constraints do.
bool IsBare(const Joint& joint) {
  return std::none_of(joint.passive.begin(), joint.passive.end(),
                      [](const Passive& passive) { return HasPassive(passive); }) &&
         !HasLimits(joint);
}

}  // namespace

struct RecordingAudit::Parts {
  explicit Parts(const RecordingHeader& header)
      : held(header),
        promise(PromiseOf(header)),
        period(header.period),
        passive(held.tree),
        before(held.tree),
        now(held.tree),
        net(held.tree.nodes.size() + 1),
        loops("loops of the mechanism, closed to", held.tree.mechanism.tolerance, "-"),
        grasp("grasp frame from the coordinates, off by", kExact, "m, rad"),
        hand("hand in the world from the sample, off by", kExact, "m, rad"),
        stored("stored energy from q and v, off by", kExact, "-"),
        wanted("wrench from the mechanism to the safety filter, off by", kExact, "-"),
        sent("wrench from the filter to the device, off by", kExact, "-"),
        free("constraints along free motions, share of the largest wrench", kConstraint, "-"),
        newton("force balance of every link, share of the largest", kNewton, "-"),
        u(VectorXd::Zero(held.tree.nv)),
        felt_v(u),
        share_channel(ChannelOf(header, "inertia_share")),
        losses_channel(ChannelOf(header, "remembered_losses")) {
    for (int i = 0; i < header.hands(); ++i) {
      hands.push_back({held.grasps[i],
                       VirtualCoupling(PromiseOf(header, i).coupling, held.grasps[i].kind, period),
                       {},
                       {}});
    }
  }

  /// A hand on the mechanism.
  struct Hand {
    GraspFrame grasp;
    VirtualCoupling coupling;
    Posed X_WG_before, X_WH_before;
    Vector6d dynamic_before = Vector6d::Zero();
    bool held = false;  // once
    bool let_go = false;
    bool late = false;  // it has closed on a link that moved, and its frame slid along
  };

  void Take(const TickRecord& tick);
  const VectorXd& VelocityOfInertia(const TickRecord& tick);
  void JudgePose(const TickRecord& tick);
  void JudgeStoredEnergy(const TickRecord& tick);
  void JudgeWrenches(const TickRecord& tick);
  void JudgeJoints(const TickRecord& tick);
  double AlongCutFreedoms(int joint, const Wrenchd& w) const;
  void JudgeLinks(const TickRecord& tick, const MechanismState& at);
  double WorkOf(const Hand& hand, const HandPicture& picture) const;
  void Balance(const TickRecord& tick);

  RecordedTree held;
  SessionPromise promise;
  double period;
  std::vector<Hand> hands;
  PassiveJoints passive;
  MechanismState before, now;
  std::vector<Screw> net;  // on every node; node i at i + 1
  Judgement loops, grasp, hand, stored, wanted, sent, free, newton;
  EnergyBalance energy;
  // In the paper's way:
  VectorXd u, felt_v;  // behind the roll-off; of the inertia that is felt
  MasterState last_sample;
  int share_channel, losses_channel;
  double joint_work = 0;  // of this tick [J]
  double first_kinetic = 0, first_weight = 0;
  double largest_force = 0;
  std::uint64_t ticks = 0;
  bool started = false, follows = false;
};

/// Before the first sample there is no mechanism in hand.
void RecordingAudit::Parts::Take(const TickRecord& tick) {
  const auto& others = tick.others;
  const bool has_come = tick.io == IoStatus::kOk ||
                        std::any_of(others.begin(), others.end(), [](const HandRecord& other) {
                          return other.io == IoStatus::kOk;
                        });
  if (!started && !has_come) {
    ++ticks;
    return;
  }
  for (size_t i = 0; i < hands.size(); ++i) {
    const bool holds = tick.picture.hand(static_cast<int>(i)).holds;
    hands[i].let_go = hands[i].let_go || (hands[i].held && !holds);
    hands[i].late = hands[i].late || (started && holds && !hands[i].held);
    hands[i].held = hands[i].held || holds;
  }
  now.Set(held.tree, tick.picture.q, promise.paper ? VelocityOfInertia(tick) : tick.picture.v);
  JudgePose(tick);
  JudgeStoredEnergy(tick);
  JudgeWrenches(tick);
  if (started) {
    JudgeJoints(tick);
    Balance(tick);
  } else {
    first_kinetic = now.kinetic;
    first_weight = now.weight;
  }
  started = true;
  for (size_t i = 0; i < hands.size(); ++i) {
    const HandPicture& picture = tick.picture.hand(static_cast<int>(i));
    hands[i].X_WG_before = picture.X_WG;
    hands[i].X_WH_before = picture.X_WH;
    hands[i].dynamic_before = picture.dynamic;
  }
  std::swap(before, now);
  ++ticks;
}

/// s^1/2 u, with the share s that was felt and u behind the roll-off, as MechanismTick finds them.
const VectorXd& RecordingAudit::Parts::VelocityOfInertia(const TickRecord& tick) {
  if (tick.io != IoStatus::kOk) return felt_v;
  const double periods = started ? PeriodsBetween(last_sample, tick.state, period) : 1;
  const double elapsed = period * std::max(1.0, std::round(periods));
  last_sample = tick.state;
  u += elapsed / (promise.roll_off + elapsed) * (tick.picture.v - u);
  const double share =
      share_channel < 0 ? promise.inertia : tick.channels[static_cast<size_t>(share_channel)];
  felt_v = std::sqrt(share) * u;
  return felt_v;
}

void RecordingAudit::Parts::JudgePose(const TickRecord& tick) {
  loops.Add(now.closure, ticks);
  for (size_t i = 0; i < hands.size(); ++i) {
    const int index = static_cast<int>(i);
    const HandPicture& picture = tick.picture.hand(index);
    const HandRecord& record = tick.of_hand(index);
    if (!held.regrasps && !hands[i].late) {
      const Posed X_WG = PoseInWorld(now.ws, hands[i].grasp.node, hands[i].grasp.X_BG);
      grasp.Add(Distance(X_WG, picture.X_WG), ticks);
    }
    if (!picture.holds && hands.size() > 1) continue;
    const Posed& X_DH = record.observed ? record.hand.X_DH : record.state.X_DH;
    hand.Add(Distance(record.registration.HandInWorld(X_DH), picture.X_WH), ticks);
  }
}

/// That of the virtual coupling, whose spring remembers where it slips, with what steps have lost
/// and may give back; of several hands the sum of what they have stored, as long as none has let
/// go.
void RecordingAudit::Parts::JudgeStoredEnergy(const TickRecord& tick) {
  if (!promise.known || promise.paper || held.regrasps) return;
  double own = now.kinetic + now.weight + passive.Energy(tick.picture.q), told = 0;
  bool all_hold = true;
  for (size_t i = 0; i < hands.size(); ++i) {
    Hand& hand = hands[i];
    const HandPicture& picture = tick.picture.hand(static_cast<int>(i));
    const HandRecord& record = tick.of_hand(static_cast<int>(i));
    told += record.stored_energy;
    all_hold = all_hold && !hand.let_go && !hand.late;
    if (!picture.holds) continue;
    const MovingFrame hand_W{FrameOf(picture.X_WH), {}};
    hand.coupling.Within(record.room.Times(1 / promise.scale));
    if (started) hand.coupling.Stretch(FrameOf(hand.X_WG_before), hand_W);
    hand.coupling.Stretch(FrameOf(picture.X_WG), hand_W);
    own += hand.coupling.energy();
  }
  own *= promise.scale;
  if (losses_channel >= 0) own += tick.channels[static_cast<size_t>(losses_channel)];
  const double size = std::abs(now.kinetic) + std::abs(now.weight) + std::abs(own);
  if (all_hold) stored.Add(std::abs(own - told) / std::max(size, 1e-6), ticks);
}

void RecordingAudit::Parts::JudgeWrenches(const TickRecord& tick) {
  for (size_t i = 0; i < hands.size(); ++i) {
    const HandPicture& picture = tick.picture.hand(static_cast<int>(i));
    const HandRecord& record = tick.of_hand(static_cast<int>(i));
    if (promise.known && !held.regrasps && picture.holds) {
      const Vector6d F_W = -promise.scale * (picture.dynamic + picture.constraint);
      const Matrix3d R_DW = record.registration.X_WD.R.transpose();
      Vector6d F_D;
      F_D << R_DW * F_W.head<3>(), R_DW * F_W.tail<3>();
      const double off = (F_D - record.wanted_F_Ho_D).cwiseAbs().maxCoeff();
      wanted.Add(off / std::max(1.0, F_D.cwiseAbs().maxCoeff()), ticks);
    }
    if (record.stages != 0 || record.off != ForceOff::kNone) continue;
    sent.Add((record.sent_F_Ho_D - record.wanted_F_Ho_D).cwiseAbs().maxCoeff(), ticks);
  }
}

/// Along the freedoms of a cut joint, which the tree does not have.
double RecordingAudit::Parts::AlongCutFreedoms(int j, const Wrenchd& w) const {
  const Joint& joint = held.tree.mechanism.joints[j];
  if (joint.type == JointType::kScrew) {
    return std::abs(joint.pitch * w.force.z() + w.moment.z()) / held.tree.length;
  }
  if (joint.type == JointType::kUniversal) return 0;
  double most = 0;
  const std::array<bool, 6>& free_axes = FreedomsOfType(joint.type).free;
  for (int i = 0; i < 3; ++i) {
    if (free_axes[i]) most = std::max(most, std::abs(w.force[i]));
    if (free_axes[3 + i]) most = std::max(most, std::abs(w.moment[i]) / held.tree.length);
  }
  return most;
}

/// The wrenches are those of the step that led here: in the paper's way at this pose, with the
/// virtual coupling at that where the step began.
void RecordingAudit::Parts::JudgeJoints(const TickRecord& tick) {
  const KinematicTree& tree = held.tree;
  const MechanismState& at = promise.paper ? now : before;
  std::fill(net.begin(), net.end(), Screw{});
  double most_along = 0;
  joint_work = 0;
  std::vector<Screw> wrenches(tick.picture.joints.size());
  for (size_t j = 0; j < wrenches.size(); ++j) {
    const Joint& joint = tree.mechanism.joints[j];
    const Screw W = WrenchFrom(at.joints[j].F, tick.picture.joints[j]);
    wrenches[j] = W;
    largest_force = std::max(largest_force, Size(W, tree.length));
    const JointPlacement& place = tree.placements[j];
    net[place.second_node + 1] += W;
    net[place.first_node + 1] -= W;
    if (place.tree_node < 0) {
      const double along = AlongCutFreedoms(static_cast<int>(j), tick.picture.joints[j]);
      most_along = std::max(most_along, along);
      energy.constraint += period * along;
    }
    (void)joint;
  }
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    const double sign = node.reversed ? -1 : 1;
    const bool bare = IsBare(tree.mechanism.joints[node.joint]);
    for (int i = 0; i < VelocitiesOf(node.motion); ++i) {
      const double along = sign * Power(wrenches[node.joint], at.ws.S[node.v + i]);
      const double work = period * along * tick.picture.v[node.v + i];
      joint_work += work;
      if (!bare) continue;
      const bool slides = node.motion == NodeMotion::kPrismatic;
      most_along = std::max(most_along, std::abs(along) / (slides ? 1 : tree.length));
      energy.constraint += std::abs(work);
    }
  }
  free.Add(most_along / std::max(largest_force, 1e-3), ticks);
  JudgeLinks(tick, at);
}

/// dh/dt = net wrench, for every link with mass.
void RecordingAudit::Parts::JudgeLinks(const TickRecord& tick, const MechanismState& at) {
  if (promise.paper || held.regrasps) return;
  const KinematicTree& tree = held.tree;
  for (size_t i = 0; i < hands.size(); ++i) {
    const Vector6d& w = tick.picture.hand(static_cast<int>(i)).dynamic;
    const Vector3d p_Go = hands[i].X_WG_before.p - tree.reference;
    net[hands[i].grasp.node + 1] +=
        WrenchAt(Double4Of(p_Go), Double4Of(w.head<3>()), Double4Of(w.tail<3>()));
  }
  double most = 0;
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const ScrewInertia& body = at.inertias.bodies[i + 1];
    const Double4 g = Double4Of(tree.mechanism.gravity_W);
    const Screw weight{body.mass * g, Cross(body.moment, g)};
    const Screw rate = (1 / period) * (now.momenta[i + 1] - before.momenta[i + 1]);
    most = std::max(most, Size(rate - net[i + 1] - weight, tree.length));
    largest_force = std::max(largest_force, Size(weight, tree.length));
  }
  newton.Add(most / std::max(largest_force, 1e-3), ticks);
}

/// Of a hand on the mechanism since the last tick. The virtual coupling pulls at the grasp, in a
/// step with the wrench of its end. In the paper's way w_d is felt at the hand beside the grasp,
/// and its work there is what the mechanism gets: by the mean of w_d at both ends of the way.
double RecordingAudit::Parts::WorkOf(const Hand& hand, const HandPicture& picture) const {
  if (!promise.paper) return picture.dynamic.dot(HandError(hand.X_WG_before, picture.X_WG));
  const Vector6d way = HandError(hand.X_WH_before, picture.X_WH);
  return 0.5 * (hand.dynamic_before + picture.dynamic).dot(way);
}

void RecordingAudit::Parts::Balance(const TickRecord& tick) {
  for (size_t i = 0; i < hands.size(); ++i) {
    const double work = WorkOf(hands[i], tick.picture.hand(static_cast<int>(i)));
    energy.hand += work;
    energy.throughput += std::abs(work);
  }
  energy.joints -= joint_work;
  energy.kinetic = now.kinetic - first_kinetic;
  energy.weight = now.weight - first_weight;
  energy.lost = energy.hand - energy.kinetic - energy.weight - energy.joints;
  energy.gained = std::max(energy.gained, -energy.lost);
}

RecordingAudit::RecordingAudit(const RecordingHeader& header)
    : parts_(std::make_unique<Parts>(header)) {}

RecordingAudit::~RecordingAudit() = default;

void RecordingAudit::Take(const TickRecord& tick) {
  parts_->Take(tick);
}

bool RecordingAudit::started() const {
  return parts_->started;
}

const EnergyBalance& RecordingAudit::energy() const {
  return parts_->energy;
}

double RecordingAudit::closure() const {
  return parts_->before.closure;
}

AuditReport RecordingAudit::Report() const {
  const Parts& p = *parts_;
  AuditReport report;
  report.ticks = p.ticks;
  report.energy = p.energy;
  report.findings = {p.loops.finding(), p.hand.finding(), p.free.finding(), p.sent.finding()};
  if (p.held.regrasps) {
    report.left_out = "grasp frame, stored energy and links: the hand takes hold anew";
    return report;
  }
  report.findings.push_back(p.grasp.finding());
  if (p.promise.known) {
    report.findings.push_back(p.wanted.finding());
  } else {
    report.left_out = "stored energy and wanted wrench: the recording does not say what was felt";
  }
  if (p.promise.paper) {
    report.left_out =
        "stored energy and links: in the paper's way the place of the hand moves the mechanism, no "
        "force";
  } else {
    if (p.promise.known) report.findings.push_back(p.stored.finding());
    report.findings.push_back(p.newton.finding());
  }
  const double share = p.energy.gained / std::max(p.energy.throughput, 1e-6);
  report.findings.push_back(
      {"energy from nowhere, share of the hand's work", share, kEnergyGain, "-", p.ticks});
  return report;
}

bool AuditReport::sound() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const AuditFinding& finding) { return finding.sound(); });
}

std::string AuditReport::Text() const {
  std::string text = fmt::format("audit of {} ticks\n", ticks);
  for (const AuditFinding& f : findings) {
    text += fmt::format("  {:<60} {:>9.2g} {:<6} at most {:g}{}\n", f.what, f.worst,
                        f.unit == "-" ? "" : f.unit, f.bound,
                        f.sound() ? "" : fmt::format("   NOT SOUND, tick {}", f.tick));
  }
  text += fmt::format("  energy: {}\n", energy.Text());
  if (!left_out.empty()) text += fmt::format("  not judged: {}\n", left_out);
  return text + fmt::format("verdict: {}\n", Verdict());
}

std::string AuditReport::Verdict() const {
  return sound() ? "sound, every number agrees with the mechanism"
                 : "not sound, these numbers are not those of this mechanism";
}

std::string EnergyBalance::Text() const {
  return fmt::format(
      "the hand did {:.4g} J on the mechanism; {:.4g} J went into motion, {:.4g} J into height, "
      "{:.4g} J into springs, friction and limits of joints, {:.4g} J were lost in time steps; "
      "constraints did {:.2g} J along free motions",
      hand, kinetic, weight, joints, lost, constraint);
}

}  // namespace vmech
