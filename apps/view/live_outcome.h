#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "vmech/mechanisms/expressions/parameter_table.h"

namespace vmech {

/// What a study comes to for the design that a page has at the moment, computed by a thread of its
/// own: peaks, lives of the bearings that its own design calls for, and their sensitivities by the
/// parameters. The newest question wins.
class LiveOutcome {
 public:
  /// `parameters`: by which sensitivities are wanted, by name. The study as it is read with
  /// `settings` is what others are compared with.
  LiveOutcome(std::filesystem::path study, std::vector<ParameterSetting> settings,
              std::vector<std::string> parameters);
  ~LiveOutcome();

  /// Asks for the study with these settings beside those that it was made with.
  void Ask(std::vector<ParameterSetting> settings);
  /// The newest message for the page, {"outcome": ..} as in README.md; empty if there is none since
  /// the last call.
  std::string TakeNews();

 private:
  struct Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace vmech
