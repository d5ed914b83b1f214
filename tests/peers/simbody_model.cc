#include "simbody_model.h"

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "simbody_parts.h"
#include "simbody_tree.h"

namespace vmech::peers {
namespace {

using SimTK::Constraint;
using SimTK::MobilizedBody;
using SimTK::SpatialVec;
using SimTK::Transform;

// Prescribes the accelerations of all freedoms of a mobilizer.
class PrescribedAcceleration : public SimTK::Motion::Custom::Implementation {
 public:
  explicit PrescribedAcceleration(const Vector3d* udot) : udot_(udot) {}

  SimTK::Motion::Level getLevel(const SimTK::State&) const override {
    return SimTK::Motion::Acceleration;
  }
  void calcPrescribedAcceleration(const SimTK::State&, int nu, double* udot) const override {
    std::copy_n(udot_->data(), nu, udot);
  }

 private:
  const Vector3d* udot_;
};

// Velocity of M relative to F, at Mo, axes of F.
SpatialVec RelativeVelocity(const LinkMotion& f, const Posed& X_WF, const LinkMotion& m,
                            const Posed& X_WM) {
  const Vector3d v_Mo = m.v_WLo + m.w_WL.cross(X_WM.p - m.X_WL.p);
  const Vector3d v_Mo_on_f = f.v_WLo + f.w_WL.cross(X_WM.p - f.X_WL.p);
  const Matrix3d R_FW = X_WF.R.transpose();
  return SpatialVec(ToSimTK(R_FW * (m.w_WL - f.w_WL)), ToSimTK(R_FW * (v_Mo - v_Mo_on_f)));
}

}  // namespace

struct SimbodyModel::Implementation {
  struct LoopEquation {
    int joint;
    Constraint constraint;
    SimTK::ConstrainedBodyIndex second;  // the joint's second link among the constraint's bodies
  };

  Mechanism mechanism;
  std::vector<JointFreedom> drives;
  DriveMode mode;

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::Force::UniformGravity gravity;
  SimTK::Force::DiscreteForces discrete;
  std::vector<TreeJoint> tree;
  std::vector<MobilizedBody> bodies;  // per link
  std::vector<int> driven_links;      // per drive: the link that the driven mobilizer moves
  std::vector<Vector3d> prescribed;   // per link: accelerations of its mobilizer, if driven
  std::vector<LoopEquation> loop_equations;
  SimTK::Vector_<SpatialVec> reactions;
  SimTK::Vector motion_forces;
  SimTK::State state;

  Implementation(const Mechanism& given, std::vector<JointFreedom> driven, DriveMode drive_mode);
  void BuildTree();
  void BuildLoops();
  void BuildDrives();
  void SetState(const std::vector<LinkMotion>& links);
  void SetForces(const SimbodyQuery& query);
  void CompareState(const std::vector<LinkMotion>& links, SimbodyAnswer* answer) const;
  void ReadTreeWrenches(SimbodyAnswer* answer);
  void ReadLoopWrenches(SimbodyAnswer* answer) const;
  void ReadMotion(SimbodyAnswer* answer) const;
  void ReadDrives(const SimbodyQuery& query, SimbodyAnswer* answer);

  Posed AnchorPose(AnchorId id) const {
    return FromSimTK(bodies[id.link].getBodyTransform(state)) * mechanism.anchor(id).X_LA;
  }
};

SimbodyModel::Implementation::Implementation(const Mechanism& given,
                                             std::vector<JointFreedom> driven, DriveMode drive_mode)
    : mechanism(given),
      drives(std::move(driven)),
      mode(drive_mode),
      gravity(forces, matter, ToSimTK(given.gravity_W)),
      discrete(forces, matter) {
  BuildTree();
  BuildLoops();
  BuildDrives();
  state = system.realizeTopology();
  for (LoopEquation& equation : loop_equations) {
    const auto body = bodies[mechanism.joints[equation.joint].second.link].getMobilizedBodyIndex();
    for (SimTK::ConstrainedBodyIndex i(0); i < equation.constraint.getNumConstrainedBodies(); ++i) {
      const MobilizedBody& other = equation.constraint.getMobilizedBodyFromConstrainedBody(i);
      if (other.getMobilizedBodyIndex() == body) equation.second = i;
    }
  }
  system.realizeModel(state);
}

void SimbodyModel::Implementation::BuildTree() {
  tree = SpanningTree(mechanism, drives);
  bodies.resize(mechanism.links.size());
  bodies[mechanism.ground] = matter.updGround();
  for (const TreeJoint& edge : tree) {
    const Joint& joint = mechanism.joints[edge.joint];
    const bool reversed = joint.first.link == edge.child;
    const Transform X_LF = ToSimTK(FrameForSimbody(joint.type, mechanism.anchor(joint.first).X_LA));
    const Transform X_LM =
        ToSimTK(FrameForSimbody(joint.type, mechanism.anchor(joint.second).X_LA));
    const SimTK::Body::Rigid body(ToSimTK(mechanism.links[edge.child].mass_properties));
    bodies[edge.child] = AddMobilizer(joint, bodies[edge.parent], reversed ? X_LM : X_LF, body,
                                      reversed ? X_LF : X_LM,
                                      reversed ? MobilizedBody::Reverse : MobilizedBody::Forward);
  }
}

void SimbodyModel::Implementation::BuildLoops() {
  for (int j = 0; j < static_cast<int>(mechanism.joints.size()); ++j) {
    if (std::any_of(tree.begin(), tree.end(), [j](const TreeJoint& e) { return e.joint == j; })) {
      continue;
    }
    const Joint& joint = mechanism.joints[j];
    const Transform X_LF = ToSimTK(mechanism.anchor(joint.first).X_LA);
    const Transform X_LM = ToSimTK(mechanism.anchor(joint.second).X_LA);
    MobilizedBody& f = bodies[joint.first.link];
    MobilizedBody& m = bodies[joint.second.link];
    const LoopEquations equations = EquationsOf(joint.type);
    for (int axis : equations.plane_normals) {
      const SimTK::UnitVec3 normal = X_LF.R()(axis);
      const double height = SimTK::dot(normal, X_LF.p());
      loop_equations.push_back({j, Constraint::PointInPlane(f, normal, height, m, X_LM.p()), {}});
    }
    for (const auto& [axis_f, axis_m] : equations.perpendiculars) {
      loop_equations.push_back(
          {j, Constraint::ConstantAngle(f, X_LF.R()(axis_f), m, X_LM.R()(axis_m)), {}});
    }
  }
}

void SimbodyModel::Implementation::BuildDrives() {
  prescribed.assign(mechanism.links.size(), Vector3d::Zero());
  for (const JointFreedom& drive : drives) {
    const Joint& joint = mechanism.joints[drive.joint];
    const auto edge = std::find_if(tree.begin(), tree.end(),
                                   [&](const TreeJoint& e) { return e.joint == drive.joint; });
    const auto count = std::count_if(drives.begin(), drives.end(),
                                     [&](const JointFreedom& d) { return d.joint == drive.joint; });
    driven_links.push_back(edge->child);
    if (mode == DriveMode::kForce) continue;
    if (count != FreedomsOf(joint.type)) {
      throw std::invalid_argument("joint '" + joint.name +
                                  "': accelerations of some freedoms are given, of others not");
    }
    if (drive.freedom > 0) continue;
    SimTK::Motion::Custom(bodies[edge->child],
                          new PrescribedAcceleration(&prescribed[edge->child]));
  }
}

// Each mobilizer is fitted to the relative pose and velocity of the two links it joins.
void SimbodyModel::Implementation::SetState(const std::vector<LinkMotion>& links) {
  const auto inboard_and_outboard = [&](const TreeJoint& edge) {
    const Joint& joint = mechanism.joints[edge.joint];
    const bool reversed = joint.first.link == edge.child;
    const AnchorId in = reversed ? joint.second : joint.first;
    const AnchorId out = reversed ? joint.first : joint.second;
    return std::pair(
        links[in.link].X_WL * FrameForSimbody(joint.type, mechanism.anchor(in).X_LA),
        links[out.link].X_WL * FrameForSimbody(joint.type, mechanism.anchor(out).X_LA));
  };
  for (const TreeJoint& edge : tree) {
    const auto [X_WF, X_WM] = inboard_and_outboard(edge);
    bodies[edge.child].setQToFitTransform(state, ToSimTK(X_WF.inverse() * X_WM));
  }
  system.realize(state, SimTK::Stage::Position);
  for (const TreeJoint& edge : tree) {
    const auto [X_WF, X_WM] = inboard_and_outboard(edge);
    bodies[edge.child].setUToFitVelocity(
        state, RelativeVelocity(links[edge.parent], X_WF, links[edge.child], X_WM));
  }
}

void SimbodyModel::Implementation::SetForces(const SimbodyQuery& query) {
  for (size_t i = 0; i < query.external_W.size(); ++i) {
    discrete.setOneBodyForce(state, bodies[i], ToSimTK(query.external_W[i]));
  }
  if (query.external_W.empty()) discrete.clearAllBodyForces(state);
  for (size_t i = 0; i < drives.size(); ++i) {
    const int link = driven_links[i];
    const auto u = SpeedIndex(mechanism.joints[drives[i].joint].type, drives[i].freedom);
    if (mode == DriveMode::kAcceleration) {
      prescribed[link][u] = query.drives[i];
    } else {
      discrete.setOneMobilityForce(state, bodies[link], u, query.drives[i]);
    }
  }
}

void SimbodyModel::Implementation::CompareState(const std::vector<LinkMotion>& links,
                                                SimbodyAnswer* answer) const {
  answer->pose_error = state.getQErr().size() ? SimTK::max(state.getQErr().abs()) : 0;
  answer->velocity_error = state.getUErr().size() ? SimTK::max(state.getUErr().abs()) : 0;
  for (size_t i = 0; i < links.size(); ++i) {
    const Transform given = ToSimTK(links[i].X_WL);
    const Transform& found = bodies[i].getBodyTransform(state);
    const SpatialVec& V = bodies[i].getBodyVelocity(state);
    answer->pose_error = std::max({answer->pose_error, (given.p() - found.p()).norm(),
                                   (given.R().asMat33() - found.R().asMat33()).norm()});
    answer->velocity_error =
        std::max({answer->velocity_error, (ToSimTK(links[i].w_WL) - V[0]).norm(),
                  (ToSimTK(links[i].v_WLo) - V[1]).norm()});
  }
}

// A mobilizer's reaction acts on the outboard body, at the origin of its frame.
void SimbodyModel::Implementation::ReadTreeWrenches(SimbodyAnswer* answer) {
  matter.calcMobilizerReactionForces(state, reactions);
  for (const TreeJoint& edge : tree) {
    const Joint& joint = mechanism.joints[edge.joint];
    const bool reversed = joint.first.link == edge.child;
    const Posed X_WF = AnchorPose(joint.first);
    const Posed X_WM = AnchorPose(joint.second);
    const Wrenchd outboard = FromSimTK(reactions[bodies[edge.child].getMobilizedBodyIndex()]);
    const Wrenchd on_second = reversed ? -outboard.ShiftedBy(X_WF.p - X_WM.p) : outboard;
    answer->joints[edge.joint] = on_second.In(X_WF.R);
  }
}

// Constraint forces are given at body origins, in ground axes, with the sign of the left-hand side.
void SimbodyModel::Implementation::ReadLoopWrenches(SimbodyAnswer* answer) const {
  for (const LoopEquation& equation : loop_equations) {
    if (equation.constraint.isDisabled(state)) continue;
    const Joint& joint = mechanism.joints[equation.joint];
    const Posed X_WF = AnchorPose(joint.first);
    const Posed X_WM = AnchorPose(joint.second);
    const Vector3d p_WLo = FromSimTK(bodies[joint.second.link].getBodyOriginLocation(state));
    const SpatialVec force =
        equation.constraint.getConstrainedBodyForcesAsVector(state)[equation.second];
    answer->joints[equation.joint] -= FromSimTK(force).ShiftedBy(p_WLo - X_WM.p).In(X_WF.R);
  }
}

void SimbodyModel::Implementation::ReadMotion(SimbodyAnswer* answer) const {
  for (size_t i = 0; i < bodies.size(); ++i) {
    const SpatialVec& A = bodies[i].getBodyAcceleration(state);
    answer->accelerations[i] = {FromSimTK(A[1]), FromSimTK(A[0])};
  }
}

// The forces of prescribed motion too have the sign of the left-hand side.
void SimbodyModel::Implementation::ReadDrives(const SimbodyQuery& query, SimbodyAnswer* answer) {
  if (mode == DriveMode::kForce) {
    answer->drive_forces = query.drives;
    return;
  }
  matter.findMotionForces(state, motion_forces);
  for (size_t i = 0; i < drives.size(); ++i) {
    const auto u = SpeedIndex(mechanism.joints[drives[i].joint].type, drives[i].freedom);
    answer->drive_forces[i] =
        -bodies[driven_links[i]].getOneFromUPartition(state, u, motion_forces);
  }
}

SimbodyModel::SimbodyModel(const Mechanism& mechanism, std::vector<JointFreedom> drives,
                           DriveMode mode)
    : implementation_(std::make_unique<Implementation>(mechanism, std::move(drives), mode)) {}

SimbodyModel::~SimbodyModel() = default;
SimbodyModel::SimbodyModel(SimbodyModel&&) noexcept = default;
SimbodyModel& SimbodyModel::operator=(SimbodyModel&&) noexcept = default;

int SimbodyModel::DropRedundantEquations(const std::vector<LinkMotion>& links) {
  constexpr double kDependent = 1e-9;  // pivot, relative to the largest, of a dependent equation
  Implementation& s = *implementation_;
  for (const auto& equation : s.loop_equations) equation.constraint.enable(s.state);
  s.system.realizeModel(s.state);
  s.SetState(links);
  s.system.realize(s.state, SimTK::Stage::Velocity);

  // Position equations come first among the rows of G, in the order in which they were made.
  SimTK::Matrix G;
  s.matter.calcG(s.state, G);
  MatrixXd columns(G.ncol(), static_cast<int>(s.loop_equations.size()));
  for (int i = 0; i < columns.cols(); ++i) {
    for (int j = 0; j < columns.rows(); ++j) columns(j, i) = G(i, j);
  }
  Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  qr.setThreshold(kDependent);
  const int rank = static_cast<int>(qr.rank());
  for (int i = rank; i < columns.cols(); ++i) {
    s.loop_equations[qr.colsPermutation().indices()[i]].constraint.disable(s.state);
  }
  s.system.realizeModel(s.state);
  return rank;
}

bool SimbodyModel::IsTreeJoint(int joint) const {
  const auto& tree = implementation_->tree;
  return std::any_of(tree.begin(), tree.end(),
                     [joint](const TreeJoint& edge) { return edge.joint == joint; });
}

void SimbodyModel::Evaluate(const SimbodyQuery& query, SimbodyAnswer* answer) {
  Implementation& s = *implementation_;
  answer->joints.assign(s.mechanism.joints.size(), Wrenchd{});
  answer->accelerations.resize(s.bodies.size());
  answer->drive_forces.resize(s.drives.size());
  s.SetState(query.links);
  s.SetForces(query);
  s.system.realize(s.state, SimTK::Stage::Acceleration);
  s.CompareState(query.links, answer);
  s.ReadTreeWrenches(answer);
  s.ReadLoopWrenches(answer);
  s.ReadMotion(answer);
  s.ReadDrives(query, answer);
}

void SimbodyModel::Accelerate() {
  Implementation& s = *implementation_;
  s.state.invalidateAllCacheAtOrAbove(SimTK::Stage::Position);
  s.system.realize(s.state, SimTK::Stage::Acceleration);
}

SimbodyAnswer SimbodyModel::Evaluate(const SimbodyQuery& query) {
  SimbodyAnswer answer;
  Evaluate(query, &answer);
  return answer;
}

}  // namespace vmech::peers
