#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vmech/base/pose.h"

namespace vmech {

/// The JSON of Haply's Inverse Service: one state in answer to each message
/// [docs.haply.co/inverseSDK, versions 3.0 to 3.5].

/// An Inverse3 as the service's first message shows it.
struct HaplyDevice {
  std::string id;  ///< by which commands address it
  /// Under which name a command takes its vector: "vector" since 3.5, whose first message has a
  /// session, and "values" before.
  std::string vector_key = "values";
  bool calibrated = true;    ///< the service has found its zero
  bool tells_force = false;  ///< the force at work is in its states
  bool has_grip = false;     ///< a VerseGrip, wired or wireless, with orientation and buttons
};

/// The first Inverse3 of the message; none if there is no Inverse3. @throws std::runtime_error if
/// it is no message of the service.
std::optional<HaplyDevice> ReadHaplyDevice(std::string_view message);

/// What a state tells of a device; what it does not tell is absent. SI, axes of the device.
struct HaplySample {
  std::optional<Vector3d> position, velocity, force;  ///< of the handle [m], [m/s], [N]
  std::optional<Eigen::Quaterniond> orientation;      ///< of the grip, of unit length
  std::uint32_t buttons = 0;                          ///< bit by bit in the order of their names
};

/// None if the message is no JSON, or has nothing of this device.
std::optional<HaplySample> ReadHaplyState(std::string_view message, const std::string& id);

/// The message that asks for a force [N] at the cursor and for a state.
std::string HaplyForceCommand(const HaplyDevice& device, const Vector3d& force);

}  // namespace vmech
