#include "vmech/kinematics/loops/loops.h"

#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/kinematics/loops/cut_joint.h"

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
ScrewT<T> ForceAlong(const Triple<T>& axis, const Triple<T>& p_WM) {
  return {axis, Cross(p_WM, axis)};
}

template <typename T>
ScrewT<T> MomentAbout(const Triple<T>& axis) {
  return {ZeroTriple<T>(), axis};
}

}  // namespace

template <typename T>
void LoopError(const Loop& loop, const Matrix3<T>& R_FM, const Vector3<T>& p_FM,
               LoopState<T>* state) {
  LoopState<T>& s = *state;
  s.R_FM = R_FM;
  s.p_FM = p_FM;
  const Vector3<T> y_M = R_FM.col(1);
  s.n_F = y_M.cross(Vector3<T>::UnitX());
  // e2 = C dq moves M back to where it belongs in F.
  s.e2 = -ProjectOnRows<T>(loop, s, p_FM, ForbiddenRotation<T>(loop.type, R_FM));
  if (loop.type == JointType::kUniversal) s.e2[3] = -y_M.x();
  if (loop.type == JointType::kScrew) {
    s.e2[4] = s.pitch * ScrewTurn<T>(R_FM, p_FM.z(), s.pitch) - p_FM.z();
  }
}

template <typename T>
void LoopErrors(const KinematicTree& tree, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const JointPlacement& place = tree.placements[loop.joint];
    const typename TreeWorkspace<T>::Placement& anchors = ws->placements[loop.joint];
    LoopState<T>& s = ws->loops[l];
    s.F = ws->at(place.first_node).X * anchors.X_AF;
    const FrameT<T> M = ws->at(place.second_node).X * anchors.X_BM;
    const Triple<T> p_FM = InverseRotate(s.F, M.p - s.F.p);
    const FrameT<T> R_FM{InverseRotate(s.F, M.x), InverseRotate(s.F, M.y), InverseRotate(s.F, M.z)};
    LoopError<T>(loop, RotationOf(R_FM), Vector3Of(p_FM), &s);
    s.F.p = M.p;
  }
}

template <typename T>
void FindLoopWrenches(const Loop& loop, const FrameT<T>& turns, LoopState<T>* s) {
  const FrameT<T>& F = s->F;
  ScrewT<T>* row = s->wrench;
  const auto forces = [&](auto... axes) { ((*row++ = ForceAlong<T>(axes, F.p)), ...); };
  const auto moments = [&](auto... axes) { ((*row++ = MomentAbout<T>(axes)), ...); };
  switch (loop.type) {
    case JointType::kRevolute:
      forces(F.x, F.y, F.z);
      return moments(turns.x, turns.y);
    case JointType::kPrismatic:
      forces(F.x, F.y);
      return moments(turns.x, turns.y, turns.z);
    case JointType::kCylindrical:
      forces(F.x, F.y);
      return moments(turns.x, turns.y);
    case JointType::kScrew:
      forces(F.x, F.y);
      moments(turns.x, turns.y);
      *row = ForceAlong<T>(F.z, F.p) - s->pitch * MomentAbout<T>(turns.z);
      return;
    case JointType::kUniversal:
      forces(F.x, F.y, F.z);
      return moments(Rotate(F, s->n_F[0], s->n_F[1], s->n_F[2]));
    case JointType::kSpherical:
      return forces(F.x, F.y, F.z);
    case JointType::kPlanar:
      forces(F.z);
      return moments(turns.x, turns.y);
    case JointType::kWeld:
      forces(F.x, F.y, F.z);
      return moments(turns.x, turns.y, turns.z);
  }
}

template <typename T>
void LoopWrenches(const KinematicTree& tree, const double* row_scale, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    LoopState<T>& s = ws->loops[l];
    FindLoopWrenches<T>(loop, s.F, &s);
    for (int k = 0; row_scale && k < loop.rows; ++k) {
      s.wrench[k] = row_scale[loop.row + k] * s.wrench[k];
    }
  }
}

template <typename T>
void LoopJacobian(const KinematicTree& tree, TreeWorkspace<T>* ws) {
  LoopWrenches<T>(tree, nullptr, ws);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const LoopState<T>& s = ws->loops[l];
    Vector6<T>* column = &ws->loop_columns[ws->first_column[l]];
    for (const LoopColumn& c : loop.columns) {
      const ScrewT<T> S = c.sign * ws->S[c.v];
      for (int k = 0; k < loop.rows; ++k) (*column)[k] = Power(s.wrench[k], S);
      ++column;
    }
  }
}

template <typename T>
void LoopBias(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop_index, double s,
              T* bias) {
  const Loop& loop = tree.loops[loop_index];
  const LoopState<T>& state = ws.loops[loop_index];
  const JointPlacement& place = tree.placements[loop.joint];
  const auto &A = ws.at(place.first_node), &B = ws.at(place.second_node);
  // The rate of M's twist in F as an observer on F sees it.
  const ScrewT<T> V_rel = B.V - A.V;
  const ScrewT<T> rate = s * (B.A - A.A - CarriedTwist(A.V, V_rel));
  for (int k = 0; k < loop.rows; ++k) bias[k] = Power(state.wrench[k], rate);
  if (loop.type == JointType::kUniversal) {
    // n = y_M x x_F turns in F.
    const Vector3<T> y = state.R_FM.col(1);
    const Triple<T> y_M = Rotate(state.F, y[0], y[1], y[2]);
    bias[3] += s * Dot(Cross(Cross(V_rel.angular, y_M), state.F.x), V_rel.angular);
  }
}

template <typename T>
void LoopAccelerationBias(const KinematicTree& tree, TreeWorkspace<T>* ws) {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    ws->loops[l].bias.setZero();  // behind the last of the rows, too
    LoopBias(tree, *ws, static_cast<int>(l), 1, ws->loops[l].bias.data());
  }
}

template <typename T>
ScrewT<T> LoopWrench(const Loop& loop, const LoopState<T>& state, const T* mu) {
  ScrewT<T> W;
  for (int k = 0; k < loop.rows; ++k) W += mu[k] * state.wrench[k];
  return W;
}

Wrenchd WrenchOfMultipliers(const Loop& loop, const LoopState<double>& state, const double* mu) {
  constexpr double zero = 0;
  switch (loop.type) {
    case JointType::kRevolute:
      return {{mu[0], mu[1], mu[2]}, {mu[3], mu[4], zero}};
    case JointType::kPrismatic:
      return {{mu[0], mu[1], zero}, {mu[2], mu[3], mu[4]}};
    case JointType::kCylindrical:
      return {{mu[0], mu[1], zero}, {mu[2], mu[3], zero}};
    case JointType::kScrew:
      return {{mu[0], mu[1], mu[4]}, {mu[2], mu[3], -state.pitch * mu[4]}};
    case JointType::kUniversal:
      return {{mu[0], mu[1], mu[2]}, state.n_F * mu[3]};
    case JointType::kSpherical:
      return {{mu[0], mu[1], mu[2]}, {zero, zero, zero}};
    case JointType::kPlanar:
      return {{zero, zero, mu[0]}, {mu[1], mu[2], zero}};
    case JointType::kWeld:
      return {{mu[0], mu[1], mu[2]}, {mu[3], mu[4], mu[5]}};
  }
  return {};
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

template <typename T>
LoopOpening LargestOpening(const KinematicTree& tree, const TreeWorkspace<T>& ws) {
  LoopOpening largest;
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    for (int i = 0; i < loop.rows; ++i) {
      const double scale = IsLengthRow(loop.type, i) ? 1 / tree.length : 1.0;
      for (int lane = 0; lane < kLanesOf<T>; ++lane) {
        const double slope = scale * std::abs(Lane(ws.loops[l].e2[i].slope, lane));
        if (slope > largest.slope) largest = {slope, static_cast<int>(l)};
      }
    }
  }
  return largest;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                    \
  template void LoopError<T>(const Loop&, const Matrix3<T>&, const Vector3<T>&, LoopState<T>*); \
  template void LoopErrors<T>(const KinematicTree&, TreeWorkspace<T>*);                         \
  template void LoopJacobian<T>(const KinematicTree&, TreeWorkspace<T>*);                       \
  template void FindLoopWrenches<T>(const Loop&, const FrameT<T>&, LoopState<T>*);              \
  template void LoopWrenches<T>(const KinematicTree&, const double*, TreeWorkspace<T>*);        \
  template void LoopBias<T>(const KinematicTree&, const TreeWorkspace<T>&, int, double, T*);    \
  template void LoopAccelerationBias<T>(const KinematicTree&, TreeWorkspace<T>*);               \
  template ScrewT<T> LoopWrench<T>(const Loop&, const LoopState<T>&, const T*);                 \
  template T LargestLoopError<T>(const KinematicTree&, const TreeWorkspace<T>&);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
template LoopOpening LargestOpening<Dual>(const KinematicTree&, const TreeWorkspace<Dual>&);
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
