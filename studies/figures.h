#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmech/dynamics/sensitivity/load_derivatives.h"
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

/// How the values at all poses become one number.
enum class Reduction {
  kPeak,        ///< the largest; its derivative is that of the pose that has it
  kSmoothPeak,  ///< (sum of x^p)^(1/p): smooth, and never below the peak
  kRms,         ///< root mean square over the poses
};

/// A number that a study comes to, by which designs are judged.
struct Figure {
  FigureKind kind = FigureKind::kForce;  ///< what is measured
  int index = -1;  ///< of the joint, the drive, the entry of StudyOutcome::bearings or of `paths`
  Reduction reduction = Reduction::kPeak;  ///< how its values at all poses become one number
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

/// The poses of a study on which a figure and its derivative depend, in order: of a peak the one
/// that has it, of a smooth peak those that are not lost in its rounding. `all`: the loads at every
/// pose.
std::vector<size_t> PosesThatMatter(const Figure& figure, const StudyFile& file,
                                    const LoadDerivatives& all);

/// The figure and its derivative by the parameter of `change`, per unit of it. `loads` are those
/// that belong to it, at all poses or at those that matter. Bearings are those that `outcome`
/// chose.
Dual ValueOf(const Figure& figure, const StudyFile& file, const StudyOutcome& outcome,
             const StudyChange& change, const LoadDerivatives& loads);

/// The pose at which a peak is reached, among those of `loads`; -1 for what is no peak.
int PeakPose(const Figure& figure, const StudyFile& file, const LoadDerivatives& loads);

}  // namespace vmech
