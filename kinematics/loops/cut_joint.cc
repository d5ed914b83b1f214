#include "vmech/kinematics/loops/cut_joint.h"

#include <Eigen/Geometry>

#include <algorithm>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

/// Is a freedom of a cut joint an angle of which only the part within a turn is seen?
bool CountsTurns(JointType type, int freedom) {
  if (type == JointType::kSpherical || type == JointType::kScrew) return false;
  return freedom < FreedomsOf(type) && FreedomsOfType(type).rotates[freedom];
}

/// Of numbers with slopes.
template <typename T>
requires(kIsDual<T> || kIsTaped<T>) Vector3<T> RotationVector(const Matrix3<T>& R) {
  const Vector3<T> sine = 0.5 * Vector3<T>(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const T cosine = 0.5 * (R.trace() - 1.0), square = sine.squaredNorm(), zero(0);
  const T size = sqrt(square);
  return Select(square > zero, T(atan2(size, cosine) / size), T(1)) * sine;
}

template <typename T>
Vector3<T> RotationVector(const Matrix3<T>& R) {
  Vector3<T> turn;
  Vector3d lanes[kLanesOf<T>];
  for (int lane = 0; lane < kLanesOf<T>; ++lane) {
    const Eigen::AngleAxisd rotation(Lane(R, lane));
    lanes[lane] = rotation.angle() * rotation.axis();
  }
  for (int k = 0; k < 3; ++k) turn[k] = FromLanes<T>([&](int lane) { return lanes[lane][k]; });
  return turn;
}

/// Twist of M in F, axes of F, about the origin of M.
template <typename T>
Vector6<T> TwistInJoint(const LoopState<T>& s, const ScrewT<T>& V_rel) {
  const Triple<T> linear = VelocityAt(s.F.p, V_rel);
  return Vector6Of(ScrewT<T>{InverseRotate(s.F, linear), InverseRotate(s.F, V_rel.angular)});
}

/// The shares of a twist of M in F along the freedoms of a cut joint.
template <typename T>
Vector3<T> AlongFreedoms(const Loop& loop, const LoopState<T>& state, const Vector6<T>& twist_F) {
  const CutJointFreedoms<T> freedoms = FreedomsOfCutJoint(loop, state);
  Vector3<T> shares = Vector3<T>::Zero();
  for (int i = 0; i < freedoms.count; ++i) {
    shares[i] = freedoms.twist_F[i].dot(twist_F) / freedoms.twist_F[i].squaredNorm();
  }
  return shares;
}

}  // namespace

template <typename T>
Vector3<T> CutJointCoordinates(const Loop& loop, const LoopState<T>& state) {
  using std::atan2;
  const Matrix3<T>& R = state.R_FM;
  const Vector3<T>& p = state.p_FM;
  const T zero(0);
  switch (loop.type) {
    case JointType::kRevolute:
      return {TurnAboutZ(R), zero, zero};
    case JointType::kPrismatic:
      return {p.z(), zero, zero};
    case JointType::kCylindrical:
      return {p.z(), TurnAboutZ(R), zero};
    case JointType::kScrew:
      return {ScrewTurn<T>(R, p.z(), state.pitch), zero, zero};
    case JointType::kUniversal:
      return {atan2(R(2, 1), R(1, 1)), atan2(R(0, 2), R(0, 0)), zero};
    case JointType::kSpherical:
      return RotationVector(R);
    case JointType::kPlanar:
      return {p.x(), p.y(), TurnAboutZ(R)};
    case JointType::kWeld:
      break;
  }
  return Vector3<T>::Zero();
}

template <typename T>
CutJointFreedoms<T> FreedomsOfCutJoint(const Loop& loop, const LoopState<T>& state) {
  const Vector3<T> zero = Vector3<T>::Zero();
  auto twist = [](const Vector3<T>& linear, const Vector3<T>& angular) {
    Vector6<T> V;
    V << linear, angular;
    return V;
  };
  auto along = [&](const Vector3<T>& axis) { return twist(axis, zero); };
  auto about = [&](const Vector3<T>& axis) { return twist(zero, axis); };
  const Vector3<T> x = Vector3<T>::UnitX(), y = Vector3<T>::UnitY(), z = Vector3<T>::UnitZ();
  switch (loop.type) {
    case JointType::kRevolute:
      return {1, {about(z)}};
    case JointType::kPrismatic:
      return {1, {along(z)}};
    case JointType::kCylindrical:
      return {2, {along(z), about(z)}};
    case JointType::kScrew:
      return {1, {twist(state.pitch * z, z)}};
    case JointType::kUniversal:
      return {2, {about(x), about(state.R_FM.col(1))}};
    case JointType::kSpherical:
      return {3, {about(state.R_FM.col(0)), about(state.R_FM.col(1)), about(state.R_FM.col(2))}};
    case JointType::kPlanar:
      return {3, {along(x), along(y), about(z)}};
    case JointType::kWeld:
      break;
  }
  return {};
}

template <typename T>
Vector3<T> CutJointRates(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop) {
  const LoopState<T>& s = ws.loops[loop];
  const JointPlacement& place = tree.placements[tree.loops[loop].joint];
  const ScrewT<T> V_rel = ws.at(place.second_node).V - ws.at(place.first_node).V;
  return AlongFreedoms<T>(tree.loops[loop], s, TwistInJoint<T>(s, V_rel));
}

template <typename T>
Vector3<T> CutJointAccelerations(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop) {
  const LoopState<T>& s = ws.loops[loop];
  const JointPlacement& place = tree.placements[tree.loops[loop].joint];
  const typename TreeWorkspace<T>::Node &A = ws.at(place.first_node), &B = ws.at(place.second_node);
  const ScrewT<T> V_rel = B.V - A.V;
  ScrewT<T> A_rel = B.A - A.A - CarriedTwist(A.V, V_rel);
  A_rel.linear += Cross(V_rel.angular, VelocityAt(s.F.p, V_rel));  // since M moves on in F
  return AlongFreedoms<T>(tree.loops[loop], s, TwistInJoint<T>(s, A_rel));
}

std::vector<Vector3d> StartCutPositions(const KinematicTree& tree) {
  std::vector<Vector3d> positions(tree.loops.size(), Vector3d::Zero());
  for (size_t l = 0; l < positions.size(); ++l) {
    const Joint& joint = tree.mechanism.joints[tree.loops[l].joint];
    if (joint.type == JointType::kSpherical) continue;
    std::copy(joint.start.begin(), joint.start.end(), positions[l].data());
  }
  return positions;
}

void ContinueCutPosition(JointType type, const Vector3d& now, Vector3d* position) {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int k = 0; k < 3; ++k) {
    const double turns = CountsTurns(type, k) ? std::round(((*position)[k] - now[k]) / kTurn) : 0;
    (*position)[k] = now[k] + turns * kTurn;
  }
}

void ContinueCutPositions(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                          std::vector<Vector3d>* positions) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    ContinueCutPosition(loop.type, CutJointCoordinates(loop, ws.loops[l]), &(*positions)[l]);
  }
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                \
  template Vector3<T> CutJointCoordinates<T>(const Loop&, const LoopState<T>&);             \
  template CutJointFreedoms<T> FreedomsOfCutJoint<T>(const Loop&, const LoopState<T>&);     \
  template Vector3<T> CutJointRates<T>(const KinematicTree&, const TreeWorkspace<T>&, int); \
  template Vector3<T> CutJointAccelerations<T>(const KinematicTree&, const TreeWorkspace<T>&, int);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
