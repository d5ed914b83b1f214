#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "vmech/apps/view/page_session.h"
#include "vmech/hw_interface/screen/screen_mechanism.h"

namespace vmech {

/// A mechanism that a page takes in hand. Requests are those of README.md.
class MechanismSession : public PageSubject {
 public:
  /// `page` makes the document from its scene, of which the start is where the mechanism is now;
  /// `file`: after which what is saved is named.
  MechanismSession(Mechanism assembled, std::filesystem::path file,
                   std::function<std::string(const KinematicTree&)> page);

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
  std::string Save(const std::string& what) const;

  std::filesystem::path file_;
  std::function<std::string(const KinematicTree&)> page_;
  std::mutex mutex_;
  ScreenMechanism screen_;
  std::vector<VectorXd> modes_;
  double pending_ = 0;  ///< time that has not passed yet [s]
  bool changed_ = true;
  std::optional<double> echo_;  ///< the time of the page in the newest request
  std::string note_;
};

}  // namespace vmech
