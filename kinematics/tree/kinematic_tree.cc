#include "vmech/kinematics/tree/kinematic_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

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

Matrix3d ZAlong(int axis) {
  // Cyclic permutations of the axes that bring z onto x or y.
  Matrix3d R = Matrix3d::Zero();
  R(axis, 2) = 1;
  R((axis + 1) % 3, 0) = 1;
  R((axis + 2) % 3, 1) = 1;
  return R;
}

/// The elementary joints from the first anchor to the second.
std::vector<Elementary> Decompose(JointType type) {
  using enum NodeMotion;
  const Matrix3d x = ZAlong(0), y = ZAlong(1), z = ZAlong(2);
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

Posed PureRotation(const Matrix3d& R) {
  return {R, Vector3d::Zero()};
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
    Posed X_PF = LinkInNode(inboard.link) * tree_.mechanism.anchor(inboard).X_LA;
    for (const Elementary& e : chain) {
      TreeNode node;
      node.parent = parent;
      node.motion = e.motion;
      node.joint = branch.joint;
      node.reversed = reversed;
      node.freedom = e.freedom;
      node.pitch = joint.pitch;
      node.X_PF = X_PF * PureRotation(e.R_FE);
      NumberCoordinates(&node);
      parent = static_cast<int>(tree_.nodes.size());
      X_PF = PureRotation(e.R_FE.transpose());
      tree_.nodes.push_back(node);
    }
    const Posed X_BA = PureRotation(chain.back().R_FE.transpose());
    AttachLink(outboard.link, X_BA * tree_.mechanism.anchor(outboard).X_LA.inverse());
    tree_.placements[branch.joint].tree_node = parent;
  }

  void PlaceAnchors() {
    for (size_t j = 0; j < tree_.mechanism.joints.size(); ++j) {
      const Joint& joint = tree_.mechanism.joints[j];
      JointPlacement& place = tree_.placements[j];
      place.first_node = tree_.node_of_link[joint.first.link];
      place.second_node = tree_.node_of_link[joint.second.link];
      place.X_AF = LinkInNode(joint.first.link) * tree_.mechanism.anchor(joint.first).X_LA;
      place.X_BM = LinkInNode(joint.second.link) * tree_.mechanism.anchor(joint.second).X_LA;
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

  void AttachLink(int link, const Posed& X_BL) {
    TreeNode& node = tree_.nodes.back();
    const MassProperties& body = tree_.mechanism.links[link].mass_properties;
    node.link = link;
    node.X_BL = X_BL;
    node.mass = body.mass;
    node.p_BoBcm = X_BL * body.p_LoLcm;
    node.I_Bcm = X_BL.R * body.I_Lcm * X_BL.R.transpose();
    tree_.node_of_link[link] = static_cast<int>(tree_.nodes.size()) - 1;
  }

  Posed LinkInNode(int link) const { return tree_.X_node_link(link); }

  KinematicTree& tree_;
};

}  // namespace

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

}  // namespace vmech
