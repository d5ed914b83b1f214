#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/hw_interface/rendering/registration.h"
#include "vmech/hw_interface/rendering/tick_picture.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

/// The hand as an observer knew it, in D.
struct RecordedHand {
  Posed X_DH;                        ///< the handle in the device
  Vector6d V_DH = Vector6d::Zero();  ///< [v; w] of Ho and H, axes of D

  static RecordedHand Of(const MovingFrame& hand_D) noexcept;  ///< as it is recorded
  MovingFrame Moving() const noexcept;                         ///< as ticks take it
};

/// A hand in one tick of a haptic loop.
struct HandRecord {
  MasterState state;                          ///< what the device sent
  Vector6d wanted_F_Ho_D = Vector6d::Zero();  ///< of the virtual mechanism
  Vector6d sent_F_Ho_D = Vector6d::Zero();    ///< after the safety filter
  IoStatus io = IoStatus::kOk;                ///< of reading it
  ForceOff off = ForceOff::kNotActive;        ///< why no force was sent
  std::uint32_t stages = 0;                   ///< bits of SafetyStage
  double energy = 0;                          ///< the passivity observer's [J]
  bool observed = false;                      ///< the tick went by `hand` in place of the sample
  RecordedHand hand;                          ///< of an observer
  Registration registration;                  ///< of the handle in the world
  WrenchLimit room;                           ///< what the device could exert at this posture
  double stored_energy = 0;  ///< that the virtual side says it has, see passivity.h [J]
};

/// Everything about one tick of a haptic loop; of several hands, the first is the record itself.
/// What has no fixed size is sized once, from then on a loop copies it without allocation.
struct TickRecord : HandRecord {
  std::int32_t late_ns = 0;        ///< wake-up after its time
  std::int32_t compute_ns = 0;     ///< from the wake-up to the command's write
  std::int32_t skipped = 0;        ///< slots missed before this tick
  TickPicture picture;             ///< the mechanism
  std::vector<double> channels;    ///< of the tick, named in the recording
  std::vector<HandRecord> others;  ///< hands beside the first

  /// Counted from 0, in [0, header.hands()).
  HandRecord& of_hand(int i) noexcept { return i == 0 ? *this : others[i - 1]; }
  /// Counted from 0, in [0, header.hands()).
  const HandRecord& of_hand(int i) const noexcept { return i == 0 ? *this : others[i - 1]; }
};

/// What a session was made of, in words without spaces as keys: mechanism, grasp, ...
using RecordingNotes = std::vector<std::pair<std::string, std::string>>;

/// The mechanism of a session, for those who read the recording alone.
struct RecordedMechanism {
  std::string text;  ///< a mechanism file (WriteMechanism); empty: not known
  // Names of its numbers in every tick; empty: they are numbered.
  std::vector<std::string> coordinates, velocities, joints;  ///< names of q [nq], v [nv], joints
};

/// The format that is written; format 1 is read too.
inline constexpr int kRecordingFormat = 2;

/// The device of a recorded hand.
struct RecordedDevice {
  std::string device;             ///< DeviceInfo::name
  double delay = 0;               ///< [s]
  HandlePhysics linear, angular;  ///< as DeviceInfo's
};

/// What a recording says of all of its ticks; of several hands, the device of the first is here.
struct RecordingHeader : RecordedDevice {
  double period = 1e-3;                ///< [s]
  std::vector<RecordedDevice> others;  ///< of hands beside the first
  std::vector<std::string> channels;   ///< names of a tick's
  RecordingNotes notes;                ///< of the session
  RecordedMechanism mechanism;         ///< empty in format 1
  std::vector<std::string> states;     ///< names of the values of the channel "state"; or none
  int format = kRecordingFormat;       ///< of the file that it was read from

  /// Of the first note with the wanted key; empty if there is none.
  std::string Note(std::string_view wanted) const;
  /// A note that is a number; a value of its own where there is none.
  double Number(std::string_view wanted, double otherwise) const;
  /// Where a tick has the channel of this name; -1: nowhere.
  int ChannelOf(std::string_view name) const;
  int hands() const { return static_cast<int>(others.size()) + 1; }  ///< at least 1
  /// The key of a note about a hand, counted from 0: "grasp", "grasp_2", ..
  static std::string KeyOf(std::string_view key, int hand);
  /// A record with everything sized as the names say.
  TickRecord EmptyTick() const;
};

/// A recorded session.
struct Recording : RecordingHeader {
  std::vector<TickRecord> ticks;  ///< in their order
  bool complete = true;           ///< false: it ends without its last line, as after a kill
  std::uint64_t lost = 0;         ///< ticks that are not in it, since the disk was too slow
};

}  // namespace vmech
