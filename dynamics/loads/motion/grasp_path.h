#pragma once

#include <array>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Where the origin of a grasp goes.
struct GraspPath {
  std::vector<Vector3d> p_WG;          ///< [poses] [m]
  Vector3d extent = Vector3d::Zero();  ///< along the axes of the world [m]
  std::array<int, 2> plane = {0, 1};   ///< the two axes of the world along which it goes farthest
  int across() const { return 3 - plane[0] - plane[1]; }  ///< the third one
};

/// Empty where the motion of the links was not computed.
GraspPath FindGraspPath(const LoadStudy& study, const LoadStudyResult& result, int grasp);

}  // namespace vmech
