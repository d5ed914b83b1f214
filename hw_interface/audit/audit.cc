#include "vmech/hw_interface/audit/audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/in_hand/virtual_coupling.h"
#include "vmech/hw_interface/audit/energy_trace.h"
#include "vmech/hw_interface/audit/felt_motion.h"
#include "vmech/hw_interface/audit/link_balance.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/hw_interface/rendering/contact_law.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_rows.h"

namespace vmech {
namespace {

constexpr double kExact = 1e-9;       // m, rad and shares: what rounding and printing leave
constexpr double kNewton = 0.05;      // of the largest force: a step of the period is no limit
constexpr double kBalance = 1e-8;     // of the largest force, where accelerations are known
constexpr double kConstraint = 1e-6;  // of the largest wrench
constexpr double kLeastWork = 1e-6;   // [J], of which shares are told

double Distance(const Posed& A, const Posed& B) {
  return HandError(A, B).cwiseAbs().maxCoeff();
}

double Channel(const TickRecord& tick, int index) {
  return tick.channels[static_cast<size_t>(index)];
}

}  // namespace

struct RecordingAudit::Parts {
  explicit Parts(const RecordingHeader& header)
      : held(header),
        promise(PromiseOf(header)),
        as_printed(header.Note("wrench") == "paper"),
        period(header.period),
        passive(held.tree),
        felt(header),
        own(header),
        before(held.tree),
        now(held.tree),
        balance(held.tree, period),
        trace(held.tree, period, promise.paper),
        unpaid_channel(header.ChannelOf("unpaid_energy")),
        losses_channel(header.ChannelOf("remembered_losses")) {
    loops.bound = held.tree.mechanism.tolerance;
    newton.bound = promise.paper ? kBalance : kNewton;
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
  void SetPose(const TickRecord& tick);
  void JudgePose(const TickRecord& tick);
  void JudgeStoredEnergy(const TickRecord& tick);
  double StoredOfCoupling(const TickRecord& tick, bool* all_hold);
  double StoredOfConstraint(const TickRecord& tick) const;
  void JudgeWrenches(const TickRecord& tick);
  void JudgeLinks(const TickRecord& tick);
  void Balance(const TickRecord& tick);
  bool Pays(const TickRecord& tick) const;
  static bool Owes(const TickRecord& tick, int hands);
  bool links_are_judged() const { return !held.regrasps && (!promise.paper || felt.knows_rate()); }

  RecordedTree held;
  SessionPromise promise;
  bool as_printed;  // the wrenches of paper eq. (14)
  double period;
  std::vector<Hand> hands;
  PassiveJoints passive;
  FeltMotion felt;
  OwnWrench own;
  AuditedPose before, now;
  LinkBalance balance;
  EnergyTrace trace;
  MatrixXd idle;  // motions that nothing drives, where there are any
  AuditFinding loops{"loops of the mechanism, closed to", 0, 0, "-", 0};
  AuditFinding grasp{"grasp frame from the coordinates, off by", 0, kExact, "m, rad", 0};
  AuditFinding hand{"hand in the world from the sample, off by", 0, kExact, "m, rad", 0};
  AuditFinding stored{"stored energy from q and v, off by", 0, kExact, "-", 0};
  AuditFinding wanted{"wrench from the mechanism to the safety filter, off by", 0, kExact, "-", 0};
  AuditFinding sent{"wrench from the filter to the device, off by", 0, kExact, "-", 0};
  AuditFinding free{"constraints along free motions, share of the largest wrench", 0, kConstraint,
                    "-", 0};
  AuditFinding newton{"force balance of every link, share of the largest", 0, 0, "-", 0};
  int unpaid_channel, losses_channel;
  bool own_before = false;  // OwnWrench of the tick before
  bool owed = false;        // the tick before left a debt, or may have
  std::uint64_t ticks = 0, bounded_ticks = 0, paid_ticks = 0;
  bool started = false;
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
  SetPose(tick);
  JudgePose(tick);
  JudgeStoredEnergy(tick);
  JudgeWrenches(tick);
  if (started) {
    JudgeLinks(tick);
    Balance(tick);
  } else {
    trace.Begin(now);
  }
  started = true;
  for (size_t i = 0; i < hands.size(); ++i) {
    const HandPicture& picture = tick.picture.hand(static_cast<int>(i));
    hands[i].X_WG_before = picture.X_WG;
    hands[i].X_WH_before = picture.X_WH;
    hands[i].dynamic_before = picture.dynamic;
  }
  own_before = own.IsOfNearestPose(tick, kExact);
  owed = Owes(tick, static_cast<int>(hands.size()));
  std::swap(before, now);
  ++ticks;
}

/// What the hands were given was more than they gave.
bool RecordingAudit::Parts::Owes(const TickRecord& tick, int hands) {
  for (int i = 0; i < hands; ++i) {
    if (tick.of_hand(i).energy < 0) return true;
  }
  return false;
}

/// Debts of the tick before may have been taken out of the velocities: then no losses are left.
bool RecordingAudit::Parts::Pays(const TickRecord& tick) const {
  return owed && !promise.paper && (losses_channel < 0 || Channel(tick, losses_channel) == 0);
}

/// In the paper's way with the motion of the inertia that is felt.
void RecordingAudit::Parts::SetPose(const TickRecord& tick) {
  const TickPicture& picture = tick.picture;
  if (!promise.paper) return now.Set(held.tree, picture.q, picture.v);
  felt.Take(tick);
  now.Set(held.tree, picture.q, felt.velocity());
  if (!started || idle.cols() > 0) idle = IdleMotionsOf(held.tree, held.grasp, picture.q);
  now.Accelerate(held.tree, passive, picture.v, felt.rate(), idle);
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

void RecordingAudit::Parts::JudgeStoredEnergy(const TickRecord& tick) {
  if (!promise.known || held.regrasps || (promise.paper && unpaid_channel < 0)) return;
  double told = 0;
  for (size_t i = 0; i < hands.size(); ++i) told += tick.of_hand(static_cast<int>(i)).stored_energy;
  bool all_hold = true;
  const double now_stored =
      promise.paper ? StoredOfConstraint(tick) : StoredOfCoupling(tick, &all_hold);
  const double size = std::abs(now.kinetic) + std::abs(now.weight) + std::abs(now_stored);
  if (all_hold) stored.Add(std::abs(now_stored - told) / std::max(size, kLeastWork), ticks);
}

/// That of the virtual coupling, whose spring remembers where it slips, with what steps have lost
/// and may give back; of several hands the sum of what they have stored, as long as none has let
/// go.
double RecordingAudit::Parts::StoredOfCoupling(const TickRecord& tick, bool* all_hold) {
  double sum = now.kinetic + now.weight + passive.Energy(now.q);
  for (size_t i = 0; i < hands.size(); ++i) {
    Hand& hand = hands[i];
    const HandPicture& picture = tick.picture.hand(static_cast<int>(i));
    *all_hold = *all_hold && !hand.let_go && !hand.late;
    if (!picture.holds) continue;
    const MovingFrame hand_W{FrameOf(picture.X_WH), {}};
    hand.coupling.Within(tick.of_hand(static_cast<int>(i)).room.Times(1 / promise.scale));
    if (started) hand.coupling.Stretch(FrameOf(hand.X_WG_before), hand_W);
    hand.coupling.Stretch(FrameOf(picture.X_WG), hand_W);
    sum += hand.coupling.energy();
  }
  sum *= promise.scale;
  return losses_channel < 0 ? sum : sum + Channel(tick, losses_channel);
}

/// That of the paper's way: the share of inertia, weight, springs and the constraint, less what no
/// hand has given and is not paid back yet.
double RecordingAudit::Parts::StoredOfConstraint(const TickRecord& tick) const {
  ContactLaw law;
  law.stiffness = RowsThatCount(promise.scale * promise.coupling.stiffness, held.grasp.kind);
  const Vector6d e1 = HandError(tick.picture.X_WG, tick.picture.X_WH);
  return promise.scale * (now.kinetic + now.weight + passive.Energy(now.q)) + law.StoredEnergy(e1) -
         Channel(tick, unpaid_channel);
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

/// The wrenches are those of the step that led here: in the paper's way at this pose, with the
/// virtual coupling at that where the step began.
void RecordingAudit::Parts::JudgeLinks(const TickRecord& tick) {
  const TickPicture& picture = tick.picture;
  balance.TakeJoints(promise.paper ? now : before, picture.joints, picture.v);
  if (promise.paper && !own.IsOfNearestPose(tick, kExact)) {
    ++bounded_ticks;
  } else {
    free.Add(balance.along(), ticks);
  }
  if (!links_are_judged()) return;
  if (promise.paper) return newton.Add(balance.OffAt(now, held.grasp.node), ticks);
  for (size_t i = 0; i < hands.size(); ++i) {
    balance.TakeHand(hands[i].grasp.node, hands[i].X_WG_before.p,
                     picture.hand(static_cast<int>(i)).dynamic);
  }
  const double off = balance.OffInStep(before, now);
  if (Pays(tick)) {
    ++paid_ticks;
  } else {
    newton.Add(off, ticks);
  }
}

/// The virtual coupling pulls at the grasp, in a step with the wrench of its end. In the paper's
/// way w_d is felt at the hand beside the grasp, and its work there is what the mechanism gets: by
/// the mean of w_d at both ends of the way.
void RecordingAudit::Parts::Balance(const TickRecord& tick) {
  TracedStep step;
  for (size_t i = 0; i < hands.size(); ++i) {
    const HandPicture& picture = tick.picture.hand(static_cast<int>(i));
    const double work = promise.paper
                            ? 0.5 * (hands[i].dynamic_before + picture.dynamic)
                                        .dot(HandError(hands[i].X_WH_before, picture.X_WH))
                            : picture.dynamic.dot(HandError(hands[i].X_WG_before, picture.X_WG));
    step.hand += work;
    step.throughput += std::abs(work);
  }
  step.joints = -balance.joint_work();
  step.corrected = balance.corrected();
  step.moved = balance.moved();
  step.constraint = balance.constraint_work();
  step.paid = Pays(tick);
  step.faithful = own_before && own.IsOfNearestPose(tick, kExact);
  trace.Add(before, now, step);
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
  return parts_->trace.balance();
}

double RecordingAudit::closure() const {
  return parts_->before.closure;
}

AuditReport RecordingAudit::Report() const {
  const Parts& p = *parts_;
  AuditReport report;
  report.ticks = p.ticks;
  report.energy = p.trace.balance();
  report.findings = {p.loops, p.hand, p.free, p.sent};
  if (p.held.regrasps) {
    report.left_out = "grasp frame, stored energy, links and energy: the hand takes hold anew";
    return report;
  }
  report.findings.push_back(p.grasp);
  if (p.promise.known) {
    report.findings.push_back(p.wanted);
  } else {
    report.left_out = "stored energy and wanted wrench: the recording does not say what was felt";
  }
  if (p.promise.known && (!p.promise.paper || p.unpaid_channel >= 0)) {
    report.findings.push_back(p.stored);
  }
  if (!p.links_are_judged()) {
    report.left_out =
        "links and energy: accelerations come of an estimator whose state is not recorded";
    return report;
  }
  report.findings.push_back(p.newton);
  if (p.as_printed) {
    report.left_out = "energy: eq. (14) as printed leaves work to what closes the loops";
    return report;
  }
  if (p.bounded_ticks > 0) {
    report.left_out = fmt::format(
        "constraints along free motions in {} ticks in which the pose was not the nearest to the "
        "hand, or the hand's wrench kept within bounds",
        p.bounded_ticks);
  }
  if (p.paid_ticks > 0) {
    report.left_out = fmt::format(
        "links and energy in {} ticks in which the mechanism may have paid what no hand gave",
        p.paid_ticks);
  }
  const EnergyBalance& energy = report.energy;
  const double size = std::max(energy.throughput, kLeastWork);
  report.findings.push_back({"energy that is not traced, share of the hand's work",
                             energy.untraced_most / size, energy.untraced_bound / size, "-",
                             p.ticks});
  return report;
}

}  // namespace vmech
