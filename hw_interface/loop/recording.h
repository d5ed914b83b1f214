#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

inline constexpr int kMaxChannels = 32;

/// Everything about one tick of a haptic loop. Fixed size: a loop keeps them without allocation.
struct TickRecord {
  MasterState state;
  Vector6d wanted_F_Ho_D = Vector6d::Zero();  ///< of the virtual mechanism
  Vector6d sent_F_Ho_D = Vector6d::Zero();    ///< after the safety filter
  IoStatus io = IoStatus::kOk;
  ForceOff off = ForceOff::kNotActive;
  std::uint32_t stages = 0;                     ///< bits of SafetyStage
  double energy = 0;                            ///< the passivity observer's [J]
  std::int32_t late_ns = 0;                     ///< wake-up after its time
  std::int32_t compute_ns = 0;                  ///< from the wake-up to the command's write
  std::int32_t skipped = 0;                     ///< slots missed before this tick
  std::array<double, kMaxChannels> channels{};  ///< of the tick, named in the recording
};

/// What a session was made of, in words without spaces as keys: mechanism, grasp, ...
using RecordingNotes = std::vector<std::pair<std::string, std::string>>;

/// A recorded session.
struct Recording {
  std::string device;
  double period = 1e-3;               ///< [s]
  std::vector<std::string> channels;  ///< names of the first channels, at most kMaxChannels
  std::vector<TickRecord> ticks;
  double delay = 0;               ///< of the device [s]
  HandlePhysics linear, angular;  ///< of the device
  RecordingNotes notes;

  /// Of the first note with the wanted key; empty if there is none.
  std::string Note(std::string_view wanted) const;
};

/// A table in CSV: comment lines "# vmech recording 1", "# device ...", "# period ..." and, where
/// they are known, "# delay ...", "# linear ..." and "# angular ..." (the fields of HandlePhysics)
/// and "# note KEY ..."; a line of column names, a line per tick; SI units, numbers in the fewest
/// digits that give them back exactly. The handle's orientation is a unit quaternion w, x, y, z.
/// @throws std::runtime_error if the file cannot be written.
void WriteRecording(const std::filesystem::path& file, const Recording& recording);

/// @throws std::runtime_error with file:line, what is wrong there and what was expected.
Recording ReadRecording(const std::filesystem::path& file);

}  // namespace vmech
