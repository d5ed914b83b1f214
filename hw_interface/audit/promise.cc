#include "vmech/hw_interface/audit/promise.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace vmech {
namespace {

struct Gain {
  const char* key;
  int row;
};
/// Of K and B: the same in all directions.
constexpr std::array<Gain, 2> kRows{{{"", 0}, {"_angular", 3}}};

}  // namespace

RecordingNotes NotesOf(const SessionPromise& promise, int hand) {
  const HandCoupling& coupling = promise.coupling;
  RecordingNotes notes{{"felt_scale", fmt::to_string(promise.scale)},
                       {"felt_inertia", fmt::to_string(promise.inertia)},
                       {"felt_roll_off", fmt::to_string(promise.roll_off)},
                       {"felt_max_force", fmt::to_string(coupling.max_force)},
                       {"felt_max_moment", fmt::to_string(coupling.max_moment)}};
  for (const auto& [key, row] : kRows) {
    notes.emplace_back(fmt::format("felt_stiffness{}", key),
                       fmt::to_string(coupling.stiffness[row]));
    notes.emplace_back(fmt::format("felt_damping{}", key), fmt::to_string(coupling.damping[row]));
  }
  for (auto& [key, text] : notes) key = RecordingHeader::KeyOf(key, hand);
  return notes;
}

SessionPromise PromiseOf(const RecordingHeader& header, int hand) {
  const auto number = [&](std::string_view key, double otherwise) {
    return header.Number(RecordingHeader::KeyOf(key, hand), otherwise);
  };
  SessionPromise promise;
  promise.paper = header.Note("coupling") == "paper";
  promise.known = !header.Note(RecordingHeader::KeyOf("felt_scale", hand)).empty();
  promise.scale = number("felt_scale", 1);
  promise.inertia = number("felt_inertia", 1);
  promise.roll_off = number("felt_roll_off", 0);
  HandCoupling& coupling = promise.coupling;
  coupling.max_force = number("felt_max_force", coupling.max_force);
  coupling.max_moment = number("felt_max_moment", coupling.max_moment);
  for (const auto& [key, row] : kRows) {
    coupling.stiffness.segment<3>(row).setConstant(number(fmt::format("felt_stiffness{}", key), 0));
    coupling.damping.segment<3>(row).setConstant(number(fmt::format("felt_damping{}", key), 0));
  }
  return promise;
}

}  // namespace vmech
