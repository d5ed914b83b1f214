#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/study.h"

namespace vmech {

/// What a figure of a study is.
enum class FigureKind {
  kForce,        ///< of a joint: the size of its force [N]
  kMoment,       ///< of a joint: the size of the moment that it holds, across its freedoms [N m]
  kDrive,        ///< of a drive: the size of its force [N] or [N m]
  kGroundForce,  ///< the size of the sum of all forces on the ground [N]
  kLife,         ///< L_nh of the bearings that a joint has got, together [h]
  kMass,         ///< of all links but the ground [kg]
  kPathError,    ///< distance of a grasp from where the study wants it [m]
  kTransmission  ///< how far the transmission angle is from a right angle [deg]
};

/// How a course over the poses becomes one number.
enum class Reduction {
  kPeak,        ///< the largest; its derivative is that of the pose that has it
  kSmoothPeak,  ///< (sum of x^p)^(1/p): smooth, and never below the peak
  kRms,         ///< root mean square over the poses
};

/// A number that a study comes to, by which designs are judged.
struct Figure {
  FigureKind kind = FigureKind::kForce;  ///< what is measured
  int index = -1;  ///< of the joint, the drive, the entry of StudyOutcome::bearings or of `paths`
  Reduction reduction = Reduction::kPeak;  ///< of its history to one number
  std::string name;                        ///< "pin.force", "main.drive.rms", "wrist.life", "mass"
  std::string unit;                        ///< "N"
  double power = 32;                       ///< p of a smooth peak
  std::array<int, 4> loop = {};            ///< of kTransmission: TransmissionAngle::joints
};

/// Peaks of the force and moment of every joint that is loaded, of every drive, of the force on the
/// ground and of the distance from the paths that are wanted; how far the transmission angle of a
/// planar loop of four links is from a right angle; the lives of the bearings that were chosen, and
/// the mass.
std::vector<Figure> FiguresOf(const StudyFile& file, const StudyOutcome& outcome);

/// The figure of this name, such as "pin.force.rms", for a study whose figures are `known`.
/// @throws std::invalid_argument naming those that there are.
Figure FindFigure(const std::vector<Figure>& known, const std::string& name);

/// Which components that statics does not determine a figure depends on, in words ("fz, mx"); empty
/// if it is certain.
std::string NotDeterminedIn(const Figure& figure, const StudyFile& file,
                            const StudyOutcome& outcome);

/// The length of a vector of three.
template <typename T>
T VectorSize(const T* v) {
  using std::sqrt;
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The size of the moment about the axes that a joint does not leave free: without what its drive
/// exerts.
template <typename T>
T HeldMoment(JointType type, const T* moment) {
  const std::array<bool, 6>& free = FreedomsOfType(type).free;
  T held[3];
  for (int k = 0; k < 3; ++k) held[k] = free[3 + k] ? T(0) : moment[k];
  return VectorSize(held);
}

/// Has it a history over the poses, of which it is the peak or the mean?
bool IsCourse(const Figure& figure);

}  // namespace vmech
