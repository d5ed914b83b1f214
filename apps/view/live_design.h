#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vmech/apps/view/live_outcome.h"
#include "vmech/hw_interface/variation/varied_mechanism.h"
#include "vmech/studies/study.h"

namespace vmech {

/// The design of a mechanism that a page varies while it is held: its sliders, what is asked of
/// them, and what comes of it. Not for several threads at once.
class LiveDesign {
 public:
  /// Of a mechanism file that was read with `settings`. @throws FileErrors as ReadMechanism.
  LiveDesign(const std::filesystem::path& mechanism, std::vector<ParameterSetting> settings);
  /// Of the mechanism of a study, whose loads are told where drives move it.
  explicit LiveDesign(const StudyFile& study);

  /// Is there anything to move?
  bool any() const { return !source_.parameters().empty(); }
  /// The sliders, as the scene's session has them.
  nlohmann::json Sliders() const;
  /// The mechanism that is held from now on, as DesignGuide. Keeps a reference to the tree.
  void Hold(const KinematicTree& held, std::vector<int> hands);
  HeldDesign Start() const { return guide_->Start(); }
  const VectorXd& asked() const { return guide_->asked(); }

  /// The request {"do": "vary"}. @throws std::invalid_argument saying what is wrong with it.
  void Ask(const nlohmann::json& request);
  /// The design to go to next, as DesignGuide::Next; where it has arrived the study is asked.
  std::optional<HeldDesign> Next(const DesignGuide::Progress& progress);
  /// For the state: what it is, what is asked, and the work of the changes [J].
  nlohmann::json StateOf(const VectorXd& values, double work) const;
  /// The mechanism has another shape, which pages are to draw.
  void Reshape(const KinematicTree& tree);
  /// Is there something that every page has to be told beside the state?
  bool HasNews();
  /// A message, {"state": ..}, with the shape and what the study has come to for as long as they
  /// are new: pages ask at their own pace.
  std::string Told(std::string message);
  /// The file with the values in it, as {"save": .., "files": ..}.
  std::string Saved(const VectorXd& values) const;
  KinematicTree ReadAt(const VectorXd& values, const KinematicTree& held, const VectorXd& q) {
    return source_.ReadAt(values, held, q);
  }

 private:
  std::filesystem::path file_;
  VariedMechanism source_;
  std::optional<DesignGuide> guide_;
  std::optional<LiveOutcome> outcome_;
  VectorXd computed_;  // values that the study was asked for
  /// Members of an object, `"scene": {..}`, and until when they are told.
  struct News {
    std::string members;
    std::chrono::steady_clock::time_point until;
  };
  static News Fresh(std::string members);
  News shape_, figures_;
};

}  // namespace vmech
