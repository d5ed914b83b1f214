#pragma once

#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// The handle along one of its axes, m x'' + b x' + f_c sign(x') = F with a spring and a constant
/// beside, which belong to the place and not to the handle.
struct AxisFit {
  double mass = 0;         ///< [kg]
  double damping = 0;      ///< [N s/m]
  double coulomb = 0;      ///< [N]
  double unexplained = 1;  ///< share of the force that the fit leaves over, RMS
  double travel = 0;       ///< largest distance from the mean [m]
};

/// What an identification found of a handle.
struct HandleFit {
  std::array<AxisFit, 3> axes;  ///< x, y, z of the device
  double delay = 0;             ///< from a command to its force, beyond the sampling [s]

  /// What a device states: the least of each over the axes.
  HandlePhysics Physics() const;
};

/// Fits mass, damping, dry friction and delay to a run of ShakeTick with nobody at the handle. The
/// equation of motion is weighted with smooth functions w that vanish with three derivatives at the
/// ends of windows of a quarter of a second, and integrated by parts,
///
///   m int w'' x - b int w' x + f_c int w sign(x') = int w F,
///
/// so that no measured position is ever differentiated twice [Shinbrot 1957]. The delay is that
/// which leaves least over.
/// @throws std::runtime_error if the run is too short or the handle did not move.
HandleFit FitHandle(const Recording& shaken);

/// The largest force that a handle was found to exert.
struct PeakFit {
  double peak = 0;       ///< [N], of the weakest axis
  bool reached = false;  ///< false: the device exerted all that it was asked for, up to `peak`
};

/// What came of the blows of a ShakeTick: the motion of the handle tells what force there really
/// was. @throws std::runtime_error if there are no blows.
PeakFit FitPeak(const Recording& struck, const HandleFit& handle);

}  // namespace vmech
