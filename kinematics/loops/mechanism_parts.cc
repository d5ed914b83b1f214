#include "vmech/kinematics/loops/mechanism_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "vmech/kinematics/loops/loop_clusters.h"

namespace vmech {
namespace {

using Anchors = std::vector<std::pair<int, int>>;  // link, anchor

/// The joints of a cluster of loops, in the order of the file.
std::vector<int> JointsOf(const KinematicTree& tree, const LoopCluster& cluster) {
  std::vector<int> joints = cluster.joints;
  for (const int node : cluster.nodes) joints.push_back(tree.nodes[node].joint);
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  return joints;
}

std::vector<int> Union(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// The joints of each part: those of clusters that have an anchor in common belong together.
std::vector<std::vector<int>> GroupJoints(const KinematicTree& tree) {
  std::vector<std::vector<int>> groups;
  std::map<std::pair<int, int>, size_t> group_of;
  for (const LoopCluster& cluster : SplitLoops(tree)) {
    std::vector<int> joints = JointsOf(tree, cluster);
    size_t group = groups.size();
    groups.emplace_back();
    const auto anchors = [&](const std::vector<int>& of, const auto& each) {
      for (const int j : of) {
        const Joint& joint = tree.mechanism.joints[j];
        for (const AnchorId& id : {joint.first, joint.second}) each({id.link, id.anchor});
      }
    };
    std::vector<size_t> met;
    anchors(joints, [&](std::pair<int, int> id) {
      const auto known = group_of.find(id);
      if (known != group_of.end()) met.push_back(known->second);
    });
    if (!met.empty()) group = *std::min_element(met.begin(), met.end());
    for (const size_t other : met) {
      if (other != group) joints = Union(joints, std::exchange(groups[other], {}));
    }
    groups[group] = Union(groups[group], joints);
    anchors(groups[group], [&](std::pair<int, int> id) { group_of[id] = group; });
  }
  std::erase_if(groups, [](const std::vector<int>& group) { return group.empty(); });
  return groups;
}

/// The nodes of a joint, the last first.
std::vector<int> ChainOf(const KinematicTree& tree, int joint) {
  std::vector<int> chain;
  int node = tree.placements[joint].tree_node;
  for (; node >= 0 && tree.nodes[node].joint == joint; node = tree.nodes[node].parent) {
    chain.push_back(node);
  }
  return chain;
}

/// Copies parts out of a mechanism.
class Splitter {
 public:
  explicit Splitter(const KinematicTree& whole) : whole_(whole) {}

  MechanismPart Copy(const std::vector<int>& joints) {
    MechanismPart part;
    part.joints = joints;
    Mechanism mechanism;
    mechanism.units = whole_.mechanism.units;
    links_.clear();
    SpanningTreeOptions cuts;
    for (size_t k = 0; k < joints.size(); ++k) {
      Joint joint = whole_.mechanism.joints[joints[k]];
      joint.first.link = Local(joint.first.link, &mechanism);
      joint.second.link = Local(joint.second.link, &mechanism);
      mechanism.joints.push_back(std::move(joint));
      if (whole_.placements[joints[k]].tree_node < 0) cuts.cut.push_back(static_cast<int>(k));
    }
    mechanism.ground = Local(Carrier(joints), &mechanism);
    part.tree = BuildKinematicTree(std::move(mechanism), cuts);
    part.tree.length = whole_.length;
    part.q = CoordinatesOf(part);
    return part;
  }

 private:
  int Local(int link, Mechanism* mechanism) {
    const auto [known, is_new] = links_.try_emplace(link, std::ssize(mechanism->links));
    if (is_new) mechanism->links.push_back(whole_.mechanism.links[link]);
    return static_cast<int>(known->second);
  }

  /// The link that no joint of a part carries.
  int Carrier(const std::vector<int>& joints) const {
    std::vector<int> carried;
    for (const int j : joints) {
      const int node = whole_.placements[j].tree_node;
      if (node >= 0) carried.push_back(whole_.nodes[node].link);
    }
    const auto carrier = std::find_if(links_.begin(), links_.end(), [&](const auto& link) {
      return std::find(carried.begin(), carried.end(), link.first) == carried.end();
    });
    return carrier->first;
  }

  std::vector<int> CoordinatesOf(const MechanismPart& part) const {
    std::vector<int> q(part.tree.nq);
    for (size_t k = 0; k < part.joints.size(); ++k) {
      const std::vector<int> here = ChainOf(part.tree, static_cast<int>(k));
      const std::vector<int> there = ChainOf(whole_, part.joints[k]);
      for (size_t n = 0; n < here.size(); ++n) {
        const TreeNode &node = part.tree.nodes[here[n]], &of_whole = whole_.nodes[there[n]];
        const int count = node.motion == NodeMotion::kSpherical ? 4 : VelocitiesOf(node.motion);
        for (int i = 0; i < count; ++i) q[node.q + i] = of_whole.q + i;
      }
    }
    return q;
  }

  const KinematicTree& whole_;
  std::map<int, ptrdiff_t> links_;  ///< of the whole: index in the part
};

}  // namespace

std::vector<MechanismPart> SplitMechanism(const KinematicTree& tree) {
  Splitter splitter(tree);
  std::vector<MechanismPart> parts;
  for (const std::vector<int>& joints : GroupJoints(tree)) parts.push_back(splitter.Copy(joints));
  return parts;
}

}  // namespace vmech
