#include "vmech/hw_interface/loop/hand_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

std::unique_ptr<ArmTorques> MakeTorques(const HandLoopOptions& options, const DeviceInfo& info) {
  if (!options.joint_torques || !info.takes_torque || !info.arm) return nullptr;
  return std::make_unique<ArmTorques>(options.posture, info.arm, info.period,
                                      info.angular.resolution);
}

std::unique_ptr<HandObserver> MakeObserver(const HandLoopOptions& options, const DeviceInfo& info) {
  if (!options.uses_observed || options.observer.bandwidth == 0) return nullptr;
  if (!HandObserver::Suits(info)) return nullptr;
  return std::make_unique<HandObserver>(options.observer, info);
}

}  // namespace

HandLoop::HandLoop(const HandLoopOptions& options, Master* master)
    : options_(options),
      master_(master),
      period_(master->info().period),
      period_ns_(std::llround(period_ * 1e9)),
      safety_(options.safety, master->info()),
      torques_(MakeTorques(options, master->info())),
      observer_(MakeObserver(options, master->info())) {
  summary_.device = master->info().name;
}

void HandLoop::Read(std::int64_t slot_ns, bool emergency_stop, HandRecord* record) noexcept {
  record->io = lost() ? IoStatus::kLinkLost : master_->Read(slot_ns, &state_);
  if (emergency_stop) state_.emergency_stop = true;
  fresh_ = record->io == IoStatus::kOk;
  if (fresh_) gap_ = missing_;
  missing_ = fresh_ ? 0 : missing_ + 1;
  summary_.missed += fresh_ ? 0 : 1;
  record->state = state_;
  record->wanted_F_Ho_D.setZero();
  record->observed = false;
  record->room = {};
  record->stored_energy = 0;
}

/// Puts the hand where the grasp frame is.
void HandLoop::Register(const Posed& X_WG) noexcept {
  registration_ = GraspedAt(options_.R_WD, state_.X_DH, X_WG);
  if (torques_) torques_->Reset();
  if (observer_) observer_->Reset();
  holds_ = !options_.gripper;
  summary_.grasps += holds_;
  last_sample_ = state_;
  registered_ = true;
}

TickInput HandLoop::Absent() noexcept {
  TickInput input;
  input.state = &state_;
  input.held = false;
  return input;
}

TickInput HandLoop::Prepare(int hand, Tick* tick, HandRecord* record) noexcept VMECH_NONBLOCKING {
  const Matrix3d& R_WD = registration_.X_WD.R;
  const Vector6d F_Ho_D = safety_.WrenchCharged(state_);
  charged_ = Stacked<double>(R_WD * F_Ho_D.head<3>(), R_WD * F_Ho_D.tail<3>());
  if (fresh_) {
    if (gap_ > options_.safety.hold_periods) TakeUpAgain(tick->HeldFrame(hand));
    Observe();
    GraspOrLetGo(hand, tick);
  }
  TickInput input;
  input.held = holds_;
  input.fresh = fresh_;
  input.elapsed = fresh_ ? PeriodsBetween(last_sample_, state_, period_) * period_ : 0;
  input.state = &state_;
  record->room = input.room = torques_ ? torques_->room() : master_->Room();
  input.debt = safety_.Debt();
  input.charged_F_Ho_W = &charged_;
  if (const std::optional<MovingFrame> at = ObservedHand()) {
    record->observed = true;
    record->hand = RecordedHand::Of(*at);
    registration_.TakeHandInWorld(*at, &observed_);
    input.observed = &observed_;
  } else {
    input.X_WH = registration_.HandInWorld(state_.X_DH);
  }
  if (fresh_) last_sample_ = state_;
  return input;
}

void HandLoop::Take(const TickOutput& wanted, HandPicture* picture,
                    HandRecord* record) const noexcept {
  const Matrix3d R_DW = registration_.X_WD.R.transpose();
  record->wanted_F_Ho_D << R_DW * wanted.F_Ho_W.head<3>(), R_DW * wanted.F_Ho_W.tail<3>();
  if (wanted.status == TickStatus::kFailed) record->wanted_F_Ho_D.setZero();
  record->registration = registration_;
  record->stored_energy = wanted.stored_energy;
  picture->holds = holds_ && !lost();
  picture->F_Ho_W = wanted.F_Ho_W;
}

/// By the observer here, or by the one that was at work when the session was recorded. Where
/// samples are missing, the hand goes on as it did, for a few periods.
std::optional<MovingFrame> HandLoop::ObservedHand() const noexcept {
  if (!observer_) {
    const MovingFrame* hand = options_.uses_observed ? master_->ObservedHand() : nullptr;
    return hand != nullptr ? std::optional(*hand) : std::nullopt;
  }
  MovingFrame hand = observer_->hand_D();
  const int ahead = std::min(missing_, options_.safety.hold_periods);
  if (ahead > 0) hand.X = Displaced(hand.X, (ahead * period_) * hand.V);
  return hand;
}

void HandLoop::Observe() noexcept {
  if (!observer_) return;
  const auto periods = std::lround(PeriodsBetween(last_sample_, state_, period_));
  observer_->Update(state_, safety_.WrenchAtWork(state_), static_cast<int>(periods));
}

/// After a gap for which there was no force: the hand, wherever it has gone, has hold of the grasp
/// frame where that is.
void HandLoop::TakeUpAgain(const Posed& X_WG) noexcept {
  if (observer_) observer_->Reset();
  registration_ = GraspedAt(options_.R_WD, state_.X_DH, X_WG);
}

/// With a dead zone between closed and open.
bool HandLoop::GripperCloses() const noexcept {
  if (!options_.gripper || !(state_.valid & kSensesGripper)) return true;
  constexpr double kClosed = 0.1, kOpen = 0.2;  // [rad]
  return state_.gripper_opening < (holds_ ? kOpen : kClosed);
}

void HandLoop::GraspOrLetGo(int hand, Tick* tick) noexcept {
  const bool closes = GripperCloses();
  if (closes == holds_) return;
  holds_ = closes;
  safety_.ForgetStoredEnergy();
  if (!closes) return;
  ++summary_.grasps;
  const std::optional<MovingFrame> observed = ObservedHand();
  const Posed X_DH = observed ? PoseOf(observed->X) : state_.X_DH;
  if (!tick->HandGraspsAt(hand, registration_.HandInWorld(X_DH))) {
    safety_.Restart();
    registration_ = GraspedAt(options_.R_WD, state_.X_DH, tick->HeldFrame(hand));
    tick->Reset();
  }
}

void HandLoop::Send(std::int64_t slot_ns, double stored_energy, HandRecord* record) noexcept {
  const SafetyOutput safe =
      safety_.Apply({master_->lifecycle(), record->io, &state_, record->wanted_F_Ho_D,
                     stored_energy, torques_ ? torques_->room() : WrenchLimit{}});
  MasterCommand command;
  command.sequence = safe.sequence;
  command.valid_until_ns = slot_ns + options_.command_life * period_ns_;
  command.F_Ho_D = safe.F_Ho_D;
  if (safe.off == ForceOff::kNone) {
    if (torques_) {
      command.mode = CommandMode::kJointTorque;
      torques_->Resolve(state_, fresh_, &command);
    } else if (master_->info().takes_wrench) {
      command.mode = CommandMode::kWrench;
    }
  }
  // A write that does not arrive shows as a lost link in the next read.
  (void)master_->Write(command);
  record->sent_F_Ho_D = safe.F_Ho_D;
  record->off = safe.off;
  record->stages = safe.stages;
  record->energy = safe.energy;
  summary_.peak_force = std::max(summary_.peak_force, safe.F_Ho_D.head<3>().norm());
  summary_.peak_moment = std::max(summary_.peak_moment, safe.F_Ho_D.tail<3>().norm());
  summary_.least_energy = std::min(summary_.least_energy, safe.energy);
}

HandSummary HandLoop::Summary() const {
  HandSummary summary = summary_;
  summary.safety = safety_.counters();
  summary.cause = safety_.latched();
  return summary;
}

}  // namespace vmech
