#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vmech/base/nonblocking.h"
#include "vmech/hw_interface/estimation/hand_observer.h"
#include "vmech/hw_interface/loop/arm_torques.h"
#include "vmech/hw_interface/masters/operator_model.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/hw_interface/rendering/registration.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

enum class Architecture {
  kCoupled,  ///< CoupledTick
  kPaper,    ///< MechanismTick
};

/// As `vmech haptic` chooses it for the device, and the safety that goes with it.
std::unique_ptr<Tick> ChosenTick(const KinematicTree& tree, int grasp, const DeviceInfo& device,
                                 Architecture architecture, SafetyOptions* safety);

/// An operator who wanders a few centimetres about the handle's start.
HandMotion WanderingHand();

/// A mechanism of the examples in the hand of an operator who wanders a few centimetres at a
/// simulated 7-joint arm with 16-bit encoders: the tick on the samples of that arm, whose own
/// simulation costs nothing here. The hand goes its way whatever the mechanism allows, so that it
/// pulls on the constraints all the time.
class HeldTick {
 public:
  HeldTick(const std::string& example, Architecture architecture);

  /// All that a runner does between a sample and the torques: observer, mechanism, safety filter,
  /// arm.
  void Full() noexcept VMECH_NONBLOCKING;
  // Its stages, each on the next sample.
  void Observe();
  void Step();
  void Filter();
  void Resolve();

  /// Why the safety filter lets no force through, if it does not.
  ForceOff force_off() const { return force_off_; }

 private:
  /// To and fro over the samples, with sequence numbers that go on.
  const MasterState& NextSample();
  void ObserveOn(const MasterState& state);
  void StepOn(const MasterState& state);
  void FilterOf(const MasterState& state);

  DeviceInfo device_;
  std::vector<MasterState> samples_;
  size_t next_ = 0;
  bool forward_ = true;
  std::uint64_t sequence_ = 0;
  std::unique_ptr<KinematicTree> tree_;
  std::unique_ptr<HandObserver> observer_;
  std::unique_ptr<Tick> tick_;
  std::unique_ptr<SafetyFilter> safety_;
  std::unique_ptr<ArmTorques> torques_;
  Registration registration_;
  MovingFrame observed_;
  std::vector<MovingFrame> hands_;  // of the samples, on the way there
  TickOutput wanted_;
  MasterCommand command_;
  ForceOff force_off_ = ForceOff::kNone;
  std::vector<double> channels_;
};

}  // namespace vmech
