#include "vmech/dynamics/simulation/simulation_result.h"

#include <fmt/format.h>

namespace vmech {

std::string_view NameOf(SimulationEvent::Kind kind) {
  switch (kind) {
    case SimulationEvent::Kind::kRebound:
      return "rebounds";
    case SimulationEvent::Kind::kLimitCloses:
      return "comes to rest at its limit";
    case SimulationEvent::Kind::kLimitOpens:
      return "leaves its limit";
    case SimulationEvent::Kind::kSticks:
      return "sticks";
    case SimulationEvent::Kind::kSlips:
      return "slips";
    case SimulationEvent::Kind::kReached:
      return "is reached";
    case SimulationEvent::Kind::kMethodChanged:
      return "stiff: backward differences from here";
  }
  return "";
}

std::string SimulationResult::BriefReport() const {
  if (status == SimulationStatus::kNotRun) return "not run";
  return fmt::format("{} at t = {:.6g} s: {} poses, {} events, {} steps by {}, {} evaluations{}{}",
                     NameOf(status), times.empty() ? 0 : times.back(), size(), events.size(),
                     statistics.steps, NameOf(statistics.method), statistics.evaluations,
                     message.empty() ? "" : "; ", message);
}

}  // namespace vmech
