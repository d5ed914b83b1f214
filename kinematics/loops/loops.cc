#include "vmech/kinematics/loops/loops.h"

#include <cmath>
#include <numbers>

#include "vmech/base/packet.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/jacobian.h"

namespace vmech {
namespace {

/// The same vector times 2 sin(angle/2)/sin(angle), where cosine = cos(angle).
template <typename T>
Vector3<T> ChordFromSine(const Vector3<T>& sine, const T& cosine) {
  using std::sqrt;
  constexpr double kHalfTurnGuard = 1e-300;  // keeps an exact half turn finite
  return sine * sqrt(2.0 / (1.0 + cosine + kHalfTurnGuard));
}

/// The rotation from F to M that the joint does not allow, in axes of F.
template <typename T>
Vector3<T> ForbiddenRotation(JointType type, const Matrix3<T>& R) {
  switch (type) {
    case JointType::kPrismatic:
    case JointType::kWeld: {
      const Vector3<T> sine =
          0.5 * Vector3<T>(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
      return ChordFromSine<T>(sine, 0.5 * (R.trace() - 1.0));
    }
    case JointType::kSpherical:
    case JointType::kUniversal:
      return Vector3<T>::Zero();
    default:
      return ChordFromSine<T>(Vector3<T>(-R(1, 2), R(0, 2), T(0)), R(2, 2));
  }
}

template <typename T>
T TurnAboutZ(const Matrix3<T>& R_FM) {
  using std::atan2;
  return atan2(R_FM(1, 0) - R_FM(0, 1), R_FM(0, 0) + R_FM(1, 1));
}

/// The turn of a screw joint; whole turns are told by the travel.
template <typename T>
T ScrewTurn(const Matrix3<T>& R_FM, const T& travel, double pitch) {
  using std::round;
  constexpr double kTurn = 2 * std::numbers::pi;
  const T angle = TurnAboutZ(R_FM);
  return angle + kTurn * round((travel / pitch - angle) / kTurn);
}

/// Is the joint assembled more than a quarter turn from where it belongs, so that small errors mean
/// nothing?
template <typename T>
auto FacesBackwards(const Loop& loop, const LoopState<T>& state) {
  switch (loop.type) {
    case JointType::kSpherical:
    case JointType::kUniversal:
      return T(0) > T(1);
    case JointType::kPrismatic:
    case JointType::kWeld:
      return state.R_FM.trace() < T(1);
    default:
      return state.R_FM(2, 2) < T(0);
  }
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

/// Velocity, angular velocity and acceleration of a point Q of the world that moves with a node.
template <typename T>
struct PointMotion {
  Vector3<T> w, v, alpha, a;
};

template <typename T>
PointMotion<T> MotionAt(const TreeWorkspace<T>& ws, int node, const Vector3<T>& p_WQ) {
  const Vector3<T> zero = Vector3<T>::Zero();
  if (node < 0) return {zero, zero, zero, zero};
  const NodeState<T>& s = ws.nodes[node];
  const Vector3<T> r = p_WQ - s.X_WB.p;
  return {s.w, s.v + s.w.cross(r), s.alpha, s.a + s.alpha.cross(r) + s.w.cross(s.w.cross(r))};
}

}  // namespace

template <typename T>
void LoopError(const Loop& loop, const Matrix3<T>& R_FM, const Vector3<T>& p_FM,
               LoopState<T>* state) {
  LoopState<T>& s = *state;
  s.R_FM = R_FM;
  const Vector3<T> y_M = R_FM.col(1);
  s.n_F = y_M.cross(Vector3<T>::UnitX());
  // e2 = C dq moves M back to where it belongs in F.
  s.e2 = -ProjectOnRows<T>(loop, s, p_FM, ForbiddenRotation<T>(loop.type, R_FM));
  if (loop.type == JointType::kUniversal) s.e2[3] = -y_M.x();
  if (loop.type == JointType::kScrew) {
    s.e2[4] = loop.pitch * ScrewTurn<T>(R_FM, p_FM.z(), loop.pitch) - p_FM.z();
  }
}

template <typename T>
void LoopErrors(const KinematicTree& tree, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const JointPlacement& place = tree.placements[loop.joint];
    LoopState<T>& s = ws->loops[l];
    const Pose<T> X_WF = PoseInWorld(*ws, place.first_node, place.X_AF);
    const Pose<T> X_WM = PoseInWorld(*ws, place.second_node, place.X_BM);
    s.R_WF = X_WF.R;
    s.p_WM = X_WM.p;
    s.p_FM_W = X_WM.p - X_WF.p;
    LoopError<T>(loop, X_WF.R.transpose() * X_WM.R, X_WF.R.transpose() * s.p_FM_W, &s);
  }
}

template <typename T>
void LoopJacobian(const KinematicTree& tree, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const LoopState<T>& s = ws->loops[l];
    Vector6<T>* column = &ws->loop_columns[ws->first_column[l]];
    for (const LoopColumn& c : loop.columns) {
      const Vector6<T> V = UnitTwistAt(tree, *ws, c.node, c.axis, s.p_WM);
      *column++ = ProjectOnRows<T>(loop, s, c.sign * (s.R_WF.transpose() * V.template head<3>()),
                                   c.sign * (s.R_WF.transpose() * V.template tail<3>()));
    }
  }
}

template <typename T>
void LoopAccelerationBias(const KinematicTree& tree, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const JointPlacement& place = tree.placements[loop.joint];
    LoopState<T>& s = ws->loops[l];
    const PointMotion<T> A = MotionAt(*ws, place.first_node, s.p_WM);
    const PointMotion<T> B = MotionAt(*ws, place.second_node, s.p_WM);
    // Second derivatives as an observer on F sees them.
    const Vector3<T> w_rel = B.w - A.w;
    const Vector3<T> linear = B.a - A.a - 2.0 * A.w.cross(B.v - A.v);
    const Vector3<T> angular = B.alpha - A.alpha - A.w.cross(w_rel);
    s.bias = ProjectOnRows<T>(loop, s, s.R_WF.transpose() * linear, s.R_WF.transpose() * angular);
    if (loop.type == JointType::kUniversal) {
      // n = y_M x x_F turns in F.
      const Vector3<T> w_F = s.R_WF.transpose() * w_rel;
      s.bias[3] += w_F.cross(s.R_FM.col(1)).cross(Vector3<T>::UnitX()).dot(w_F);
    }
  }
}

template <typename T>
Vector3<T> CutJointCoordinates(const Loop& loop, const LoopState<T>& state) {
  using std::atan2;
  const Matrix3<T>& R = state.R_FM;
  const Vector3<T> p = state.R_WF.transpose() * state.p_FM_W;
  const T zero(0);
  switch (loop.type) {
    case JointType::kRevolute:
      return {TurnAboutZ(R), zero, zero};
    case JointType::kPrismatic:
      return {p.z(), zero, zero};
    case JointType::kCylindrical:
      return {p.z(), TurnAboutZ(R), zero};
    case JointType::kScrew:
      return {ScrewTurn<T>(R, p.z(), loop.pitch), zero, zero};
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
      return {1, {twist(loop.pitch * z, z)}};
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
Vector3<T> CutJointRates(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop_index) {
  const Loop& loop = tree.loops[loop_index];
  const LoopState<T>& s = ws.loops[loop_index];
  const JointPlacement& place = tree.placements[loop.joint];
  const Vector6<T> V_W =
      PointTwist(ws, place.second_node, s.p_WM) - PointTwist(ws, place.first_node, s.p_WM);
  Vector6<T> V_FM;
  V_FM << s.R_WF.transpose() * V_W.template head<3>(), s.R_WF.transpose() * V_W.template tail<3>();
  const CutJointFreedoms<T> freedoms = FreedomsOfCutJoint(loop, s);
  Vector3<T> rates = Vector3<T>::Zero();
  for (int i = 0; i < freedoms.count; ++i) {
    rates[i] = freedoms.twist_F[i].dot(V_FM) / freedoms.twist_F[i].squaredNorm();
  }
  return rates;
}

MatrixXd DenseLoopJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws) {
  MatrixXd C = MatrixXd::Zero(tree.rows, tree.nv);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const Vector6d* column = &ws.loop_columns[ws.first_column[l]];
    for (const LoopColumn& c : loop.columns) {
      C.block(loop.row, c.v, loop.rows, 1) = (column++)->head(loop.rows);
    }
  }
  return C;
}

VectorXd StackedLoopErrors(const KinematicTree& tree, const TreeWorkspace<double>& ws) {
  VectorXd e2(tree.rows);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    e2.segment(tree.loops[l].row, tree.loops[l].rows) = ws.loops[l].e2.head(tree.loops[l].rows);
  }
  return e2;
}

VectorXd LoopRowScale(const KinematicTree& tree) {
  VectorXd scale = VectorXd::Ones(tree.rows);
  for (const Loop& loop : tree.loops) {
    for (int i = 0; i < loop.rows; ++i) {
      if (IsLengthRow(loop.type, i)) scale[loop.row + i] = 1 / tree.length;
    }
  }
  return scale;
}

template <typename T>
T LargestLoopError(const KinematicTree& tree, const TreeWorkspace<T>& ws) {
  using std::abs;
  using std::max;
  const double per_length = 1 / tree.length;
  T largest(0);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    for (int i = 0; i < loop.rows; ++i) {
      const T error = abs(ws.loops[l].e2[i]);
      largest = max(largest, IsLengthRow(loop.type, i) ? per_length * error : error);
    }
    largest = Select(FacesBackwards(loop, ws.loops[l]), max(largest, T(2)), largest);
  }
  return largest;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                    \
  template void LoopError<T>(const Loop&, const Matrix3<T>&, const Vector3<T>&, LoopState<T>*); \
  template void LoopErrors<T>(const KinematicTree&, TreeWorkspace<T>*);                         \
  template void LoopJacobian<T>(const KinematicTree&, TreeWorkspace<T>*);                       \
  template void LoopAccelerationBias<T>(const KinematicTree&, TreeWorkspace<T>*);               \
  template Vector3<T> CutJointCoordinates<T>(const Loop&, const LoopState<T>&);                 \
  template CutJointFreedoms<T> FreedomsOfCutJoint<T>(const Loop&, const LoopState<T>&);         \
  template Vector3<T> CutJointRates<T>(const KinematicTree&, const TreeWorkspace<T>&, int);     \
  template T LargestLoopError<T>(const KinematicTree&, const TreeWorkspace<T>&);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Packet)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
