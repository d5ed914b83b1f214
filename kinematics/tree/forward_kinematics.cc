#include "vmech/kinematics/tree/forward_kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "vmech/base/packet.h"

namespace vmech {
namespace {

void TakeSines(const KinematicTree& tree, const Packet* q, TreeWorkspace<Packet>* ws) {
  for (size_t k = 0; k < tree.turning.size(); ++k) {
    SinCos(q[tree.turning[k]], &ws->sine[k], &ws->cosine[k]);
  }
}

void TakeSines(const KinematicTree& tree, const double* q, TreeWorkspace<double>* ws) {
  Sines(tree, q, ws->sine.data(), ws->cosine.data());
}

/// R Rz(angle).
template <typename T>
Matrix3<T> TurnedAboutZ(const Matrix3<T>& R, const T& s, const T& c) {
  Matrix3<T> turned;
  turned.col(0) = c * R.col(0) + s * R.col(1);
  turned.col(1) = c * R.col(1) - s * R.col(0);
  turned.col(2) = R.col(2);
  return turned;
}

/// The relative velocity of a node in its parent, world axes.
template <typename T>
struct RelativeMotion {
  Vector3<T> angular = Vector3<T>::Zero();
  Vector3<T> linear = Vector3<T>::Zero();  ///< of Bo
};

template <typename T>
Vector3<T> SphericalRate(const TreeNode& node, const Matrix3<T>& R_WB, const Matrix3<T>& R_WP,
                         const T* v) {
  const Vector3<T> rate(v[node.v], v[node.v + 1], v[node.v + 2]);
  if (!node.reversed) return R_WB * rate;
  // v is the rate of M in F, in axes of M, which now is fixed in the parent; the child moves back.
  return -(R_WP * (node.X_PF.R.cast<T>() * rate));
}

template <typename T>
RelativeMotion<T> MotionAcross(const TreeNode& node, const Pose<T>& X_WB, const Matrix3<T>& R_WP,
                               const T* v) {
  RelativeMotion<T> motion;
  switch (node.motion) {
    case NodeMotion::kFixed:
      break;
    case NodeMotion::kRevolute:
      motion.angular = v[node.v] * X_WB.R.col(2);
      break;
    case NodeMotion::kPrismatic:
      motion.linear = v[node.v] * X_WB.R.col(2);
      break;
    case NodeMotion::kScrew:
      motion.angular = v[node.v] * X_WB.R.col(2);
      motion.linear = node.pitch * motion.angular;
      break;
    case NodeMotion::kSpherical:
      motion.angular = SphericalRate(node, X_WB.R, R_WP, v);
      break;
  }
  return motion;
}

}  // namespace

void Sines(const KinematicTree& tree, const double* q, double* sine, double* cosine) noexcept {
  const int* turning = tree.turning.data();
  const int count = static_cast<int>(tree.turning.size());
  for (int k = 0; k < count; k += Packet::kLanes) {
    // Number by number: loading four at once would wait for the last of them to be written.
    const auto angle = [&](int lane) { return q[turning[std::min(k + lane, count - 1)]]; };
    Packet s, c;
    SinCos(Packet::Of(angle), &s, &c);
    std::memcpy(sine + k, &s, sizeof(s));
    std::memcpy(cosine + k, &c, sizeof(c));
  }
}

template <typename T>
void ForwardKinematics(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws) {
  TakeSines(tree, q, ws);
  const T *sine = ws->sine.data(), *cosine = ws->cosine.data();
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    Pose<T>& X = ws->nodes[i].X_WB;
    X = PoseInWorld(*ws, node.parent, node.X_PF);
    switch (node.motion) {
      case NodeMotion::kFixed:
        break;
      case NodeMotion::kRevolute:
        X.R = TurnedAboutZ(X.R, *sine++, *cosine++);
        break;
      case NodeMotion::kPrismatic:
        X.p += q[node.q] * X.R.col(2);
        break;
      case NodeMotion::kScrew:
        X.p += (node.pitch * q[node.q]) * X.R.col(2);
        X.R = TurnedAboutZ(X.R, *sine++, *cosine++);
        break;
      case NodeMotion::kSpherical: {
        const Matrix3<T> R_FM = RotationOf(q + node.q);
        X.R = node.reversed ? Matrix3<T>(X.R * R_FM.transpose()) : Matrix3<T>(X.R * R_FM);
        break;
      }
    }
  }
}

template <typename T>
void ForwardVelocities(const KinematicTree& tree, const T* v, TreeWorkspace<T>* ws) {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    NodeState<T>& s = ws->nodes[i];
    if (node.parent < 0) {
      const RelativeMotion<T> m = MotionAcross<T>(node, s.X_WB, Matrix3<T>::Identity(), v);
      s.w = m.angular;
      s.v = m.linear;
      continue;
    }
    const NodeState<T>& parent = ws->nodes[node.parent];
    const RelativeMotion<T> m = MotionAcross<T>(node, s.X_WB, parent.X_WB.R, v);
    s.w = parent.w + m.angular;
    s.v = parent.v + parent.w.cross(s.X_WB.p - parent.X_WB.p) + m.linear;
  }
}

template <typename T>
void ForwardAccelerations(const KinematicTree& tree, const T* v, const T* vdot,
                          TreeWorkspace<T>* ws) {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    NodeState<T>& s = ws->nodes[i];
    const Matrix3<T> R_WP =
        node.parent < 0 ? Matrix3<T>(Matrix3<T>::Identity()) : ws->nodes[node.parent].X_WB.R;
    RelativeMotion<T> rate;
    if (vdot != nullptr) rate = MotionAcross<T>(node, s.X_WB, R_WP, vdot);
    if (node.parent < 0) {
      s.alpha = rate.angular;
      s.a = rate.linear;
      continue;
    }
    // The joint's axis is carried by the parent: w_P x (relative velocity), twice (Coriolis) for
    // the linear part. The same holds for a spherical joint, because w_rel x w_rel = 0.
    const NodeState<T>& parent = ws->nodes[node.parent];
    const RelativeMotion<T> m = MotionAcross<T>(node, s.X_WB, R_WP, v);
    const Vector3<T> r = s.X_WB.p - parent.X_WB.p;
    s.alpha = parent.alpha + rate.angular + parent.w.cross(m.angular);
    s.a = parent.a + parent.alpha.cross(r) + parent.w.cross(parent.w.cross(r) + 2.0 * m.linear) +
          rate.linear;
  }
}

template <typename T>
void MoveCoordinates(const KinematicTree& tree, const T* dv, T* q) {
  using std::abs;
  using std::sqrt;
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    if (node.motion != NodeMotion::kSpherical) {
      q[node.q] += dv[node.v];
      continue;
    }
    const Vector3<T> turn(dv[node.v], dv[node.v + 1], dv[node.v + 2]);
    const T angle2 = turn.squaredNorm();
    T per_angle, cosine;  // sin(angle/2)/angle and cos(angle/2)
    // Short cuts of a single pose: what decides for four lanes must not depend on all of them.
    constexpr bool kSingle = kLanesOf<T> == 1;
    if (kSingle && AllLanes(angle2 <= T(0.01))) {
      const T x = 0.25 * angle2;
      per_angle = 0.5 - x * (1.0 / 12 - x * (1.0 / 240 - x * (1.0 / 10080 - x * (1.0 / 725760))));
      cosine = 1.0 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720 - x * (1.0 / 40320))));
    } else {
      const T angle = sqrt(angle2);
      T sine;
      SinCos(0.5 * angle, &sine, &cosine);
      per_angle = Select(angle > T(1e-8), sine / angle, T(0.5));
    }
    const Vector3<T> e = per_angle * turn;
    T* wxyz = q + node.q;
    const T w = wxyz[0];
    const Vector3<T> xyz(wxyz[1], wxyz[2], wxyz[3]);
    const T w_next = w * cosine - xyz.dot(e);
    const Vector3<T> xyz_next = w * e + cosine * xyz + xyz.cross(e);
    const T length2 = w_next * w_next + xyz_next.squaredNorm();
    const T excess = length2 - 1.0;
    const bool nearly = kSingle && AllLanes(abs(excess) <= T(1e-8));
    const T per_length = nearly ? 1.0 - 0.5 * excess : 1.0 / sqrt(length2);
    wxyz[0] = per_length * w_next;
    for (int k = 0; k < 3; ++k) wxyz[1 + k] = per_length * xyz_next[k];
  }
}

void MoveCoordinates(const KinematicTree& tree, const VectorXd& dv, VectorXd* q) {
  MoveCoordinates(tree, dv.data(), q->data());
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                             \
  template void ForwardKinematics<T>(const KinematicTree&, const T*, TreeWorkspace<T>*); \
  template void ForwardVelocities<T>(const KinematicTree&, const T*, TreeWorkspace<T>*); \
  template void ForwardAccelerations<T>(const KinematicTree&, const T*, const T*,        \
                                        TreeWorkspace<T>*);                              \
  template void MoveCoordinates<T>(const KinematicTree&, const T*, T*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Packet)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
