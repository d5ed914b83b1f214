#include "hw_interface/held_tick.h"

#include <utility>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/paper_choice.h"

namespace vmech {
namespace {

constexpr int kSamples = 2000;

/// What the hand does when the device exerts nothing.
std::vector<MasterState> Wandering(DeviceInfo* device) {
  SimulatedMasterOptions options;
  options.motion = WanderingHand();
  SimulatedMaster master(options);
  master.Configure();
  master.Activate();
  *device = master.info();
  std::vector<MasterState> samples(kSamples);
  for (int k = 0; k < kSamples; ++k) (void)master.Read(1'000'000LL * k, &samples[k]);
  return samples;
}

}  // namespace

HandMotion WanderingHand() {
  const ArmModel arm(std::make_shared<const ArmDescription>(SarcosMasterArm()));
  return Wander(arm.X_DH(), 0.04, 0.15, 2);
}

std::unique_ptr<Tick> ChosenTick(const KinematicTree& tree, int grasp, const DeviceInfo& device,
                                 Architecture architecture, SafetyOptions* safety) {
  const VectorXd q = ClosedStart(tree);
  if (architecture == Architecture::kPaper) {
    const PaperChoice choice = ChoosePaper({}, tree, grasp, q, device);
    *safety = choice.safety;
    return std::make_unique<MechanismTick>(tree, grasp, q, device, choice.tick);
  }
  CoupledTickOptions options;
  const CouplingChoice choice =
      ChooseCoupling(tree, GraspFrameOf(tree, grasp), q, device, options.smoothing);
  options.coupling = choice.coupling;
  options.scale = choice.scale;
  *safety = choice.Safety();
  return std::make_unique<CoupledTick>(tree, grasp, q, device.period, options);
}

HeldTick::HeldTick(const std::string& example, Architecture architecture)
    : samples_(Wandering(&device_)) {
  const Mechanism mechanism = Example(example);
  const int grasp = FindGrasp(mechanism, "handle");
  tree_ = std::make_unique<KinematicTree>(BuildKinematicTree(mechanism));
  observer_ = std::make_unique<HandObserver>(HandObserverOptions{}, device_);
  SafetyOptions safety;
  tick_ = ChosenTick(*tree_, grasp, device_, architecture, &safety);
  safety.soft_start = 0;
  safety.energy_trip = 100;  // the hand is stronger than any force
  safety_ = std::make_unique<SafetyFilter>(safety, device_);
  torques_ = std::make_unique<ArmTorques>(PostureOptions{}, device_.arm, device_.period,
                                          device_.angular.resolution);
  registration_ = GraspedAt(Matrix3d::Identity(), samples_[0].X_DH, tick_->GraspFrame());
  channels_.resize(tick_->ChannelNames().size());
  for (const MasterState& sample : samples_) {
    ObserveOn(sample);
    hands_.push_back(observed_);
  }
  observer_->Reset();
}

const MasterState& HeldTick::NextSample() {
  if (next_ == samples_.size() - 1) forward_ = false;
  if (next_ == 0) forward_ = true;
  next_ += forward_ ? 1 : -1;
  MasterState& sample = samples_[next_];
  sample.sequence = ++sequence_;
  sample.applied_F_Ho_D = command_.F_Ho_D;
  return sample;
}

void HeldTick::Full() noexcept VMECH_NONBLOCKING {
  const MasterState& state = NextSample();
  ObserveOn(state);
  StepOn(state);
  FilterOf(state);
  torques_->Resolve(state, true, &command_);
}

void HeldTick::Observe() {
  ObserveOn(NextSample());
}

void HeldTick::Step() {
  const MasterState& state = NextSample();
  observed_ = hands_[next_];
  if (!forward_) {
    observed_.V.linear = -observed_.V.linear;
    observed_.V.angular = -observed_.V.angular;
  }
  StepOn(state);
}

void HeldTick::Filter() {
  FilterOf(NextSample());
}

void HeldTick::Resolve() {
  torques_->Resolve(NextSample(), true, &command_);
}

/// The hand of the samples goes its way whatever it feels: as if the arm exerted nothing.
void HeldTick::ObserveOn(const MasterState& state) {
  if (!tick_->UsesObservedHand()) return;
  observer_->Update(state, Vector6d::Zero(), 1);
  registration_.TakeHandInWorld(observer_->hand_D(), &observed_);
}

void HeldTick::StepOn(const MasterState& state) {
  TickInput input;
  input.fresh = true;
  input.elapsed = device_.period;
  input.state = &state;
  if (tick_->UsesObservedHand()) {
    input.observed = &observed_;
  } else {
    input.X_WH = registration_.HandInWorld(state.X_DH);
  }
  tick_->StepHands({&input, 1}, {&wanted_, 1}, channels_);
}

void HeldTick::FilterOf(const MasterState& state) {
  const SafetyOutput safe = safety_->Apply(
      {Lifecycle::kActive, IoStatus::kOk, &state, wanted_.F_Ho_W, wanted_.stored_energy});
  command_.F_Ho_D = safe.F_Ho_D;
  force_off_ = safe.off;
}

}  // namespace vmech
