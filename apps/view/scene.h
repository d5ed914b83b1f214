#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// What a recorded motion runs over, and what is marked there.
struct SceneAxis {
  std::string label, unit;
  std::vector<double> values;  ///< of every pose
  struct Mark {
    double value;
    std::string label;
  };
  std::vector<Mark> dead_centres;
};

/// What the page is to show: a mechanism at its start and, if they are there, a motion and a
/// session.
struct Scene {
  std::string title, version;
  const KinematicTree* tree = nullptr;  ///< of the assembled mechanism
  std::vector<std::string> meshes;      ///< of the links, binary STL in metres; empty: none
  // A motion:
  const LoadStudy* study = nullptr;
  const LoadStudyResult* loads = nullptr;
  SceneAxis axis;
  /// Of a session: "mechanism" or "haptic"; empty: none.
  std::string session;
  std::string parameters;  ///< of a session whose design is varied: LiveDesign::Sliders, as text
};

/// The scene in JSON, as README.md describes it: SI units, radians, world axes. It can lie in an
/// element of HTML or XML: names cannot end it.
std::string SceneJson(const Scene& scene);

/// "certain", "not determined", "singular".
const char* CertaintyWord(Certainty certainty);

/// A pose as the page has it: [x y z, qw qx qy qz].
std::vector<double> SevenOf(const Posed& X);

}  // namespace vmech
