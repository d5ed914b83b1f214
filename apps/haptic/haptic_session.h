#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/estimation/hand_observer.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/masters/workspace_master.h"
#include "vmech/hw_interface/recording/recording.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// What a hand, or several, are to hold.
struct HapticSubject {
  Mechanism mechanism;
  std::vector<int> grasps;     ///< of every hand
  std::optional<HandLaw> law;  ///< of the first simulated operator's hand; none: it wanders
  double end = 0;              ///< of the law [s]; it stands still from then on
};

/// Reads a mechanism, or a study that a hand moves. `grasps` by name; none: the study's, or the
/// first.
/// @throws FileErrors naming the file and what is wrong; OptionError for an unknown grasp, or one
/// that two hands are to hold.
HapticSubject ReadSubject(const std::filesystem::path& file, const std::vector<std::string>& grasps,
                          const std::vector<std::string>& set = {});

/// How the device's axes lie in the world: its z against gravity (along z if there is none).
Matrix3d DeviceAxes(const Mechanism& mechanism);

/// Does something with a file that an option names, whose faults are those of a file.
/// @throws std::invalid_argument instead of std::runtime_error.
template <typename Use>
auto UsingFile(std::string_view option, Use use) {
  try {
    return use();
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(std::string(option) + ": " + error.what());
  }
}

/// "absent", "light", "relaxed" or "firm". @throws OptionError.
Grip ParseGrip(const std::string& word);

/// A device of three freedoms: it exerts forces, and no moments.
bool ForcesAlone(const DeviceInfo& device);

/// Figures of a handle from "mass=0.3", "damping=1", ..; see HandlePhysics. @throws OptionError.
HandlePhysics ParseHandle(const std::vector<std::string>& words);

/// The master that a word stands for: simulated, haply[:PORT], spacenav, replay:FILE, udp:HOST:PORT
/// or plugin:LIBRARY[:PARAMETERS]. The simulated operator holds the mechanism at X_WG.
/// @throws OptionError for any other word, std::invalid_argument for a file that cannot be used.
struct MasterRequest {
  std::string word;
  double rate = 1000;
  Grip grip = Grip::kRelaxed;
  Matrix3d R_WD = Matrix3d::Identity();
  Posed X_WG;
  std::optional<HandLaw> law;
  double end = 0;        ///< of the law [s]
  bool gripper = false;  ///< the simulated operator works it
  unsigned seed = 1;     ///< of a hand that wanders
};
std::unique_ptr<Master> MakeMaster(const MasterRequest& request);

/// A configured master in the workspace that is asked for, configured.
std::unique_ptr<Master> InWorkspace(const WorkspaceOptions& workspace,
                                    std::unique_ptr<Master> master);

/// The hand of a recording in the world as a table t, x, y, z, qw, qx, qy, qz for a study's
/// `motion: {grasp: .., table: ..}` in metres, from the first sample on; the hand took hold at
/// X_WG.
/// @throws FileErrors if the file cannot be written.
void WriteHandMotion(const std::filesystem::path& file, const Recording& recording,
                     const Matrix3d& R_WD, const Posed& X_WG);

/// How a mechanism is rendered; zeros leave it to the device.
struct RenderingRequest {
  std::string coupling = "virtual";   ///< or "paper"
  double scale = 0;                   ///< of all forces
  double stiffness = 0, inertia = 0;  ///< paper: of the constraint [N/m]; share of the inertia
  // paper: words for ContactKind, EstimatorKind and WrenchRule.
  std::string contact = "linear", estimator = "observer", wrench = "workless";
};

/// A hand that is to hold a mechanism.
struct RenderedHand {
  int grasp = -1;
  const DeviceInfo* device = nullptr;
  // What is rendered to it.
  SafetyOptions safety;
  HandObserverOptions observer;
  SessionPromise promise;
};

/// The virtual side of a session, what it asks of the safety filters, and both in words.
struct Rendering {
  std::unique_ptr<Tick> tick;
  std::vector<RenderedHand> hands;
  std::string report;
};

/// A mechanism held at grasps in the closed pose q, for a device each. Keeps a reference to the
/// tree. Of several hands all forces are scaled alike, so that what one pulls the other feels.
/// @throws std::invalid_argument as the ticks; OptionError for an unknown word, and for the paper's
/// way in several hands.
Rendering MakeRendering(const RenderingRequest& request, const KinematicTree& tree,
                        std::vector<RenderedHand> hands, const VectorXd& q);

}  // namespace vmech
