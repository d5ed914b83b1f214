#include "vmech/dynamics/loads/motion/grasp_path.h"

namespace vmech {

GraspPath FindGraspPath(const LoadStudy& study, const LoadStudyResult& result, int grasp) {
  const Grasp& held = study.mechanism.grasps[grasp];
  GraspPath path;
  if (result.poses.empty() || result.poses.arrays().link_count == 0) return path;
  for (const PoseLoads& pose : result.poses) {
    path.p_WG.push_back(pose.links[held.link].X_WL * held.X_LG.p);
  }
  Vector3d least = path.p_WG.front(), greatest = least;
  for (const Vector3d& p : path.p_WG) {
    least = least.cwiseMin(p);
    greatest = greatest.cwiseMax(p);
  }
  path.extent = greatest - least;
  int across = 2;
  for (const int axis : {1, 0}) {
    if (path.extent[axis] < path.extent[across]) across = axis;
  }
  path.plane = {across == 0 ? 1 : 0, across == 2 ? 1 : 2};
  return path;
}

}  // namespace vmech
