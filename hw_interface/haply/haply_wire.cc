#include "vmech/hw_interface/haply/haply_wire.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace vmech {
namespace {

using Json = nlohmann::json;

/// A member of an object; null where there is none.
const Json& At(const Json& object, const char* key) {
  static const Json kNull;
  if (!object.is_object()) return kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

/// The first of a list; null where there is none.
const Json& FirstOf(const Json& list) {
  static const Json kNull;
  return list.is_array() && !list.empty() ? list.front() : kNull;
}

template <std::size_t n>
std::optional<std::array<double, n>> Numbers(const Json& object,
                                             const std::array<const char*, n>& keys) {
  std::array<double, n> numbers{};
  for (std::size_t i = 0; i < n; ++i) {
    const Json& value = At(object, keys[i]);
    if (!value.is_number()) return std::nullopt;
    numbers[i] = value.get<double>();
    if (!std::isfinite(numbers[i])) return std::nullopt;
  }
  return numbers;
}

std::optional<Vector3d> VectorOf(const Json& object) {
  const auto xyz = Numbers<3>(object, {"x", "y", "z"});
  if (!xyz) return std::nullopt;
  return Vector3d(xyz->data());
}

std::optional<Eigen::Quaterniond> OrientationOf(const Json& object) {
  const auto wxyz = Numbers<4>(object, {"w", "x", "y", "z"});
  if (!wxyz) return std::nullopt;
  const auto [w, x, y, z] = *wxyz;
  const Eigen::Quaterniond turn(w, x, y, z);
  constexpr double kOff = 0.01;  // of a length that was one before it was written in few digits
  if (std::abs(turn.norm() - 1) > kOff) return std::nullopt;
  return turn.normalized();
}

/// The state of the grip that is there.
const Json& GripState(const Json& message) {
  const Json& wireless = At(FirstOf(At(message, "wireless_verse_grip")), "state");
  return wireless.is_object() ? wireless : At(FirstOf(At(message, "verse_grip")), "state");
}

std::uint32_t ButtonsOf(const Json& grip) {
  std::uint32_t bits = At(grip, "button") == Json(true) ? 1 : 0;
  unsigned i = 0;
  for (const Json& pressed : At(grip, "buttons")) {
    if (pressed == Json(true)) bits |= 1u << (i % 32);
    ++i;
  }
  return bits;
}

}  // namespace

std::optional<HaplyDevice> ReadHaplyDevice(std::string_view message) {
  const Json json = Json::parse(message, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !At(json, "inverse3").is_array()) {
    throw std::runtime_error("its first message is no list of devices");
  }
  const Json& found = FirstOf(At(json, "inverse3"));
  if (!At(found, "device_id").is_string()) return std::nullopt;
  HaplyDevice device;
  device.id = At(found, "device_id").get<std::string>();
  if (json.contains("session_id")) device.vector_key = "vector";
  device.calibrated = At(At(found, "status"), "calibrated") != Json(false);
  device.tells_force = VectorOf(At(At(found, "state"), "current_cursor_force")).has_value();
  device.has_grip = GripState(json).is_object();
  return device;
}

std::optional<HaplySample> ReadHaplyState(std::string_view message, const std::string& id) {
  const Json json = Json::parse(message, nullptr, /*allow_exceptions=*/false);
  for (const Json& device : At(json, "inverse3")) {
    if (At(device, "device_id") != Json(id)) continue;
    const Json& state = At(device, "state");
    const Json& grip = GripState(json);
    return HaplySample{VectorOf(At(state, "cursor_position")),
                       VectorOf(At(state, "cursor_velocity")),
                       VectorOf(At(state, "current_cursor_force")),
                       OrientationOf(At(grip, "orientation")), ButtonsOf(grip)};
  }
  return std::nullopt;
}

std::string HaplyForceCommand(const HaplyDevice& device, const Vector3d& force) {
  const Json vector{{"x", force.x()}, {"y", force.y()}, {"z", force.z()}};
  const Json command{
      {"device_id", device.id},
      {"commands", {{"set_cursor_force", {{device.vector_key, vector}}}}},
  };
  return Json{{"inverse3", Json::array({command})}}.dump();
}

}  // namespace vmech
