#include "vmech/kinematics/loops/loop_clusters.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vmech {
namespace {

/// Sets of loops, joined by what they have in common.
class LoopSets {
 public:
  explicit LoopSets(size_t loops) : parent_(loops) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The first loop of the set.
  int Find(int loop) {
    while (parent_[loop] != loop) loop = parent_[loop] = parent_[parent_[loop]];
    return loop;
  }
  void Join(int a, int b) {
    const auto [first, second] = std::minmax({Find(a), Find(b)});
    parent_[second] = first;
  }

 private:
  std::vector<int> parent_;
};

/// Loops by their clusters.
std::vector<std::vector<int>> GroupLoops(const KinematicTree& tree) {
  const int loops = static_cast<int>(tree.loops.size());
  LoopSets sets(tree.loops.size());
  std::vector<int> loop_of_velocity(tree.nv, -1);
  for (int l = 0; l < loops; ++l) {
    for (const LoopColumn& c : tree.loops[l].columns) {
      int& known = loop_of_velocity[c.v];
      known < 0 ? void(known = l) : sets.Join(known, l);
    }
  }
  std::vector<std::vector<int>> groups(tree.loops.size());
  for (int l = 0; l < loops; ++l) groups[sets.Find(l)].push_back(l);
  std::erase_if(groups, [](const std::vector<int>& group) { return group.empty(); });
  return groups;
}

/// Copies clusters out of a tree.
class Splitter {
 public:
  explicit Splitter(const KinematicTree& whole) : whole_(whole), local_(whole.nodes.size(), -1) {}

  LoopCluster Copy(const std::vector<int>& loops) {
    LoopCluster cluster;
    cluster.tree.length = whole_.length;
    cluster.tree.mechanism.units = whole_.mechanism.units;
    cluster.nodes = NodesAround(loops);
    for (const int node : cluster.nodes) AddNode(node, &cluster);
    for (const int loop : loops) AddLoop(whole_.loops[loop], &cluster);
    for (const int node : cluster.nodes) local_[node] = -1;
    cluster.tree.reference = CentroidOfGround(cluster.tree);
    return cluster;
  }

 private:
  std::vector<int> NodesAround(const std::vector<int>& loops) const {
    std::vector<int> nodes;
    for (const int loop : loops) {
      for (const LoopNode& n : whole_.loops[loop].path) nodes.push_back(n.node);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  int Local(int node) const { return node < 0 ? -1 : local_[node]; }

  void AddNode(int index, LoopCluster* cluster) {
    KinematicTree& tree = cluster->tree;
    local_[index] = static_cast<int>(tree.nodes.size());
    TreeNode node = whole_.nodes[index];
    node.parent = Local(node.parent);
    node.joint = node.link = -1;
    Renumber(VelocitiesOf(node.motion), &node.v, &cluster->v, &tree.nv);
    const bool turns = node.motion == NodeMotion::kRevolute || node.motion == NodeMotion::kScrew;
    if (turns) tree.revolute_coordinates.push_back(tree.nq);
    Renumber(CoordinatesOf(node.motion), &node.q, &cluster->q, &tree.nq);
    tree.nodes.push_back(node);
  }

  static int CoordinatesOf(NodeMotion motion) {
    return motion == NodeMotion::kSpherical ? 4 : VelocitiesOf(motion);
  }

  /// Gives the entries of a node their places in the cluster.
  static void Renumber(int count, int* first, std::vector<int>* of_whole, int* size) {
    for (int k = 0; k < count; ++k) of_whole->push_back(*first + k);
    if (count > 0) *first = *size;
    *size += count;
  }

  void AddLoop(Loop loop, LoopCluster* cluster) {
    KinematicTree& tree = cluster->tree;
    JointPlacement place = whole_.placements[loop.joint];
    place.first_node = Local(place.first_node);
    place.second_node = Local(place.second_node);
    tree.placements.push_back(place);
    tree.mechanism.joints.push_back(whole_.mechanism.joints[loop.joint]);
    cluster->joints.push_back(loop.joint);
    for (LoopNode& n : loop.path) n.node = Local(n.node);
    for (LoopColumn& c : loop.columns) {
      c.node = Local(c.node);
      c.v = tree.nodes[c.node].v + c.axis;
    }
    loop.joint = static_cast<int>(tree.placements.size()) - 1;
    loop.row = tree.rows;
    tree.rows += loop.rows;
    tree.loops.push_back(std::move(loop));
  }

  const KinematicTree& whole_;
  std::vector<int> local_;  ///< by node of the whole tree; -1 outside the cluster at work
};

}  // namespace

std::vector<LoopCluster> SplitLoops(const KinematicTree& tree) {
  Splitter splitter(tree);
  std::vector<LoopCluster> clusters;
  for (const std::vector<int>& loops : GroupLoops(tree)) clusters.push_back(splitter.Copy(loops));
  return clusters;
}

}  // namespace vmech
