#include "vmech/hw_interface/audit/felt.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "vmech/base/rotation_error.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/hw_interface/audit/felt_motion.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/rendering/free_motions.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_rows.h"

namespace vmech {
namespace {

constexpr double kBlock = 5e-3;     // [s], of ticks that are taken together
constexpr double kBandwidth = 7;    // [Hz], of each of four filters: of all together 3 Hz
constexpr double kSettling = 0.4;   // [s], after which the filters have forgotten
constexpr double kWithheld = 0.02;  // of the force: more is another wrench than the mechanism's

/// Four filters of first order, one after the other.
class LowPass {
 public:
  explicit LowPass(double step) : share_(1 - std::exp(-2 * std::numbers::pi * kBandwidth * step)) {}
  const Vector6d& operator()(Vector6d x) {
    for (Vector6d& stage : stages_) {
      stage += share_ * (x - stage);
      x = stage;
    }
    return stages_.back();
  }

 private:
  double share_;
  std::array<Vector6d, 4> stages_{Vector6d::Zero(), Vector6d::Zero(), Vector6d::Zero(),
                                  Vector6d::Zero()};
};

/// y = sum of theta_i x_i.
template <int kUnknowns>
class LeastSquares {
 public:
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  using Columns = Eigen::Matrix<double, 6, kUnknowns>;

  LeastSquares() {
    A_.setZero();
    b_.setZero();
  }
  void Add(const Columns& x, const Vector6d& y) {
    if (!x.allFinite() || !y.allFinite()) return;
    A_ += x.transpose() * x;
    b_ += x.transpose() * y;
    yy_ += y.squaredNorm();
    ++count_;
  }
  /// Unknown i; neighbours in time say the same `repeated` times.
  Felt Fit(int i, double promised, double repeated) const {
    Felt felt;
    felt.promised = promised;
    if (count_ < 10 * kUnknowns || !(A_(i, i) > 1e-12 * yy_)) return felt;
    Eigen::Matrix<double, kUnknowns, kUnknowns> A = A_;
    for (int k = 0; k < kUnknowns; ++k) {
      if (!(A(k, k) > 1e-12 * yy_)) A(k, k) = 1;  // nothing of it was there
    }
    const auto factor = A.ldlt();
    const Unknowns theta = factor.solve(b_);
    const double rest = std::max(0.0, yy_ - theta.dot(b_));
    const double variance = repeated * rest / static_cast<double>(count_);
    felt.value = theta[i];
    const double inverse = factor.solve(Unknowns::Unit(i))[i];
    // The fit of x_i to y and the others would say theta + rest A^-1 / theta: between the two is
    // the truth, however the noise is spread over both sides [Frisch 1934].
    const double between = rest * inverse / std::abs(theta[i]);
    felt.error = std::max(std::sqrt(variance * inverse), 0.5 * between);
    felt.known = std::isfinite(felt.error);
    return felt;
  }

 private:
  Eigen::Matrix<double, kUnknowns, kUnknowns> A_;
  Unknowns b_;
  double yy_ = 0;
  std::uint64_t count_ = 0;
};

/// The mechanism at the end of a block.
struct BlockPose {
  explicit BlockPose(const KinematicTree& tree)
      : ws(tree),
        inertias(tree),
        q(VectorXd::Zero(tree.nq)),
        tau(VectorXd::Zero(tree.nv)),
        J(6, tree.nv),
        P(MatrixXd::Zero(tree.nv, 6)) {}

  /// False where the hand does not reach a freedom.
  bool Set(const KinematicTree& tree, const GraspFrame& grasp, const Vector6d& K,
           const VectorXd& at) {
    q = at;
    ForwardKinematics(tree, q.data(), &ws);
    BodyInertias(tree, ws, &inertias);
    GraspJacobian(tree, ws, grasp.node, grasp.X_BG, &J);
    const MatrixXd N = FreeMotions(tree, &ws);
    const MatrixXd JN = J * N;
    const MatrixXd gram = JN.transpose() * K.asDiagonal() * JN;
    const Eigen::LLT<MatrixXd> factor(gram);
    const VectorXd pivots = factor.matrixL().toDenseMatrix().diagonal();
    constexpr double kReached = 1e-3;  // of the largest
    if (N.cols() == 0 || factor.info() != Eigen::Success ||
        pivots.minCoeff() < kReached * pivots.maxCoeff()) {
      return false;
    }
    P = N * factor.solve(JN.transpose() * K.asDiagonal());
    return true;
  }

  /// M v' + c(q, v), or with gravity and at rest the weight.
  const VectorXd& Forces(const KinematicTree& tree, const Vector3d& gravity, const VectorXd& v,
                         const VectorXd& vdot) {
    SetGravity(gravity, &ws);
    ForwardVelocities(tree, v.data(), &ws);
    VelocityProducts(tree, &ws);
    ForwardAccelerations(tree, vdot.data(), &ws);
    GyroscopicWrenches(tree, inertias, &ws);
    NewtonEuler<double>(tree, inertias, nullptr, &ws, tau.data());
    return tau;
  }

  TreeWorkspace<double> ws;
  TreeInertias<double> inertias;
  VectorXd q, tau;
  Matrix6Xd J;
  MatrixXd P;  // [nv, 6], v = P V_H
  bool sound = false;
};

/// What is summed up over the ticks of a block.
struct BlockMeans {
  Vector6d exerted = Vector6d::Zero(), told = Vector6d::Zero(), stretch = Vector6d::Zero();
  double share = 0;  // of the inertia that was rendered
  int ticks = 0;
  bool whole = true;  // nothing was withheld
};

Vector6d InWorld(const Matrix3d& R_WD, const Vector6d& F_D) {
  Vector6d F_W;
  F_W << R_WD * F_D.head<3>(), R_WD * F_D.tail<3>();
  return F_W;
}

}  // namespace

struct FeltFit::Parts {
  Parts(const RecordingHeader& header, const RecordedTree& mechanism)
      : held(mechanism),
        promise(PromiseOf(header)),
        own(header),
        period(header.period),
        share_channel(header.ChannelOf("inertia_share")),
        block_ticks(std::max(1, static_cast<int>(std::lround(kBlock / period)))),
        step(block_ticks * period),
        device_delay(header.delay),
        passive(held.tree),
        pose(held.tree),
        last_pose(held.tree),
        v(VectorXd::Zero(held.tree.nv)),
        last_v(v),
        along{LowPass(step), LowPass(step), LowPass(step), LowPass(step)},
        against{LowPass(step), LowPass(step), LowPass(step)},
        late{LowPass(step), LowPass(step), LowPass(step)} {
    const double L = held.tree.length;
    length << Vector3d::Ones(), Vector3d::Constant(L);
    K = promise.coupling.stiffness;
    if (K.head<3>().minCoeff() <= 0) K = length.cwiseAbs2();
    K = RowsThatCount(K, held.grasp.kind);
  }

  void Take(const TickRecord& tick);
  void Count(const TickRecord& tick);
  void EndBlock(const TickRecord& tick);
  void FitBoundary();
  void FitAlong(const Vector6d& F);
  void FitAgainst(const Vector6d& F);
  void FitDelay();

  const RecordedTree& held;
  SessionPromise promise;
  OwnWrench own;
  double period;
  int share_channel;
  int block_ticks;
  double step, device_delay;
  Vector6d length, K;
  PassiveJoints passive;
  // Blocks end at boundaries; `last` is the boundary between this block and the last.
  BlockMeans means, last_means, block;
  BlockPose pose, last_pose;
  Posed X_WH;
  VectorXd v, last_v;  // of the middles of the blocks
  int blocks = 0;      // in a row
  int settled = 0;
  std::array<LowPass, 4> along;
  std::array<LowPass, 3> against, late;
  LeastSquares<3> along_fit;
  LeastSquares<2> against_fit, late_fit;
  FeltReport report;
  Vector6d sent = Vector6d::Zero(), sent_before = Vector6d::Zero();  // of the last two ticks
  double shares = 0;                                                 // of all blocks that count
  std::uint64_t shared = 0;
  std::uint64_t poses = 0, unreached = 0;  // looked at; with freedoms that the hand misses
  double noise = 0;
  std::uint64_t noisy_ticks = 0;
  bool senses = false;
};

void FeltFit::Parts::Count(const TickRecord& tick) {
  ++report.ticks;
  const auto cause = static_cast<size_t>(tick.off);
  if (cause > 0) ++report.off[std::min<size_t>(cause, FeltReport::kCauses - 1)];
  for (int i = 0; i < kSafetyStages; ++i) report.stages[i] += tick.stages >> i & 1;
  if (report.ticks > 2 && tick.off == ForceOff::kNone) {
    const Vector6d curve = tick.sent_F_Ho_D - 2 * sent + sent_before;
    noise += curve.head<3>().squaredNorm() / 6;  // white noise has six times its own
    ++noisy_ticks;
    report.largest_change =
        std::max(report.largest_change, (tick.sent_F_Ho_D - sent).head<3>().norm());
  }
}

void FeltFit::Parts::Take(const TickRecord& tick) {
  Count(tick);
  const Matrix3d& R_WD = tick.registration.X_WD.R;
  senses = tick.state.valid & kSensesAppliedWrench;
  const Vector6d told = InWorld(R_WD, sent);
  block.told += told;
  block.exerted += senses ? InWorld(R_WD, tick.state.applied_F_Ho_D) : told;
  block.stretch += HandError(tick.picture.X_WG, tick.picture.X_WH);
  block.share += share_channel < 0 ? 1 : tick.channels[static_cast<size_t>(share_channel)];
  const Vector6d missing = tick.sent_F_Ho_D - tick.wanted_F_Ho_D;
  const bool withheld =
      missing.head<3>().norm() > kWithheld * std::max(1.0, tick.wanted_F_Ho_D.head<3>().norm());
  block.whole = block.whole && tick.off == ForceOff::kNone && !(tick.stages & kRamped) &&
                !withheld && own.IsIn(tick, kWithheld) && tick.picture.holds &&
                tick.io == IoStatus::kOk && tick.skipped == 0;
  sent_before = sent;
  sent = tick.sent_F_Ho_D;
  if (++block.ticks < block_ticks) return;
  EndBlock(tick);
  block = {};
}

void FeltFit::Parts::EndBlock(const TickRecord& tick) {
  if (!block.whole) {
    blocks = settled = 0;
    return;
  }
  const double share = 1.0 / block.ticks;
  last_means = means;
  means = block;
  means.exerted *= share;
  means.told *= share;
  means.stretch *= share;
  means.share *= share;
  std::swap(pose, last_pose);
  pose.sound = pose.Set(held.tree, held.grasp, K, tick.picture.q);
  ++poses;
  unreached += !pose.sound;
  const Posed X_WH_before = X_WH;
  X_WH = tick.picture.X_WH;
  last_v.swap(v);
  if (++blocks == 1) return;
  v = 0.5 * (pose.P + last_pose.P) * HandError(X_WH_before, X_WH) / step;
  if (blocks > 2) FitBoundary();
}

void FeltFit::Parts::FitBoundary() {
  if (!pose.sound || !last_pose.sound || held.regrasps) {
    settled = 0;
    return;
  }
  ++settled;
  const Vector6d F = -0.5 * (means.exerted + last_means.exerted);
  FitAlong(F);
  FitAgainst(F);
  FitDelay();
}

void FeltFit::Parts::FitAlong(const Vector6d& F) {
  const KinematicTree& tree = held.tree;
  BlockPose& at = last_pose;
  const MatrixXd Pt = at.P.transpose();
  const VectorXd mean_v = 0.5 * (v + last_v), zero = VectorXd::Zero(tree.nv);
  const double share = 0.5 * (means.share + last_means.share);
  const Vector6d inertia =
      share * Pt * at.Forces(tree, Vector3d::Zero(), mean_v, (v - last_v) / step);
  const Vector6d weight = Pt * at.Forces(tree, tree.mechanism.gravity_W, zero, zero);
  VectorXd springs = zero;
  passive.AddForces(at.q, mean_v, &springs);
  const Vector6d drag = Pt * (at.J.transpose() * length.cwiseAbs2().cwiseProduct(at.J * mean_v));
  const Vector6d y = Pt * (at.J.transpose() * F) / promise.scale - Pt * springs;
  LeastSquares<3>::Columns x;
  x.col(0) = along[0](inertia.cwiseQuotient(length));
  x.col(1) = along[1](weight.cwiseQuotient(length));
  x.col(2) = along[2](drag.cwiseQuotient(length));
  const Vector6d filtered = along[3](y.cwiseQuotient(length));
  if (settled * step <= kSettling) return;
  along_fit.Add(x, filtered);
  shares += share;
  ++shared;
}

void FeltFit::Parts::FitAgainst(const Vector6d& F) {
  const BlockPose& at = last_pose;
  const Matrix6d free = at.P.transpose() * at.J.transpose();
  const auto barred = [&](const Vector6d& w) -> Vector6d {
    return (w - free * w).cwiseQuotient(length);
  };
  const Vector6d pull = promise.scale * K.cwiseProduct(0.5 * (means.stretch + last_means.stretch));
  const Vector6d rate = promise.scale * K.cwiseProduct(means.stretch - last_means.stretch) / step;
  LeastSquares<2>::Columns x;
  x.col(0) = against[0](barred(pull));
  x.col(1) = against[1](barred(rate));
  const Vector6d filtered = against[2](barred(F));
  if (settled * step > kSettling) against_fit.Add(x, filtered);
}

void FeltFit::Parts::FitDelay() {
  if (!senses) return;
  LeastSquares<2>::Columns x;
  x.col(0) = late[0]((0.5 * (means.told + last_means.told)).cwiseQuotient(length));
  x.col(1) = late[1](((means.told - last_means.told) / step).cwiseQuotient(length));
  const Vector6d filtered =
      late[2]((0.5 * (means.exerted + last_means.exerted)).cwiseQuotient(length));
  if (settled * step > kSettling) late_fit.Add(x, filtered);
}

FeltFit::FeltFit(const RecordingHeader& header, const RecordedTree& held)
    : parts_(std::make_unique<Parts>(header, held)) {}

FeltFit::~FeltFit() = default;

void FeltFit::Take(const TickRecord& tick) {
  parts_->Take(tick);
}

FeltReport FeltFit::Report() const {
  const Parts& p = *parts_;
  FeltReport report = p.report;
  report.period = p.period;
  if (p.shared > 0) report.share = p.shares / static_cast<double>(p.shared);
  const double repeated = std::max(1.0, 1 / (2 * kBandwidth * p.step));
  report.unreached = 2 * p.unreached > p.poses;
  report.inertia = p.along_fit.Fit(0, p.promise.inertia, repeated);
  report.weight = p.along_fit.Fit(1, 1, repeated);
  report.damping = p.along_fit.Fit(2, 0, repeated);
  const double k = p.promise.scale * p.K[0];
  Felt stiffness = p.against_fit.Fit(0, 1, repeated), rate = p.against_fit.Fit(1, 0, repeated);
  for (double* figure : {&stiffness.value, &stiffness.error, &rate.value, &rate.error}) {
    *figure *= k;
  }
  stiffness.promised = p.promise.scale * p.promise.coupling.stiffness[0];
  report.stiffness = stiffness;
  rate.promised = p.promise.scale * p.promise.coupling.damping[0];
  report.resistance = rate;
  Felt delay = p.late_fit.Fit(1, 0, repeated);
  delay.value = -delay.value;
  delay.promised = p.device_delay;
  report.delay = delay;
  report.noise = p.noisy_ticks > 0 ? std::sqrt(p.noise / static_cast<double>(p.noisy_ticks)) : 0;
  return report;
}

}  // namespace vmech
