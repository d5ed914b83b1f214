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

/// A motion that was recorded, in rows, and what an audit of it has found.
struct RecordedMotion {
  struct Series {
    std::string name;
    std::vector<float> values;  ///< of every row
  };
  struct Chart {
    std::string title, unit;
    std::vector<Series> series;
  };
  struct Finding {
    std::string what, unit;
    double worst, bound;
    bool sound;
  };
  struct Hand {
    int grasp;
    std::vector<float> wrenches;  ///< on the mechanism, about the grasp frame's origin, in W
  };
  std::vector<double> times;       ///< [s], of every row
  std::vector<float> poses;        ///< of every link, as SevenOf
  std::vector<float> coordinates;  ///< of every freedom
  std::vector<float> wrenches;     ///< of every joint
  std::vector<Hand> hands;
  std::vector<Chart> charts;
  std::vector<Finding> findings;
  std::vector<std::string> words;  ///< what was found: first the verdict
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
  const RecordedMotion* recorded = nullptr;  ///< instead of these
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
