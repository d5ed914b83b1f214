#include "vmech/kinematics/loops/coordinate_partition.h"

#include <utility>

namespace vmech {

CoordinatePartition MakePartition(const KinematicTree& tree, std::vector<int> driven,
                                  std::vector<int> idle) {
  CoordinatePartition partition{std::move(driven), std::move(idle), {}, {}};
  partition.dependent_slot.assign(tree.nv, 0);
  for (int v : partition.driven) partition.dependent_slot[v] = -1;
  for (int v : partition.idle) partition.dependent_slot[v] = -1;
  for (int v = 0; v < tree.nv; ++v) {
    if (partition.dependent_slot[v] < 0) continue;
    partition.dependent_slot[v] = static_cast<int>(partition.dependent.size());
    partition.dependent.push_back(v);
  }
  return partition;
}

}  // namespace vmech
