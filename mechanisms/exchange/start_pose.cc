#include "vmech/mechanisms/exchange/start_pose.h"

#include <fmt/format.h>

#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

Posed Moved(const ElementaryFreedom& freedom, double q) {
  const Vector3d axis = Vector3d::Unit(freedom.axis);
  if (freedom.rotates) return {Eigen::AngleAxisd(q, axis).toRotationMatrix(), Vector3d::Zero()};
  return {Matrix3d::Identity(), q * axis};
}

AnchorId AddAnchor(Link* link, int index, std::string name, const Posed& X_LA) {
  link->anchors.push_back({std::move(name), X_LA});
  return {index, static_cast<int>(link->anchors.size()) - 1};
}

/// Appends the chain of one joint. Load friction stays with its last part, stiffness is lost.
void AppendChain(const Joint& joint, Mechanism* mechanism) {
  const std::vector<ElementaryFreedom> chain = ElementaryFreedoms(joint.type);
  AnchorId first = joint.first;
  Posed X_LF = mechanism->anchor(first).X_LA;
  for (size_t i = 0; i < chain.size(); ++i) {
    const bool last = i + 1 == chain.size();
    const std::string name =
        fmt::format("{}_{}", joint.name, NameOfFreedom(joint.type, static_cast<int>(i)));
    const Posed turn{ZOnto(chain[i].axis), Vector3d::Zero()};
    const AnchorId F = AddAnchor(&mechanism->links[first.link], first.link, name, X_LF * turn);
    if (!last) mechanism->links.push_back({name + "_link", {}, {}});
    const int child = last ? joint.second.link : static_cast<int>(mechanism->links.size()) - 1;
    const Posed X_LM = last ? mechanism->anchor(joint.second).X_LA : Posed();
    const AnchorId M = AddAnchor(&mechanism->links[child], child, name, X_LM * turn);
    Joint part =
        MakeJoint(name, chain[i].rotates ? JointType::kRevolute : JointType::kPrismatic, F, M);
    part.start = {joint.start[i]};
    part.lower = {joint.lower[i]};
    part.upper = {joint.upper[i]};
    part.passive = {joint.passive[i]};
    if (last) part.load_friction = joint.load_friction;
    mechanism->joints.push_back(part);
    first = {child, -1};
    X_LF = Posed();
  }
}

}  // namespace

Posed StartPose(const Joint& joint) {
  const std::vector<double>& q = joint.start;
  if (joint.type == JointType::kSpherical) {
    return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix(), Vector3d::Zero()};
  }
  const std::vector<ElementaryFreedom> freedoms = ElementaryFreedoms(joint.type);
  Posed X;
  for (size_t i = 0; i < freedoms.size(); ++i) X = X * Moved(freedoms[i], q[i]);
  if (joint.type == JointType::kScrew) X.p.z() = joint.pitch * q[0];
  return X;
}

std::vector<Posed> LinkStartPoses(const Mechanism& mechanism, const SpanningTree& tree) {
  std::vector<Posed> poses(mechanism.links.size());
  for (const SpanningTree::Branch& branch : tree.branches) {
    const Joint& joint = mechanism.joints[branch.joint];
    const Posed X_first_second = mechanism.anchor(joint.first).X_LA * StartPose(joint) *
                                 mechanism.anchor(joint.second).X_LA.inverse();
    const bool reversed = joint.first.link == branch.child_link;
    poses[branch.child_link] =
        poses[branch.parent_link] * (reversed ? X_first_second.inverse() : X_first_second);
  }
  return poses;
}

std::vector<StartAxis> StartAxes(const Joint& joint, const Posed& X_WF) {
  std::vector<StartAxis> axes;
  if (joint.type == JointType::kSpherical) return axes;
  const std::vector<ElementaryFreedom> freedoms = ElementaryFreedoms(joint.type);
  Posed X = X_WF;
  for (size_t i = 0; i < freedoms.size(); ++i) {
    axes.push_back(
        {static_cast<int>(i), freedoms[i].rotates, X.R.col(freedoms[i].axis), X.p, joint.start[i]});
    X = X * Moved(freedoms[i], joint.start[i]);
  }
  return axes;
}

Mechanism WithoutCompositeJoints(const Mechanism& mechanism) {
  Mechanism simple = mechanism;
  simple.joints.clear();
  simple.preferred_cuts.clear();
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kCylindrical || joint.type == JointType::kPlanar) {
      AppendChain(joint, &simple);
    } else {
      simple.joints.push_back(joint);
    }
  }
  return simple;
}

}  // namespace vmech
