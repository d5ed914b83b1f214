#include "vmech/kinematics/tree/kinematic_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/validity.h"

namespace vmech {
namespace {

/// One freedom of a joint as an elementary joint about or along z of a turned frame.
struct Elementary {
  NodeMotion motion;
  Matrix3d R_FE;  ///< axes of the elementary joint in the joint's frame
  int freedom;
};

/// The elementary joints from the first anchor to the second.
std::vector<Elementary> Decompose(JointType type) {
  using enum NodeMotion;
  const Matrix3d x = ZOnto(0), y = ZOnto(1), z = ZOnto(2);
  switch (type) {
    case JointType::kRevolute:
      return {{kRevolute, z, 0}};
    case JointType::kPrismatic:
      return {{kPrismatic, z, 0}};
    case JointType::kCylindrical:
      return {{kPrismatic, z, 0}, {kRevolute, z, 1}};
    case JointType::kScrew:
      return {{kScrew, z, 0}};
    case JointType::kUniversal:
      return {{kRevolute, x, 0}, {kRevolute, y, 1}};
    case JointType::kSpherical:
      return {{kSpherical, z, 0}};
    case JointType::kPlanar:
      return {{kPrismatic, x, 0}, {kPrismatic, y, 1}, {kRevolute, z, 2}};
    case JointType::kWeld:
      return {{kFixed, z, 0}};
  }
  return {};
}

/// Builds the nodes of one tree branch after another.
class Builder {
 public:
  explicit Builder(KinematicTree* tree) : tree_(*tree) {
    tree_.node_of_link.assign(tree_.mechanism.links.size(), -1);
    tree_.placements.resize(tree_.mechanism.joints.size());
  }

  /// A joint traversed from its second link to its first is the chain of its elementary joints
  /// backwards, each turned by half a turn about x so that its coordinate keeps its sign.
  void AddBranch(const SpanningTree::Branch& branch) {
    const Joint& joint = tree_.mechanism.joints[branch.joint];
    const bool reversed = joint.first.link == branch.child_link;
    const AnchorId inboard = reversed ? joint.second : joint.first;
    const AnchorId outboard = reversed ? joint.first : joint.second;
    std::vector<Elementary> chain = Decompose(joint.type);
    if (reversed) Reverse(&chain);

    int parent = tree_.node_of_link[inboard.link];
    for (const Elementary& e : chain) {
      TreeNode node;
      node.parent = parent;
      node.motion = e.motion;
      node.joint = branch.joint;
      node.reversed = reversed;
      node.freedom = e.freedom;
      node.R_FE = e.R_FE;
      NumberCoordinates(&node);
      parent = static_cast<int>(tree_.nodes.size());
      tree_.nodes.push_back(node);
    }
    tree_.nodes.back().link = outboard.link;
    tree_.node_of_link[outboard.link] = parent;
    tree_.placements[branch.joint].tree_node = parent;
  }

  void PlaceAnchors() {
    for (size_t j = 0; j < tree_.mechanism.joints.size(); ++j) {
      const Joint& joint = tree_.mechanism.joints[j];
      tree_.placements[j].first_node = tree_.node_of_link[joint.first.link];
      tree_.placements[j].second_node = tree_.node_of_link[joint.second.link];
    }
  }

  void AddLoop(int joint_index) {
    const Joint& joint = tree_.mechanism.joints[joint_index];
    Loop loop;
    loop.joint = joint_index;
    loop.type = joint.type;
    loop.pitch = joint.pitch;
    loop.row = tree_.rows;
    loop.rows = 6 - FreedomsOf(joint.type);
    tree_.rows += loop.rows;
    const JointPlacement& place = tree_.placements[joint_index];
    std::vector<double> side(tree_.nodes.size(), 0.0);
    for (int n = place.second_node; n >= 0; n = tree_.nodes[n].parent) side[n] += 1;
    for (int n = place.first_node; n >= 0; n = tree_.nodes[n].parent) side[n] -= 1;
    for (size_t n = 0; n < tree_.nodes.size(); ++n) {
      if (side[n] == 0) continue;
      loop.path.push_back({static_cast<int>(n), side[n]});
      const TreeNode& node = tree_.nodes[n];
      for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
        loop.columns.push_back({static_cast<int>(n), node.v + k, k, side[n]});
      }
    }
    tree_.loops.push_back(loop);
  }

 private:
  static void Reverse(std::vector<Elementary>* chain) {
    const Matrix3d half_turn = Vector3d(1, -1, -1).asDiagonal();
    std::reverse(chain->begin(), chain->end());
    for (Elementary& e : *chain) {
      if (e.motion != NodeMotion::kSpherical) e.R_FE = e.R_FE * half_turn;
    }
  }

  void NumberCoordinates(TreeNode* node) {
    const int velocities = VelocitiesOf(node->motion);
    if (velocities == 0) return;
    node->q = tree_.nq;
    const bool turns = node->motion == NodeMotion::kRevolute || node->motion == NodeMotion::kScrew;
    if (turns) tree_.revolute_coordinates.push_back(node->q);
    node->v = tree_.nv;
    tree_.nv += velocities;
    tree_.nq += node->motion == NodeMotion::kSpherical ? 4 : 1;
  }

  KinematicTree& tree_;
};

template <typename T>
Pose<T> PureRotation(const Matrix3d& R) {
  return {R.cast<T>(), Vector3<T>::Zero()};
}

void SetNumbers(const TreeDesign<double>& design, KinematicTree* tree) {
  for (size_t i = 0; i < tree->nodes.size(); ++i) {
    TreeNode& node = tree->nodes[i];
    const TreeDesign<double>::NodeNumbers& numbers = design.nodes[i];
    node.X_PF = numbers.X_PF;
    node.X_BL = numbers.X_BL;
    node.pitch = numbers.pitch;
    node.mass = numbers.mass;
    node.p_BoBcm = numbers.p_BoBcm;
    node.I_Bcm = numbers.I_Bcm;
  }
  for (size_t j = 0; j < tree->placements.size(); ++j) {
    tree->placements[j].X_AF = design.placements[j].X_AF;
    tree->placements[j].X_BM = design.placements[j].X_BM;
  }
}

}  // namespace

Design<double>::JointNumbers NumbersOf(const Joint& joint) {
  Design<double>::JointNumbers numbers{joint.pitch, {}, joint.load_friction};
  std::copy(joint.passive.begin(), joint.passive.end(), numbers.passive.begin());
  return numbers;
}

Design<double> DesignOf(const Mechanism& mechanism) {
  Design<double> design;
  for (const Link& link : mechanism.links) {
    const MassProperties& body = link.mass_properties;
    design.links.push_back({body.mass, body.p_LoLcm, body.I_Lcm, {}});
    for (const Anchor& anchor : link.anchors) design.links.back().X_LA.push_back(anchor.X_LA);
  }
  for (const Joint& joint : mechanism.joints) design.joints.push_back(NumbersOf(joint));
  design.gravity_W = mechanism.gravity_W;
  return design;
}

template <typename T>
template <typename S>
Design<S> Design<T>::cast() const {
  Design<S> other;
  for (const LinkNumbers& link : links) {
    other.links.push_back(
        {S(link.mass), link.p_LoLcm.template cast<S>(), link.I_Lcm.template cast<S>(), {}});
    for (const Pose<T>& X : link.X_LA) other.links.back().X_LA.push_back(X.template cast<S>());
  }
  for (const JointNumbers& joint : joints) {
    typename Design<S>::JointNumbers numbers{S(joint.pitch), {}, {}};
    for (size_t k = 0; k < joint.passive.size(); ++k) {
      const PassiveOf<T>& p = joint.passive[k];
      numbers.passive[k] = {S(p.stiffness), S(p.rest), S(p.viscous), S(p.coulomb)};
    }
    const LoadFrictionOf<T>& f = joint.load_friction;
    numbers.load_friction = {S(f.coefficient), S(f.radius), S(f.thrust_radius), S(f.length),
                             S(f.width)};
    other.joints.push_back(numbers);
  }
  other.gravity_W = gravity_W.template cast<S>();
  return other;
}

// The chain of a joint leads from its inboard anchor, X_PF = X_BL X_LA R_FE, by turns of its axes,
// R_FE' R_FE, to its outboard one, X_BL = R_FE' X_LA^-1.
template <typename T>
TreeDesign<T> DesignOfTree(const KinematicTree& tree, const Design<T>& design) {
  TreeDesign<T> placed;
  const auto anchor = [&](const AnchorId& id) -> const Pose<T>& {
    return design.links[id.link].X_LA[id.anchor];
  };
  const auto in_node = [&](const AnchorId& id) {
    const int node = tree.NodeOfLink(id.link);
    return node < 0 ? anchor(id) : placed.nodes[node].X_BL * anchor(id);
  };
  for (const TreeNode& node : tree.nodes) {
    const Joint& joint = tree.mechanism.joints[node.joint];
    const AnchorId& inboard = node.reversed ? joint.second : joint.first;
    const AnchorId& outboard = node.reversed ? joint.first : joint.second;
    const bool first = node.parent < 0 || tree.nodes[node.parent].joint != node.joint;
    typename TreeDesign<T>::NodeNumbers numbers;
    numbers.pitch = design.joints[node.joint].pitch;
    numbers.X_PF =
        (first ? in_node(inboard) : PureRotation<T>(tree.nodes[node.parent].R_FE.transpose())) *
        PureRotation<T>(node.R_FE);
    if (node.link >= 0) {
      const auto& link = design.links[node.link];
      numbers.X_BL = PureRotation<T>(node.R_FE.transpose()) * anchor(outboard).inverse();
      numbers.mass = link.mass;
      numbers.p_BoBcm = numbers.X_BL * link.p_LoLcm;
      numbers.I_Bcm = numbers.X_BL.R * link.I_Lcm * numbers.X_BL.R.transpose();
    }
    placed.nodes.push_back(numbers);
  }
  for (size_t j = 0; j < tree.mechanism.joints.size(); ++j) {
    const Joint& joint = tree.mechanism.joints[j];
    placed.placements.push_back(
        {in_node(joint.first), in_node(joint.second), design.joints[j].pitch});
  }
  return placed;
}

template <typename T>
TreeDesign<T> DesignOfTree(const KinematicTree& tree) {
  TreeDesign<T> design;
  for (const TreeNode& node : tree.nodes) {
    design.nodes.push_back({node.X_PF.cast<T>(), node.X_BL.cast<T>(), T(node.pitch), T(node.mass),
                            node.p_BoBcm.cast<T>(), node.I_Bcm.cast<T>()});
  }
  for (size_t j = 0; j < tree.placements.size(); ++j) {
    const JointPlacement& place = tree.placements[j];
    design.placements.push_back(
        {place.X_AF.cast<T>(), place.X_BM.cast<T>(), T(tree.mechanism.joints[j].pitch)});
  }
  return design;
}

Posed KinematicTree::X_node_link(int link) const {
  const int node = node_of_link[link];
  return node < 0 ? Posed{} : nodes[node].X_BL;
}

KinematicTree BuildKinematicTree(Mechanism mechanism, const SpanningTreeOptions& options) {
  KinematicTree tree;
  tree.spanning = FindSpanningTree(mechanism, options);
  tree.length = CharacteristicLength(mechanism);
  tree.mechanism = std::move(mechanism);
  Builder builder(&tree);
  for (const SpanningTree::Branch& branch : tree.spanning.branches) builder.AddBranch(branch);
  builder.PlaceAnchors();
  SetNumbers(DesignOfTree(tree, DesignOf(tree.mechanism)), &tree);
  for (int joint : tree.spanning.cuts) builder.AddLoop(joint);
  tree.reference = CentroidOfGround(tree);
  return tree;
}

Vector3d CentroidOfGround(const KinematicTree& tree) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  const auto add = [&](int carrier, const Vector3d& p) {
    if (carrier < 0) sum += p, ++count;
  };
  for (const TreeNode& node : tree.nodes) add(node.parent, node.X_PF.p);
  for (const Loop& loop : tree.loops) {
    const JointPlacement& place = tree.placements[loop.joint];
    add(place.first_node, place.X_AF.p);
    add(place.second_node, place.X_BM.p);
  }
  return count > 0 ? Vector3d(sum / count) : sum;
}

VectorXd StartCoordinates(const KinematicTree& tree) {
  VectorXd q = VectorXd::Zero(tree.nq);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    const std::vector<double>& start = tree.mechanism.joints[node.joint].start;
    if (node.motion == NodeMotion::kSpherical) {
      q.segment<4>(node.q) = Eigen::Map<const Eigen::Vector4d>(start.data()).normalized();
    } else {
      q[node.q] = start[node.freedom];
    }
  }
  return q;
}

std::string NameOfVelocity(const KinematicTree& tree, int v) {
  for (const TreeNode& node : tree.nodes) {
    const int k = v - node.v;
    if (node.v < 0 || k < 0 || k >= VelocitiesOf(node.motion)) continue;
    return NameOfFreedom(tree.mechanism.joints[node.joint], node.freedom + k);
  }
  return "?";
}

namespace {

void RequireFreedom(const Mechanism& mechanism, int joint, int freedom) {
  RequireIndex("joint", joint, mechanism.joints.size());
  const Joint& of = mechanism.joints[joint];
  RequireIndex("freedom of joint '" + of.name + "'", freedom, FreedomsOf(of.type));
}

}  // namespace

int VelocityIndex(const KinematicTree& tree, int joint, int freedom) {
  RequireFreedom(tree.mechanism, joint, freedom);
  for (const TreeNode& node : tree.nodes) {
    if (node.joint != joint || node.v < 0) continue;
    if (node.motion == NodeMotion::kSpherical) return node.v + freedom;
    if (node.freedom == freedom) return node.v;
  }
  return -1;
}

int CoordinateIndex(const KinematicTree& tree, int joint, int freedom) {
  RequireFreedom(tree.mechanism, joint, freedom);
  for (const TreeNode& node : tree.nodes) {
    if (node.joint != joint || node.q < 0 || node.motion == NodeMotion::kSpherical) continue;
    if (node.freedom == freedom) return node.q;
  }
  return -1;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                      \
  template Design<T> Design<double>::cast<T>() const;                             \
  template TreeDesign<T> DesignOfTree<T>(const KinematicTree&, const Design<T>&); \
  template TreeDesign<T> DesignOfTree<T>(const KinematicTree&);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
template Design<Dual> Design<Dual>::cast<Dual>() const;
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
