#include "vmech/mechanisms/graph.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

constexpr int kUnreached = std::numeric_limits<int>::max() / 4;

/// Union-find over links: which of them the tree already joins.
class Components {
 public:
  explicit Components(size_t count) : leader_(count) {
    std::iota(leader_.begin(), leader_.end(), 0);
  }
  int Find(int i) {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  /// False if both were joined before.
  bool Join(int a, int b) {
    a = Find(a);
    b = Find(b);
    leader_[a] = b;
    return a != b;
  }

 private:
  std::vector<int> leader_;
};

/// Number of joints between each link and the ground.
std::vector<int> DistancesFromGround(const Mechanism& mechanism) {
  std::vector<int> distance(mechanism.links.size(), kUnreached);
  distance[mechanism.ground] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Joint& joint : mechanism.joints) {
      int& a = distance[joint.first.link];
      int& b = distance[joint.second.link];
      if (a + 1 < b) b = a + 1, changed = true;
      if (b + 1 < a) a = b + 1, changed = true;
    }
  }
  return distance;
}

void RequireConnected(const Mechanism& mechanism, const std::vector<int>& distance) {
  std::string loose;
  for (size_t i = 0; i < distance.size(); ++i) {
    if (distance[i] >= kUnreached)
      loose += (loose.empty() ? "'" : ", '") + mechanism.links[i].name + "'";
  }
  if (!loose.empty()) {
    throw std::invalid_argument("no chain of joints connects the ground link '" +
                                mechanism.links[mechanism.ground].name + "' to " + loose +
                                "; add a joint or remove the link");
  }
}

void RequireJoints(std::string_view field, const std::vector<int>& joints,
                   const Mechanism& mechanism) {
  for (int joint : joints) RequireIndex(field, joint, mechanism.joints.size());
}

bool Contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// Joints in the order in which they claim a place in the tree.
std::vector<int> JointsByPriority(const Mechanism& mechanism, const SpanningTreeOptions& options,
                                  const std::vector<int>& distance) {
  const std::vector<int>& wanted_cuts =
      options.cut.empty() ? mechanism.preferred_cuts : options.cut;
  auto priority = [&](int j) {
    const Joint& joint = mechanism.joints[j];
    const int choice = Contains(options.keep, j)     ? -2
                       : Contains(options.prefer, j) ? -1
                       : Contains(wanted_cuts, j)    ? 1
                                                     : 0;
    return std::make_tuple(choice, FreedomsOf(joint.type),
                           distance[joint.first.link] + distance[joint.second.link], j);
  };
  std::vector<int> order(mechanism.joints.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return priority(a) < priority(b); });
  return order;
}

/// Appends the branches below `link`, depth first, in file order.
void AppendBranches(const Mechanism& mechanism, const std::vector<bool>& in_tree, int link,
                    int arrived_by, std::vector<SpanningTree::Branch>* branches) {
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    if (!in_tree[j] || static_cast<int>(j) == arrived_by) continue;
    if (joint.first.link != link && joint.second.link != link) continue;
    const int child = joint.first.link == link ? joint.second.link : joint.first.link;
    branches->push_back({static_cast<int>(j), link, child});
    AppendBranches(mechanism, in_tree, child, static_cast<int>(j), branches);
  }
}

}  // namespace

SpanningTree FindSpanningTree(const Mechanism& mechanism, const SpanningTreeOptions& options) {
  RequireValid(mechanism);
  RequireJoints("SpanningTreeOptions.cut", options.cut, mechanism);
  RequireJoints("SpanningTreeOptions.keep", options.keep, mechanism);
  RequireJoints("SpanningTreeOptions.prefer", options.prefer, mechanism);
  const std::vector<int> distance = DistancesFromGround(mechanism);
  RequireConnected(mechanism, distance);

  std::vector<bool> in_tree(mechanism.joints.size(), false);
  Components components(mechanism.links.size());
  for (int j : JointsByPriority(mechanism, options, distance)) {
    const Joint& joint = mechanism.joints[j];
    in_tree[j] = components.Join(joint.first.link, joint.second.link);
    if (!in_tree[j] && Contains(options.keep, j)) {
      throw std::invalid_argument("joint '" + joint.name +
                                  "' closes a loop of driven joints only; drive one joint less");
    }
  }

  SpanningTree tree;
  AppendBranches(mechanism, in_tree, mechanism.ground, -1, &tree.branches);
  for (size_t j = 0; j < in_tree.size(); ++j) {
    if (!in_tree[j]) tree.cuts.push_back(static_cast<int>(j));
  }
  return tree;
}

}  // namespace vmech
