#include "simbody_tree.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace vmech::peers {
namespace {

bool IsDriven(const std::vector<JointFreedom>& drives, int joint) {
  return std::any_of(drives.begin(), drives.end(),
                     [joint](const JointFreedom& d) { return d.joint == joint; });
}

// Kruskal's tree. Smaller ranks first; joints of rank below zero have to be in it.
std::vector<int> ChooseTreeJoints(const Mechanism& mechanism,
                                  const std::vector<JointFreedom>& drives) {
  const auto rank = [&](int j) {
    const JointType type = mechanism.joints[j].type;
    return type == JointType::kScrew || IsDriven(drives, j) ? -1 : FreedomsOf(type);
  };
  std::vector<int> order(mechanism.joints.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });

  std::vector<int> island(mechanism.links.size());
  std::iota(island.begin(), island.end(), 0);
  std::vector<int> chosen;
  for (int j : order) {
    const int a = island[mechanism.joints[j].first.link];
    const int b = island[mechanism.joints[j].second.link];
    if (a == b && rank(j) < 0) {
      throw std::invalid_argument("joint '" + mechanism.joints[j].name +
                                  "': driven joints and screws close a loop; release one of them");
    }
    if (a == b) continue;
    std::replace(island.begin(), island.end(), b, a);
    chosen.push_back(j);
  }
  return chosen;
}

// The chosen joints from ground outwards, parents before children.
std::vector<TreeJoint> OrderTree(const Mechanism& mechanism, const std::vector<int>& chosen) {
  std::vector<TreeJoint> tree;
  std::vector<int> reached{mechanism.ground};
  for (size_t next = 0; next < reached.size(); ++next) {
    const int link = reached[next];
    for (int j : chosen) {
      const Joint& joint = mechanism.joints[j];
      const int other = joint.first.link == link    ? joint.second.link
                        : joint.second.link == link ? joint.first.link
                                                    : -1;
      if (other < 0 || std::count(reached.begin(), reached.end(), other)) continue;
      tree.push_back({j, link, other});
      reached.push_back(other);
    }
  }
  if (reached.size() != mechanism.links.size()) {
    throw std::invalid_argument("a link is not connected to ground");
  }
  return tree;
}

}  // namespace

std::vector<TreeJoint> SpanningTree(const Mechanism& mechanism,
                                    const std::vector<JointFreedom>& drives) {
  return OrderTree(mechanism, ChooseTreeJoints(mechanism, drives));
}

}  // namespace vmech::peers
