#include "vmech/hw_interface/rendering/coupled_tick.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

constexpr int kHandChannels = 3;

double DistanceToLine(const Vector3d& p, const Vector3d& from, const Vector3d& to) {
  const Vector3d way = to - from;
  const double length2 = way.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - from).dot(way) / length2, 0.0, 1.0) : 0;
  return (p - from - share * way).norm();
}

/// From a point in the link's drawing frame to the lines between its anchors.
double DistanceToLink(const Link& link, const Vector3d& p) {
  double distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < link.anchors.size(); ++i) {
    for (size_t j = 0; j <= i; ++j) {
      const Vector3d &from = link.anchors[i].X_LA.p, &to = link.anchors[j].X_LA.p;
      distance = std::min(distance, DistanceToLine(p, from, to));
    }
  }
  return distance;
}

std::vector<CoupledGrasp> GraspsOf(const KinematicTree& tree, std::span<const CoupledHand> hands,
                                   const CoupledTickOptions& options) {
  options.Validate();
  std::vector<CoupledGrasp> grasps;
  for (const CoupledHand& hand : hands) {
    grasps.push_back(
        {GraspFrameOf(tree, hand.grasp), AtTheMechanism(hand.coupling, options.scale)});
  }
  return grasps;
}

}  // namespace

HandCoupling AtTheMechanism(HandCoupling coupling, double scale) {
  coupling.stiffness /= scale;
  coupling.damping /= scale;
  coupling.max_force /= scale;
  coupling.max_moment /= scale;
  return coupling;
}

void CoupledTickOptions::Validate() const {
  CheckRange("CoupledTickOptions", "scale", scale, 1e-6, 1e3);
  CheckRange("CoupledTickOptions", "grasp_rate", grasp_rate, 10, 1e6);
  CheckRange("CoupledTickOptions", "smoothing", smoothing, 0, 0.1);
}

CoupledTick::CoupledTick(const KinematicTree& tree, int grasp, const VectorXd& q, double period,
                         const CoupledTickOptions& options)
    : CoupledTick(tree, std::array{CoupledHand{grasp, options.coupling}}, q, period, options) {}

CoupledTick::CoupledTick(const KinematicTree& tree, std::span<const CoupledHand> hands,
                         const VectorXd& q, double period, const CoupledTickOptions& options)
    : tree_(tree),
      options_(options),
      dynamics_(tree, GraspsOf(tree, hands, options), period, q),
      period_(period),
      shares_(static_cast<int>(hands.size())),
      paid_(hands.size()),
      weights_(hands.size()),
      frames_(hands.size()),
      peaks_(tree.mechanism) {
  for (const CoupledGrasp& grasp : GraspsOf(tree, hands, options)) {
    hands_.push_back(
        {grasp.frame, ClosingHand(grasp.coupling, options.grasp_rate / options.scale, period), {}});
  }
}

std::vector<std::string> CoupledTick::ChannelNames() const {
  std::vector<std::string> names{"off_position", "off_rotation", "coupling_force"};
  for (int i = 1; i < hands(); ++i) {
    for (int k = 0; k < kHandChannels; ++k) names.push_back(fmt::format("{}_{}", names[k], i + 1));
  }
  names.emplace_back("state");
  names.emplace_back("remembered_losses");
  peaks_.AppendNames(&names);
  return names;
}

/// A bit each for slipping, standing at a limit and stopping, as Account sets them.
std::vector<std::string> CoupledTick::StateNames() const {
  return {"moves",   "slips",          "at limit",          "slips at limit",
          "stopped", "slips; stopped", "at limit; stopped", "slips at limit; stopped"};
}

bool CoupledTick::HandGraspsAt(int hand, const Posed& X_WH) noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  vmech::GraspFrame grasp = hands_[hand].named;
  for (size_t l = 0; l < tree_.mechanism.links.size(); ++l) {
    const int node = tree_.NodeOfLink(static_cast<int>(l));
    if (node < 0) continue;
    const Posed X_WB = dynamics_.pose().X_WB(node);
    const Posed X_BH = X_WB.inverse() * X_WH;
    const Posed X_BL = tree_.X_node_link(static_cast<int>(l));
    const double distance = DistanceToLink(tree_.mechanism.links[l], X_BL.inverse() * X_BH.p);
    if (distance >= nearest) continue;
    nearest = distance;
    grasp.node = node;
    grasp.X_BG = X_BH;
  }
  dynamics_.GraspAt(grasp, hand);
  hands_[hand].closing.Open();
  hands_[hand].holds = true;
  return true;
}

void CoupledTick::Reset() noexcept {
  for (int i = 0; i < hands(); ++i) {
    Hand& hand = hands_[i];
    dynamics_.GraspAt(hand.named, i);
    hand.closing.Hold();
    hand.holds = true;
    hand.at.V = {};
    hand.seen = false;
    hand.worked = 0;
  }
  dynamics_.Stop();
  shares_.Reset(EnergyOfHands());
  peaks_.Reset();
  summary_ = {};
}

TickOutput CoupledTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  TickOutput out;
  StepHands({&input, 1}, {&out, 1}, channels);
  return out;
}

void CoupledTick::StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                            std::span<double> channels) noexcept {
  for (int i = 0; i < hands(); ++i) TakeHand(inputs[i], i);
  const CoupledStatus status = Move();
  for (TickOutput& out : outputs) {
    out = {};
    if (status == CoupledStatus::kFailed) out.status = TickStatus::kFailed;
    if (status == CoupledStatus::kStopped) out.status = TickStatus::kHeld;
  }
  if (status == CoupledStatus::kFailed) return;
  ShareEnergy(inputs);
  for (int i = 0; i < hands(); ++i) {
    outputs[i].F_Ho_W = Vector6Of(-options_.scale * dynamics_.pull(i));
    outputs[i].stored_energy = StoredEnergy(inputs[i].held, i);
  }
  Account(status, channels);
}

/// The coupling carries what moves the mechanism and what it does not allow in one.
void CoupledTick::Show(TickPicture* picture) const noexcept {
  picture->q = dynamics_.q();
  picture->v = dynamics_.v();
  picture->joints = dynamics_.joints();
  for (int i = 0; i < hands(); ++i) {
    HandPicture& hand = picture->hand(i);
    hand.X_WH = PoseOf(hands_[i].at.X);
    hand.X_WG = dynamics_.X_WG(i);
    hand.dynamic = dynamics_.w(i);
  }
}

DesignStatus CoupledTick::ChangeDesign(const HeldDesign& from, const HeldDesign& to,
                                       const WrenchLimit& most) noexcept {
  const DesignStatus status = dynamics_.ChangeDesign(from, to, most.Times(1 / options_.scale));
  if (status != DesignStatus::kTaken) return status;
  for (int i = 0; i < hands(); ++i) hands_[i].named = to.grasps[static_cast<size_t>(i)];
  return status;
}

/// Where the hand is, what its device can do, and whether it holds.
void CoupledTick::TakeHand(const TickInput& input, int i) noexcept {
  Hand& hand = hands_[i];
  const bool sees = input.fresh || input.observed != nullptr;
  if (sees || (input.held && !hand.seen)) ReadHand(input, &hand);
  if (!sees && !input.held) hand.at.V = {};
  dynamics_.Within(input.room.Times(1 / options_.scale), i);
  if (input.debt > 0) dynamics_.Owe(input.debt / options_.scale);
  if (input.held == hand.holds) return;
  hand.holds = input.held;
  if (input.held) {  // it comes while others move the mechanism, and closes on its grasp frame
    dynamics_.GraspAt(hand.named, i);
    hand.closing.Open();
  } else {
    dynamics_.Loosen(options_.grasp_rate / options_.scale, i);
  }
}

CoupledStatus CoupledTick::Move() noexcept {
  for (int i = 0; i < hands(); ++i) {
    Hand& hand = hands_[i];
    if (hand.holds && hand.closing.closing()) {
      hand.closing.BeforeStep(PoseOf(hand.at.X), Vector6Of(hand.at.V), i, &dynamics_);
    } else {
      dynamics_.SetHand(hand.at, i);
    }
    frames_[i] = dynamics_.pose().grasp_frame(i);
  }
  const CoupledStatus status = dynamics_.Step();
  for (int i = 0; i < hands(); ++i) {
    Hand& hand = hands_[i];
    if (hand.holds && hand.closing.closing()) hand.closing.AfterStep(status, i, &dynamics_);
  }
  return status;
}

/// What the mechanism loses is taken from the hands whose debts it pays, else from all that hold.
void CoupledTick::ShareEnergy(std::span<const TickInput> inputs) noexcept {
  double debts = 0;
  for (const TickInput& input : inputs) debts += input.debt;
  for (int i = 0; i < hands(); ++i) {
    Hand& hand = hands_[i];
    if (hands() > 1) {
      const Screw way = HandError(frames_[i], dynamics_.pose().grasp_frame(i));
      hand.worked += Power(dynamics_.pull(i), way);
    }
    paid_[i] = dynamics_.CouplingEnergy(i) + hand.worked;
    const double weight = debts > 0 ? inputs[i].debt : 1;
    weights_[i] = hand.holds ? weight : 0;
  }
  shares_.Update(EnergyOfHands(), paid_, weights_);
}

/// What the mechanism does without a hand is no business of its.
double CoupledTick::StoredEnergy(bool held, int i) noexcept {
  Hand& hand = hands_[i];
  if (held) {
    hand.stored = shares_[i];
    hand.paid_when_held = paid_[i];
  }
  return options_.scale * (hand.stored + (paid_[i] - hand.paid_when_held));
}

void CoupledTick::Account(CoupledStatus status, std::span<double> channels) noexcept {
  for (int i = 0; i < hands(); ++i) {
    const std::span<double> own = channels.subspan(i * kHandChannels, kHandChannels);
    own[0] = Length(dynamics_.stretch(i).linear);
    own[1] = Length(dynamics_.stretch(i).angular);
    own[2] = Length(dynamics_.pull(i).linear);
    if (hands_[i].holds) summary_.farthest = std::max(summary_.farthest, own[0]);
  }
  const std::span<double> rest = channels.subspan(hands() * kHandChannels);
  rest[0] = static_cast<double>(dynamics_.slipping() + 2 * dynamics_.at_limit() +
                                4 * (status == CoupledStatus::kStopped));
  rest[1] = options_.scale * dynamics_.RememberedLosses();
  peaks_.Add(dynamics_.joints(), rest.subspan(2));
  ++summary_.ticks;
  summary_.at_limit += dynamics_.at_limit();
  summary_.slipping += dynamics_.slipping();
  summary_.stopped += status == CoupledStatus::kStopped;
  if (status == CoupledStatus::kMoved) {
    summary_.worst_closure = std::max(summary_.worst_closure, dynamics_.closure());
  }
}

std::string CoupledSummary::BriefReport() const {
  return fmt::format(
      "{} ticks: {} with a joint at its limit, {} with the coupling at its largest, {} stopped "
      "before open loops; hand at most {:.2g} mm off; loops closed to {:.2g}",
      ticks, at_limit, slipping, stopped, 1e3 * farthest, worst_closure);
}

std::string CoupledTick::FullReport() const {
  return "  " + summary_.BriefReport() + "\n" + peaks_.Report();
}

/// As observed, or differences through a filter of first order.
void CoupledTick::ReadHand(const TickInput& input, Hand* hand) noexcept {
  if (input.observed) {
    hand->at = *input.observed;
    hand->seen = true;
    return;
  }
  const Frame X = FrameOf(input.X_WH);
  if (hand->seen) {
    const double elapsed = std::max(input.elapsed, period_);
    const double share = options_.smoothing > 0 ? 1 - std::exp(-elapsed / options_.smoothing) : 1;
    hand->at.V += share * ((1 / elapsed) * HandError(hand->at.X, X) - hand->at.V);
  }
  hand->at.X = X;
  hand->seen = true;
}

}  // namespace vmech
