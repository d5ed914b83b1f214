#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/solvers/backend.h"

namespace vmech {

/// What `vmech ik` is asked, as it stands on the command line: texts in the units of the file.
struct IkQuestion {
  std::filesystem::path mechanism;
  std::string target;              ///< "x y z", "x y z rx ry rz" or "x y z qw qx qy qz"
  std::string grasp;               ///< name; empty: the file's first
  std::vector<std::string> start;  ///< "joint=value" or "joint.freedom=value"
  std::string stiffness;           ///< six numbers, SI; empty: the default
  std::string solver = "nullspace";
  bool paper_rotation = false;  ///< the rotation error of paper eq. (3)
  bool no_limits = false;
  std::optional<double> tolerance;  ///< instead of the mechanism's own
  std::vector<std::string> set;     ///< parameters, "crank=60"
};

/// The branch of a solution, seen from the start.
enum class IkBranch {
  kSame,     ///< a hand that moves steadily from the start to the target leads there
  kOther,    ///< such a hand leads to another pose
  kUnknown,  ///< such a hand does not arrive
};

/// The answer: where the mechanism is and what pulls at it. SI.
struct IkAnswer {
  KinematicTree tree;
  Grasp grasp;
  Units units;
  std::string length_unit, angle_unit;  ///< of the file
  Posed X_WH, X_WG;
  Summary summary;
  Vector6d e1 = Vector6d::Zero();  ///< [m, rad]
  double open_length = 0;          ///< largest e2 [m]
  double open_angle = 0;           ///< largest e2 [rad]
  bool reached = false;            ///< e1 is zero but for the tolerance of the solvers
  IkBranch branch = IkBranch::kUnknown;
  Vector6d stiffness = Vector6d::Zero();
  std::vector<Wrenchd> cut_wrenches;  ///< per loop: first link on second, about M, axes of F
  std::vector<std::string> warnings;
};

/// @throws FileErrors if the file is wrong, std::invalid_argument if the question is (what, the
///         value, what to do), std::runtime_error if the loops do not close at the start.
IkAnswer AnswerIk(const IkQuestion& question);

/// A page for a terminal, in the units of the file.
std::string TextReport(const IkAnswer& answer);
/// The same for programs; SI and radians.
std::string JsonReport(const IkAnswer& answer);

}  // namespace vmech
