#pragma once

#include <vector>

#include "vmech/apps/drawing/view.h"
#include "vmech/apps/plot/svg.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Where the parts of a mechanism are on the paper.
struct Sheet {
  /// At the start values of the tree, which must outlive the sheet.
  explicit Sheet(const KinematicTree& tree);

  plot::Point At(const Vector3d& p_W) const;
  Vector3d AnchorInWorld(AnchorId id) const;
  Vector3d GraspInWorld(const Grasp& grasp) const;
  /// The z axis of a joint's first anchor in the world.
  Vector3d AxisInWorld(const Joint& joint) const;
  /// A direction on the paper, of length 1 where it lies in its plane.
  plot::Point Direction(const Vector3d& axis_W) const;
  /// Where a link is held by joints; if those are one place, its grasps, or else its centre of
  /// gravity, which show how it lies.
  std::vector<Vector3d> PlacesOf(int link) const;

  const Mechanism& mechanism;
  std::vector<Posed> X_WL;
  View view;
  double scale = 1;    ///< [drawing units / m]
  plot::Point origin;  ///< of the world
  double width = 760;  ///< of the paper
  double top = 52;     ///< of the picture, below the title
  double bottom = 0;   ///< and its end

 private:
  void FitIn(double least_extent);
};

}  // namespace vmech
