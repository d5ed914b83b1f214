#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "vmech/apps/view/live_design.h"
#include "vmech/apps/view/page_session.h"
#include "vmech/hw_interface/screen/screen_mechanism.h"

namespace vmech {

/// A mechanism that a page takes in hand. Requests are those of README.md.
class MechanismSession : public PageSubject {
 public:
  /// `page` makes the document from its scene, of which the start is where the mechanism is now;
  /// `file`: after which what is saved is named. `design`: to vary it; may be null.
  MechanismSession(Mechanism assembled, std::filesystem::path file,
                   std::function<std::string(const KinematicTree&)> page,
                   std::unique_ptr<LiveDesign> design = nullptr);

  /// Lets as much time pass as has passed since the last call, up to a twentieth of a second.
  void Run(double elapsed);

  std::string Page() override;
  std::string Do(const nlohmann::json& request) override;
  void LetGo() override;
  std::string NewState() override;
  std::string State() override;

  const std::vector<std::string>& notes() const { return screen_.notes(); }

 private:
  std::string FindModes();
  void LeadDesign();
  void Act(const nlohmann::json& request);
  std::string Save(const std::string& what) const;

  std::filesystem::path file_;
  std::function<std::string(const KinematicTree&)> page_;
  std::mutex mutex_;
  ScreenMechanism screen_;
  std::unique_ptr<LiveDesign> design_;
  std::optional<HeldDesign> first_design_;
  VectorXd design_values_;
  std::vector<VectorXd> modes_;
  double pending_ = 0;  ///< time that has not passed yet [s]
  bool changed_ = true;
  std::optional<double> echo_;  ///< the time of the page in the newest request
  std::string note_;
};

}  // namespace vmech
