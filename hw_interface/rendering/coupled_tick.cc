#include "vmech/hw_interface/rendering/coupled_tick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

constexpr int kOwnChannels = 4;
constexpr double kFade = 0.02;  // [s]: of the end of the wrench on a hand that has let go

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

HandCoupling AtTheMechanism(const CoupledTickOptions& options) {
  options.Validate();
  HandCoupling coupling = options.coupling;
  coupling.stiffness /= options.scale;
  coupling.damping /= options.scale;
  coupling.max_force /= options.scale;
  coupling.max_moment /= options.scale;
  return coupling;
}

}  // namespace

void CoupledTickOptions::Validate() const {
  CheckRange("CoupledTickOptions", "scale", scale, 1e-6, 1e3);
  CheckRange("CoupledTickOptions", "grasp_rate", grasp_rate, 10, 1e6);
  CheckRange("CoupledTickOptions", "smoothing", smoothing, 0, 0.1);
}

CoupledTick::CoupledTick(const KinematicTree& tree, int grasp, const VectorXd& q, double period,
                         const CoupledTickOptions& options)
    : tree_(tree),
      options_(options),
      grasp_(GraspFrameOf(tree, grasp)),
      dynamics_(tree, grasp_, AtTheMechanism(options), period, q),
      period_(period),
      fade_(std::exp(-period / kFade)),
      compliance_(ScrewOf((options.coupling.stiffness.array() > 0)
                              .select(options.coupling.stiffness.cwiseInverse(), 0))),
      closing_(AtTheMechanism(options), options.grasp_rate / options.scale, period),
      peaks_(tree.mechanism) {}

std::vector<std::string> CoupledTick::ChannelNames() const {
  std::vector<std::string> names{"off_position", "off_rotation", "coupling_force", "state"};
  peaks_.AppendNames(&names);
  return names;
}

bool CoupledTick::GraspAt(const Posed& X_WH) noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  vmech::GraspFrame grasp = grasp_;
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
  dynamics_.GraspAt(grasp);
  closing_.Open();
  fading_ += felt_;
  felt_ = {};
  holds_ = true;
  return true;
}

void CoupledTick::Reset() noexcept {
  dynamics_.GraspAt(grasp_);
  dynamics_.Stop();
  closing_.Hold();
  holds_ = true;
  felt_ = fading_ = hand_.V = {};
  has_hand_ = false;
  peaks_.Reset();
  summary_ = {};
}

TickOutput CoupledTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  if (input.fresh || input.observed || !has_hand_) ReadHand(input);
  dynamics_.Within(input.room.Times(1 / options_.scale));
  if (input.debt > 0) dynamics_.Owe(input.debt / options_.scale);
  const CoupledStatus status = Move(input);
  TickOutput out;
  if (status == CoupledStatus::kFailed) {
    out.status = TickStatus::kFailed;
    return out;
  }
  out.status = status == CoupledStatus::kStopped ? TickStatus::kHeld : TickStatus::kOk;
  Feel(input.held);
  out.F_Ho_W = Vector6Of(felt_ + fading_);
  // What the mechanism does alone is no business of the hand's.
  out.stored_energy = stored_ + FadingEnergy();
  Account(status, channels);
  return out;
}

/// The coupling carries what moves the mechanism and what it does not allow in one.
void CoupledTick::Show(TickPicture* picture) const noexcept {
  picture->q = dynamics_.q();
  picture->joints = dynamics_.joints();
  picture->X_WH = PoseOf(hand_.X);
  picture->X_WG = dynamics_.X_WG();
  picture->dynamic = dynamics_.w();
}

CoupledStatus CoupledTick::Move(const TickInput& input) noexcept {
  if (!input.held && holds_) {
    dynamics_.LetGo();
    fading_ += felt_;
    felt_ = {};
    holds_ = false;
  }
  if (holds_ && closing_.closing()) {
    return closing_.Step(PoseOf(hand_.X), Vector6Of(hand_.V), &dynamics_);
  }
  return dynamics_.Step(hand_);
}

void CoupledTick::Feel(bool held) noexcept {
  Fade();
  if (held) {
    felt_ = -options_.scale * dynamics_.pull();
    stored_ = options_.scale * dynamics_.Energy();
  }
}

/// The wrench of a spring that nothing holds any more. It falls slowly; where it drives the hand it
/// falls with what that takes out of the spring,
///
///   E = F'K^-1 F / 2,   (1 + c)/2 F.dX <= (1 - c^2) E   by   c = 1 - F.dX/2E.
void CoupledTick::Fade() noexcept {
  if (Power(fading_, fading_) == 0) return;
  const double force = Length(fading_.linear), most = options_.grasp_rate * period_;
  double left = fade_;
  if (force * (1 - left) > most) left = 1 - most / force;
  const double energy = FadingEnergy(), work = period_ * Power(fading_, hand_.V);
  if (work > 0) left *= std::max(0.0, 1 - work / (2 * energy));
  fading_ = left * fading_;
}

double CoupledTick::FadingEnergy() const noexcept {
  return 0.5 * Power(fading_, Scaled(compliance_, fading_));
}

void CoupledTick::Account(CoupledStatus status, std::span<double> channels) noexcept {
  channels[0] = Length(dynamics_.stretch().linear);
  channels[1] = Length(dynamics_.stretch().angular);
  channels[2] = Length(dynamics_.pull().linear);
  channels[3] = static_cast<double>(dynamics_.slipping() + 2 * dynamics_.at_limit() +
                                    4 * (status == CoupledStatus::kStopped));
  peaks_.Add(dynamics_.joints(), channels.subspan(kOwnChannels));
  ++summary_.ticks;
  summary_.at_limit += dynamics_.at_limit();
  summary_.slipping += dynamics_.slipping();
  summary_.stopped += status == CoupledStatus::kStopped;
  if (status == CoupledStatus::kMoved) {
    summary_.worst_closure = std::max(summary_.worst_closure, dynamics_.closure());
  }
  summary_.farthest = std::max(summary_.farthest, channels[0]);
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
void CoupledTick::ReadHand(const TickInput& input) noexcept {
  if (input.observed) {
    hand_ = *input.observed;
    has_hand_ = true;
    return;
  }
  const Frame X = FrameOf(input.X_WH);
  if (has_hand_) {
    const double elapsed = std::max(input.elapsed, period_);
    const double share = options_.smoothing > 0 ? 1 - std::exp(-elapsed / options_.smoothing) : 1;
    hand_.V += share * ((1 / elapsed) * HandError(hand_.X, X) - hand_.V);
  }
  hand_.X = X;
  has_hand_ = true;
}

}  // namespace vmech
