#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// The transmission angle of a planar loop of four links [Alt 1932]: what the pressure angle, that
/// between the force which a massless coupler passes on and the velocity of the point of the output
/// on which it acts, leaves to a right angle,
///
///   sin mu = |f . v| / (|f| |v|).
///
/// Between two revolutes f is along the coupler: at a rocker mu is the angle between coupler and
/// rocker, at a slide the angle between the connecting rod and the normal to the slide. A coupler
/// that slides on one of its neighbours pushes across the slide, through its revolute. 90 degrees
/// are best; at 0 nothing is passed on.
struct TransmissionAngle {
  int input = -1, coupler = -1, output = -1;  ///< links
  bool slides = false;                        ///< the output, on the ground
  bool coupler_slides = false;                ///< on the input or on the output
  std::vector<double> angles;                 ///< [poses] in [0, pi/2]; not finite where v is zero
  size_t least_pose = 0;                      ///< of the smallest
};

/// None where the mechanism is not one loop of four links, the ground among them, of revolutes with
/// parallel axes and prismatics across these, driven at the ground; nor where both ends of the
/// coupler slide, or the motion of the links was not computed.
std::optional<TransmissionAngle> FindTransmissionAngle(const LoadStudy& study,
                                                       const LoadStudyResult& result);

}  // namespace vmech
