#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/base/screw.h"
#include "vmech/dynamics/in_hand/wrench_limit.h"
#include "vmech/hw_interface/masters/master.h"
#include "vmech/hw_interface/rendering/tick_picture.h"

namespace vmech {

/// The most channels that a tick may write.
inline constexpr int kMaxChannels = 32;

/// What a tick is given.
struct TickInput {
  Posed X_WH;             ///< the hand, as measured; not set where an observer knows it
  bool fresh = false;     ///< false: no new sample, the pose is that of the last tick
  double elapsed = 0;     ///< since the last fresh sample; a whole number of periods [s]
  bool held = true;       ///< false: the hand has let go, nothing is felt
  WrenchLimit room = {};  ///< what the device can exert at this posture
  /// Energy that the mechanism got and the hand has not given, as far as it is no error of
  /// measurement; for ticks whose mechanism moves by itself [J].
  double debt = 0;
  const MasterState* state = nullptr;  ///< the whole sample; null: there is none
  /// The hand in a fresh sample as an observer knows it (HandObserver); null: nobody observes it.
  /// For ticks that take it (UsesObservedHand) alone.
  const MovingFrame* observed = nullptr;
  /// What the hand was charged for until this sample, about Ho, axes of W (SafetyFilter): less than
  /// what the tick wanted where that was more than the device can exert. Null: all of it.
  const Vector6d* charged_F_Ho_W = nullptr;
};

/// What came of a tick.
enum class TickStatus : std::uint8_t {
  kOk,
  kHeld,    ///< no pose was found for this hand; the last good one stays, and the wrench is sound
  kFailed,  ///< no sound wrench: the loop stops
};

/// What a tick answers.
struct TickOutput {
  TickStatus status = TickStatus::kOk;  ///< whether F_Ho_W is to be felt
  Vector6d F_Ho_W = Vector6d::Zero();   ///< what the hand is to feel, about Ho, axes of W
  double stored_energy = 0;             ///< of the virtual mechanism, see passivity.h [J]
};

/// The virtual side: from the hand to what it feels, once per sample. Implementations allocate in
/// their constructors only.
class Tick {
 public:
  virtual ~Tick() = default;
  /// Names of what Step writes into `channels`, at most kMaxChannels.
  virtual std::vector<std::string> ChannelNames() const = 0;
  /// What the numbers 0, 1, .. of the channel "state" mean; empty: there is no such channel.
  virtual std::vector<std::string> StateNames() const { return {}; }
  /// Where the hand takes hold: the grasp frame now.
  virtual Posed GraspFrame() const noexcept = 0;
  /// The hand closes at X_WH: takes hold of what is nearest there, without a jump. False: that is
  /// not possible, the hand has to be brought to the grasp frame.
  virtual bool GraspAt(const Posed& X_WH) noexcept {
    (void)X_WH;
    return false;
  }
  /// Forgets velocities: the hand takes hold anew.
  virtual void Reset() noexcept = 0;
  /// Does it go by TickInput::observed where there is one?
  virtual bool UsesObservedHand() const noexcept { return false; }
  /// `channels` has as many entries as there are names.
  [[nodiscard]] virtual TickOutput Step(const TickInput& input,
                                        std::span<double> channels) noexcept = 0;
  /// Fills a picture that has its sizes: q [nq] and joints. Nothing by default.
  virtual void Show(TickPicture* picture) const noexcept { (void)picture; }

  // A mechanism in several hands at once; by default there is one, and the functions above are its.
  /// How many hands hold the mechanism; below, `hand` is counted from 0.
  virtual int hands() const noexcept { return 1; }
  /// X_WG of a hand, counted from 0.
  virtual Posed HeldFrame(int hand) const noexcept {
    (void)hand;
    return GraspFrame();
  }
  /// GraspAt of a hand, counted from 0.
  virtual bool HandGraspsAt(int hand, const Posed& X_WH) noexcept {
    (void)hand;
    return GraspAt(X_WH);
  }
  /// An input and an output for each hand. One that has not come yet, or is lost, does not hold.
  virtual void StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                         std::span<double> channels) noexcept {
    outputs[0] = Step(inputs[0], channels);
  }

  /// What became of the mechanism, in lines; nothing by default.
  virtual std::string FullReport() const { return {}; }
};

}  // namespace vmech
