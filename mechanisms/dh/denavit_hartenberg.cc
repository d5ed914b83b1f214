#include "vmech/mechanisms/dh/denavit_hartenberg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

/// One freedom of a joint: it moves about or along the z axis of the frame E.
struct Elementary {
  DhMotion motion;
  Matrix3d R_FE;
  int freedom;
};

/// The freedoms of a joint from its first anchor to its second; one that is none for a weld.
std::vector<Elementary> FreedomsInOrder(JointType type) {
  if (type == JointType::kWeld) return {{DhMotion::kFixed, Matrix3d::Identity(), 0}};
  std::vector<Elementary> chain;
  for (const ElementaryFreedom& freedom : ElementaryFreedoms(type)) {
    const DhMotion motion = type == JointType::kScrew ? DhMotion::kScrew
                            : freedom.rotates         ? DhMotion::kRotation
                                                      : DhMotion::kTranslation;
    chain.push_back({motion, ZOnto(freedom.axis), static_cast<int>(chain.size())});
  }
  return chain;
}

/// Backwards, about and along the opposite axes: half a turn about x of each frame.
std::vector<Elementary> Reversed(std::vector<Elementary> chain) {
  std::reverse(chain.begin(), chain.end());
  for (Elementary& freedom : chain) freedom.R_FE *= Vector3d(1, -1, -1).asDiagonal();
  return chain;
}

Posed Turned(const Posed& X, const Matrix3d& R) {
  return {X.R * R, X.p};
}

/// Rx(a) Ry(b) Rz(c) of a unit quaternion w, x, y, z; with a = 0 where a and c turn about one line.
std::vector<double> XyzAngles(const std::vector<double>& wxyz) {
  const Matrix3d R =
      Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
  const double a = std::hypot(R(1, 2), R(2, 2)) > 0 ? std::atan2(-R(1, 2), R(2, 2)) : 0;
  const Matrix3d R_yz = Eigen::AngleAxisd(-a, Vector3d::UnitX()) * R;
  return {a, std::atan2(R_yz(0, 2), R_yz(2, 2)), std::atan2(R_yz(1, 0), R_yz(1, 1))};
}

/// An axis on a body, or a whole frame that rides on it.
struct Distal {
  std::string name;
  Posed X_BQ;
  int child = -1;  ///< the body that the axis carries; -1: a frame
  int grasp = -1;
  DhPair pair;  ///< from the axis that carries the body
};

/// A link, or what is between two freedoms of a joint; B is the drawing frame, or the joint's.
struct Body {
  int link = -1;
  int parent = -1;
  int joint = -1;
  Elementary freedom{DhMotion::kFixed, Matrix3d::Identity(), 0};
  Posed X_BP;  ///< the axis that carries it is z of P
  std::vector<Distal> distal;
};

class TableBuilder {
 public:
  TableBuilder(const Mechanism& mechanism, const SpanningTree& tree) : mechanism_(mechanism) {
    body_of_link_.assign(mechanism.links.size(), -1);
    AddBody({mechanism.ground, -1, -1, {DhMotion::kFixed, Matrix3d::Identity(), 0}, {}, {}});
    for (const SpanningTree::Branch& branch : tree.branches) AddBranch(branch);
    for (const int cut : tree.cuts) AddCut(mechanism.joints[cut]);
    for (size_t g = 0; g < mechanism.grasps.size(); ++g) {
      const Grasp& grasp = mechanism.grasps[g];
      AddFrame(grasp.link, "grasp " + grasp.name, grasp.X_LG, static_cast<int>(g));
    }
    for (Body& body : bodies_) {
      for (Distal& distal : body.distal) {
        distal.pair = DeduceDh(body.X_BP.inverse() * distal.X_BQ);
      }
    }
  }

  DhTable Build() {
    table_.row_of_link.assign(mechanism_.links.size(), -1);
    table_.link_frames.resize(mechanism_.links.size());
    table_.row_of_grasp.assign(mechanism_.grasps.size(), -1);
    starts_.resize(bodies_.size());
    for (size_t i = 0; i < bodies_.size(); ++i) AddRows(bodies_[i], starts_[i]);
    return std::move(table_);
  }

 private:
  int AddBody(Body body) {
    const int index = static_cast<int>(bodies_.size());
    if (body.link >= 0) body_of_link_[body.link] = index;
    bodies_.push_back(std::move(body));
    return index;
  }

  void AddFrame(int link, std::string name, const Posed& X_LQ, int grasp) {
    bodies_[body_of_link_[link]].distal.push_back({std::move(name), X_LQ, -1, grasp, {}});
  }

  void AddCut(const Joint& joint) {
    for (const AnchorId end : {joint.first, joint.second}) {
      AddFrame(end.link, joint.name + " on " + mechanism_.links[end.link].name,
               mechanism_.anchor(end).X_LA, -1);
    }
  }

  void AddBranch(const SpanningTree::Branch& branch) {
    const Joint& joint = mechanism_.joints[branch.joint];
    const bool reversed = joint.first.link == branch.child_link;
    const Posed& X_PF = mechanism_.anchor(reversed ? joint.second : joint.first).X_LA;
    const Posed& X_LM = mechanism_.anchor(reversed ? joint.first : joint.second).X_LA;
    std::vector<Elementary> chain = FreedomsInOrder(joint.type);
    if (reversed) chain = Reversed(std::move(chain));
    int parent = body_of_link_[branch.parent_link];
    Posed X_BF = X_PF;
    for (size_t i = 0; i < chain.size(); ++i) {
      const bool last = i + 1 == chain.size();
      const Posed X_BM = last ? X_LM : Posed();
      const int child = AddBody({last ? branch.child_link : -1,
                                 parent,
                                 branch.joint,
                                 chain[i],
                                 Turned(X_BM, chain[i].R_FE),
                                 {}});
      const std::string name = NameOfFreedom(joint, chain[i].freedom);
      bodies_[parent].distal.push_back({name, Turned(X_BF, chain[i].R_FE), child, -1, {}});
      parent = child;
      X_BF = Posed();
    }
  }

  /// The rows of what a body carries. `start` is a row without a body yet: where it begins, and
  /// theta and d of the way along the carrying axis.
  void AddRows(const Body& body, const DhRow& start) {
    DhRow base = start;
    base.link = body.link;
    base.motion = body.freedom.motion;
    base.joint = base.motion == DhMotion::kFixed ? -1 : body.joint;
    base.freedom = body.freedom.freedom;
    if (base.motion == DhMotion::kScrew) base.pitch = mechanism_.joints[body.joint].pitch;
    const DhPair main = body.distal.empty() ? DhPair() : body.distal[0].pair;
    NoteLinkFrame(body, main);
    if (body.distal.empty()) {
      base.axis = "end of " + mechanism_.links[body.link].name;
      table_.rows.push_back(base);
    }
    for (const Distal& distal : body.distal) {
      DhRow row = base;
      row.axis = distal.name;
      row.relation = distal.pair.relation;
      row.gamma = distal.pair.row.theta - main.row.theta;
      row.b = distal.pair.row.d - main.row.d;
      row.parameters = distal.pair.row;
      row.parameters.theta = start.parameters.theta + main.row.theta;
      row.parameters.d = start.parameters.d + main.row.d;
      table_.rows.push_back(row);
      AddWhatFollows(distal);
    }
  }

  void AddWhatFollows(const Distal& distal) {
    DhRow next;
    next.from = static_cast<int>(table_.rows.size()) - 1;
    next.parameters.theta = distal.pair.theta;
    next.parameters.d = distal.pair.d;
    if (distal.child >= 0) {
      starts_[distal.child] = next;
      return;
    }
    next.link = table_.rows.back().link;
    next.axis = distal.name;
    if (distal.grasp >= 0) table_.row_of_grasp[distal.grasp] = next.from + 1;
    table_.rows.push_back(next);
  }

  void NoteLinkFrame(const Body& body, const DhPair& main) {
    if (body.link < 0) return;
    table_.row_of_link[body.link] = static_cast<int>(table_.rows.size());
    table_.link_frames[body.link] = body.X_BP * PoseOf(main.row);
  }

  const Mechanism& mechanism_;
  std::vector<Body> bodies_;
  std::vector<int> body_of_link_;
  std::vector<DhRow> starts_;  ///< per body, written with the rows of its parent
  DhTable table_;
};

Posed PoseOfRow(const DhRow& row, double q) {
  DhParameters moved = row.parameters;
  moved.theta += row.gamma;
  moved.d += row.b;
  if (row.motion == DhMotion::kRotation || row.motion == DhMotion::kScrew) moved.theta += q;
  if (row.motion == DhMotion::kTranslation) moved.d += q;
  if (row.motion == DhMotion::kScrew) moved.d += row.pitch * q;
  return PoseOf(moved);
}

}  // namespace

DhTable DeduceDhTable(const Mechanism& mechanism, const SpanningTree& tree) {
  return TableBuilder(mechanism, tree).Build();
}

std::vector<Posed> DhPoses(const DhTable& table,
                           std::span<const std::vector<double>> joint_coordinates) {
  std::vector<Posed> poses;
  for (const DhRow& row : table.rows) {
    double q = 0;
    if (row.joint >= 0) {
      const std::vector<double>& of_joint = joint_coordinates[row.joint];
      q = (of_joint.size() == 4 ? XyzAngles(of_joint) : of_joint)[row.freedom];
    }
    const Posed X_from_end = PoseOfRow(row, q);
    poses.push_back(row.from < 0 ? X_from_end : poses[row.from] * X_from_end);
  }
  return poses;
}

Mechanism DrawnInLinkFrames(const Mechanism& mechanism, const DhTable& table) {
  Mechanism drawn = mechanism;
  for (int i = 0; i < static_cast<int>(drawn.links.size()); ++i) {
    if (i == mechanism.ground) continue;
    const Posed X_DL = table.link_frames[i].inverse();
    MassProperties& properties = drawn.links[i].mass_properties;
    properties.p_LoLcm = X_DL * properties.p_LoLcm;
    properties.I_Lcm = RotatedInertia(X_DL.R, properties.I_Lcm);
    for (Anchor& anchor : drawn.links[i].anchors) anchor.X_LA = X_DL * anchor.X_LA;
    for (Grasp& grasp : drawn.grasps) {
      if (grasp.link == i) grasp.X_LG = X_DL * grasp.X_LG;
    }
  }
  return drawn;
}

}  // namespace vmech
