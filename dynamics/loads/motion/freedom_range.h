#pragma once

#include <cstddef>
#include <optional>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Where a coordinate is at its least or its greatest.
struct Extreme {
  double value = 0;  ///< [m] or [rad]
  double time = 0;   ///< the first time that it is there [s]
};

/// How far and how fast a freedom of a joint moves.
struct FreedomRange {
  Extreme least, greatest;          ///< of the coordinate, and when
  double largest_rate = 0;          ///< magnitude, over all poses [m/s] or [rad/s]
  double largest_acceleration = 0;  ///< magnitude, over all poses [m/s^2] or [rad/s^2]

  double stroke() const { return greatest.value - least.value; }  ///< between them [m] or [rad]
};

/// Between two poses at which the rate has different signs the coordinate is taken as the cubic
/// that has the coordinates and rates of both: the value is off by a fourth power of the step. Of a
/// cycle the step from the last pose to the first counts.
FreedomRange FindRange(const LoadStudy& study, const LoadStudyResult& result, int joint,
                       int freedom);

/// The shares of a turn of the drive in which an output goes one way and the other.
struct TimeRatio {
  double forward = 0;  ///< turn of the drive while the coordinate grows [rad]
  double back = 0;     ///< and while it falls [rad]
  double ratio() const { return forward / back; }  ///< above 1 the return is the faster
};

/// Of a joint between the ground and a link, with one freedom, that goes to and fro once in every
/// turn of the only drive, which turns uniformly through whole cycles; none of other joints and
/// motions.
std::optional<TimeRatio> FindTimeRatio(const LoadStudy& study, const LoadStudyResult& result,
                                       int joint);

}  // namespace vmech
