#include "vmech/hw_interface/audit/promise.h"

#include <fmt/format.h>

#include <array>

namespace vmech {
namespace {

struct Gain {
  const char* key;
  int row;
};
/// Of K and B: the same in all directions.
constexpr std::array<Gain, 2> kRows{{{"", 0}, {"_angular", 3}}};

}  // namespace

RecordingNotes NotesOf(const SessionPromise& promise) {
  const HandCoupling& coupling = promise.coupling;
  RecordingNotes notes{{"felt_scale", fmt::to_string(promise.scale)},
                       {"felt_inertia", fmt::to_string(promise.inertia)},
                       {"felt_max_force", fmt::to_string(coupling.max_force)},
                       {"felt_max_moment", fmt::to_string(coupling.max_moment)}};
  for (const auto& [key, row] : kRows) {
    notes.emplace_back(fmt::format("felt_stiffness{}", key),
                       fmt::to_string(coupling.stiffness[row]));
    notes.emplace_back(fmt::format("felt_damping{}", key), fmt::to_string(coupling.damping[row]));
  }
  return notes;
}

SessionPromise PromiseOf(const RecordingHeader& header) {
  SessionPromise promise;
  promise.paper = header.Note("coupling") == "paper";
  promise.known = !header.Note("felt_scale").empty();
  promise.scale = header.Number("felt_scale", 1);
  promise.inertia = header.Number("felt_inertia", 1);
  HandCoupling& coupling = promise.coupling;
  coupling.max_force = header.Number("felt_max_force", coupling.max_force);
  coupling.max_moment = header.Number("felt_max_moment", coupling.max_moment);
  for (const auto& [key, row] : kRows) {
    coupling.stiffness.segment<3>(row).setConstant(
        header.Number(fmt::format("felt_stiffness{}", key), 0));
    coupling.damping.segment<3>(row).setConstant(
        header.Number(fmt::format("felt_damping{}", key), 0));
  }
  return promise;
}

}  // namespace vmech
