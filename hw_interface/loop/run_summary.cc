#include <fmt/format.h>

#include "vmech/hw_interface/loop/runner.h"

namespace vmech {
namespace {

std::string Outcome(const RunSummary& summary) {
  switch (summary.status) {
    case RunStatus::kNotRun:
      return "not run";
    case RunStatus::kFinished:
      return "finished";
    case RunStatus::kStopped:
      return "stopped";
    case RunStatus::kFault:
      return summary.cause == ForceOff::kNone ? "fault: the mechanism gave no sound wrench"
                                              : fmt::format("fault: {}", NameOf(summary.cause));
  }
  return "";
}

std::string Durations(const char* what, const Histogram& h) {
  constexpr double kMicro = 1e-3;
  return fmt::format("  {:<10} median {:9.1f}  p99 {:9.1f}  p99.9 {:9.1f}  max {:9.1f} us\n", what,
                     kMicro * static_cast<double>(h.Percentile(0.5)),
                     kMicro * static_cast<double>(h.Percentile(0.99)),
                     kMicro * static_cast<double>(h.Percentile(0.999)),
                     kMicro * static_cast<double>(h.max()));
}

}  // namespace

std::string HandSummary::Report() const {
  std::string text = fmt::format("  samples missed {}, {} grasps\n", missed, grasps);
  text += fmt::format("  peak force {:.4g} N, moment {:.4g} N m; least energy {:.3g} J\n",
                      peak_force, peak_moment, least_energy);
  text += fmt::format(
      "  safety: without force {} ticks, ramped {}, damped {}, clamped {}, slewed {}, braked {}\n",
      safety.off, safety.stages[0], safety.stages[1], safety.stages[2], safety.stages[3],
      safety.stages[4]);
  return text;
}

std::string RunSummary::BriefReport() const {
  return fmt::format("{}: {} after {} ticks of {:g} ms, {} slots skipped, peak {:.3g} N", device,
                     Outcome(*this), ticks, 1e3 * period, skipped, peak_force);
}

std::string RunSummary::FullReport() const {
  std::string text = BriefReport() + "\n";
  text += "  " + realtime.BriefReport() + "\n";
  text += Durations("late", late) + Durations("interval", interval) + Durations("compute", compute);
  text += fmt::format("  mechanism held {} ticks\n", held) + Report();
  for (size_t i = 0; i < others.size(); ++i) {
    text += fmt::format("  hand {}: {}{}\n", i + 2, others[i].device,
                        others[i].cause == ForceOff::kLinkLost ? ", link lost: it has let go" : "");
    text += others[i].Report();
  }
  if (*AdviceFor(cause) != 0) text += fmt::format("  to mend it: {}\n", AdviceFor(cause));
  if (!post_mortem.empty()) {
    text += fmt::format("  the last ticks are in {}\n", post_mortem.string());
  }
  return text;
}

}  // namespace vmech
