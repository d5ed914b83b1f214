#include "vmech/kinematics/loops/assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/linear_algebra/normal_equations.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loop_clusters.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/validity.h"
#include "vmech/solvers/starts.h"

namespace vmech {
namespace {

/// Loops that stay open by no more may be closed but for the rounding of their figures.
constexpr double kRounding = 1e-2;

/// The penalty iteration on the coordinates that may move.
class PenaltyIteration {
 public:
  PenaltyIteration(const KinematicTree& tree, const AssemblyOptions& options,
                   const VectorXd& q_given, const VectorXd& q)
      : tree_(tree), options_(options), ws_(tree), q_given_(q_given), q_(q) {
    free_ = VectorXd::Ones(tree.nv);
    for (int v : options.fixed) free_[v] = 0;
    coordinate_weight_ = VectorXd::Ones(tree.nv);
    for (const TreeNode& node : tree.nodes) {
      if (node.motion == NodeMotion::kPrismatic) {
        coordinate_weight_[node.v] = 1 / (tree.length * tree.length);
      }
    }
    row_scale_ = LoopRowScale(tree);
    shift_ = VectorXd::Zero(tree.rows);
    Evaluate();
  }

  double error() const { return error_; }
  const VectorXd& q() const { return q_; }
  const TreeWorkspace<double>& ws() const { return ws_; }
  /// From the given coordinates, squared and dimensionless.
  double SquaredDeparture() const {
    const VectorXd d = Departure(q_);
    return d.dot(coordinate_weight_.cwiseProduct(d));
  }

  /// [1; lambda C] dq = [q_given - q; lambda (e2 + s)], damped until the merit falls (paper eq. 8).
  /// False when no step makes progress any more.
  bool Step() {
    const VectorXd departure = Departure(q_);
    const std::vector<RowBlock> C = ScaledJacobian();
    const VectorXd wanted = ScaledErrors() + shift_;
    const double merit = Merit();
    const VectorXd q_before = q_;
    for (int attempt = 0; attempt < 30; ++attempt) {
      const VectorXd dq =
          PenaltyStep(C, wanted, (1 + damping_) / options_.penalty, departure / (1 + damping_));
      q_ = q_before;
      MoveCoordinates(tree_, Bounded(dq), &q_);
      Evaluate();
      if (Merit() < merit) {
        damping_ *= 0.2;
        if (error_ < kMultiplierRegion) shift_ += ScaledErrors();
        return true;
      }
      damping_ = std::max(4 * damping_, 1e-3);
    }
    q_ = q_before;
    Evaluate();
    return false;
  }

  /// Closes what is left by the shortest step, C dq = e2.
  void CloseStep() {
    const VectorXd zero = VectorXd::Zero(tree_.nv);
    MoveCoordinates(tree_, PenaltyStep(ScaledJacobian(), ScaledErrors(), kShortestStep, zero), &q_);
    Evaluate();
  }

 private:
  static constexpr double kMultiplierRegion = 0.1;  // linearisation is worth something
  static constexpr double kChain = 0.2;             // of H is within its envelope
  static constexpr double kShortestStep = 1e-10;    // far above roundoff, far below any stiffness
  static constexpr double kLongestStep = 0.5;       // [rad], or characteristic lengths

  void Evaluate() {
    EvaluatePose(tree_, q_, &ws_);
    error_ = LargestLoopError(tree_, ws_);
  }

  VectorXd ScaledErrors() const { return row_scale_.cwiseProduct(StackedLoopErrors(tree_, ws_)); }

  /// Loop by loop.
  std::vector<RowBlock> ScaledJacobian() const {
    std::vector<RowBlock> blocks;
    for (size_t l = 0; l < tree_.loops.size(); ++l) {
      const Loop& loop = tree_.loops[l];
      RowBlock block{{}, MatrixXd(loop.rows, std::ssize(loop.columns))};
      const auto scale = row_scale_.segment(loop.row, loop.rows).array();
      for (const LoopColumn& c : loop.columns) {
        const Eigen::Index k = std::ssize(block.columns);
        const Vector6d& column = ws_.columns(l)[k];
        block.A.col(k) = scale * column.head(loop.rows).array() * free_[c.v];
        block.columns.push_back(c.v);
      }
      blocks.push_back(std::move(block));
    }
    return blocks;
  }

  /// The tangent vector from q to the given coordinates.
  VectorXd Departure(const VectorXd& q) const {
    VectorXd d = VectorXd::Zero(tree_.nv);
    for (const TreeNode& node : tree_.nodes) {
      if (node.q < 0) continue;
      if (node.motion != NodeMotion::kSpherical) {
        d[node.v] = q_given_[node.q] - q[node.q];
        continue;
      }
      auto quaternion = [&](const VectorXd& c) {
        return Eigen::Quaterniond(c[node.q], c[node.q + 1], c[node.q + 2], c[node.q + 3]);
      };
      const Eigen::AngleAxisd turn(quaternion(q).conjugate() * quaternion(q_given_));
      d.segment<3>(node.v) = turn.angle() * turn.axis();
    }
    return d;
  }

  double Merit() const {
    return SquaredDeparture() + options_.penalty * (ScaledErrors() + shift_).squaredNorm() +
           (error_ >= 2 ? options_.penalty : 0);
  }

  VectorXd Bounded(const VectorXd& dq) const {
    const double size = std::sqrt(dq.dot(coordinate_weight_.cwiseProduct(dq)));
    const double limit = kLongestStep * std::sqrt(static_cast<double>(tree_.nv));
    return size > limit ? VectorXd(dq * (limit / size)) : dq;
  }

  /// minimise |C x - e|^2 + weight |x - x0|^2_W over what may move, W the coordinate weights: of
  /// x = H^-1 (C' e + weight W x0), H = C' C + weight W, and
  /// x = x0 + W^-1 C' z, (C W^-1 C' + weight 1) z = e - C x0, the one with the smaller matrix; or H
  /// within its envelope, where loops hang together in a chain.
  VectorXd PenaltyStep(const std::vector<RowBlock>& blocks, const VectorXd& e, double weight,
                       const VectorXd& x0) const {
    const VectorXd& W = coordinate_weight_;
    const VectorXd weighted = weight * W.cwiseProduct(free_.cwiseProduct(x0));
    if (ShareOfEnvelope(tree_.nv, blocks) < kChain) {
      return free_.cwiseProduct(SolveNormalEquations(blocks, e, weight * W, weighted));
    }
    MatrixXd C = MatrixXd::Zero(tree_.rows, tree_.nv);
    for (size_t l = 0; l < blocks.size(); ++l) {
      const Loop& loop = tree_.loops[l];
      C.middleRows(loop.row, loop.rows)(Eigen::all, blocks[l].columns) = blocks[l].A;
    }
    if (C.rows() < C.cols()) {
      const MatrixXd D = C * W.cwiseInverse().asDiagonal();
      MatrixXd M = D * C.transpose();
      M.diagonal().array() += weight;
      return free_.cwiseProduct(x0 + D.transpose() * SolveSymmetric(M, e - C * x0));
    }
    MatrixXd H = C.transpose() * C;
    H.diagonal() += weight * W;
    return free_.cwiseProduct(SolveSymmetric(H, C.transpose() * e + weighted));
  }

  const KinematicTree& tree_;
  const AssemblyOptions& options_;
  TreeWorkspace<double> ws_;
  VectorXd q_given_, q_;
  VectorXd free_;               ///< 1 for coordinates that may move
  VectorXd coordinate_weight_;  ///< makes departures dimensionless
  VectorXd row_scale_;
  VectorXd shift_;  ///< multiplier / lambda^2
  double damping_ = 0;
  double error_ = 0;
};

void DescribeError(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                   AssemblySummary* summary) {
  double worst = -1;
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const LoopState<double>& s = ws.loops[l];
    double distance = 0, angle = 0;
    for (int i = 0; i < tree.loops[l].rows; ++i) {
      (IsLengthRow(tree.loops[l].type, i) ? distance : angle) += s.e2[i] * s.e2[i];
    }
    const double size = std::sqrt(distance) / tree.length + std::sqrt(angle);
    if (size <= worst) continue;
    worst = size;
    summary->worst_joint = tree.loops[l].joint;
    summary->worst_distance = std::sqrt(distance);
    summary->worst_angle = 2 * std::asin(std::min(1.0, std::sqrt(angle) / 2));
  }
}

std::string FailureMessage(const KinematicTree& tree, const AssemblySummary& s) {
  const DisplayUnits& units = tree.mechanism.units;
  return fmt::format(
      "the loop through joint '{}' cannot be closed near the start values: from {} after {} "
      "iterations its anchors are {:.4g} {} and {:.4g} {} apart (at the start values the largest "
      "error was {:.3g} of the characteristic length {:.4g} {}). Check the anchors and lengths of "
      "its links, or give start values nearer to an assembled pose",
      tree.mechanism.joints[s.worst_joint].name,
      s.starts == 1 ? std::string("these") : fmt::format("{} starts", s.starts), s.iterations,
      s.worst_distance / units.metres, units.length, s.worst_angle / units.radians, units.angle,
      s.start_error, tree.length / units.metres, units.length);
}

/// Runs the iteration to its end, closed or not; returns its steps.
int CloseLoops(const AssemblyOptions& options, PenaltyIteration* iteration) {
  constexpr double kNearlyClosed = 1e-5;  // from here Newton converges quadratically
  constexpr int kClosingSteps = 8;
  int steps = 0;
  const double nearly = std::max(kNearlyClosed, options.tolerance);
  while (iteration->error() > nearly && steps < options.max_iterations) {
    ++steps;
    if (!iteration->Step()) break;
  }
  for (int i = 0;
       i < kClosingSteps && iteration->error() > options.tolerance && iteration->error() <= nearly;
       ++i) {
    ++steps;
    iteration->CloseStep();
  }
  return steps;
}

/// q moved by `way`, dimensionless; what is fixed stays.
VectorXd Displaced(const KinematicTree& tree, const AssemblyOptions& options, VectorXd q,
                   VectorXd way) {
  for (const int v : options.fixed) way[v] = 0;
  MoveCoordinates(tree, VelocityScale(tree).cwiseProduct(way), &q);
  return q;
}

/// Poses beside q along the kernel of the loops' Jacobian, to both sides: what is to first order
/// without effect there may lead away.
std::vector<VectorXd> StartsBeside(const KinematicTree& tree, const AssemblyOptions& options,
                                   const VectorXd& q) {
  constexpr double kKick = 0.2;  // [rad, characteristic lengths]
  constexpr double kKernel = 1e-4;
  constexpr Eigen::Index kDirections = 12;
  const MatrixXd N = FindNullSpace(DimensionlessLoopJacobian(tree, q), kKernel).basis;
  std::vector<VectorXd> starts;
  for (Eigen::Index k = 0; k < std::min(N.cols(), kDirections); ++k) {
    for (const double kick : {kKick, -kKick}) {
      starts.push_back(
          Displaced(tree, options, q, kick / N.col(k).cwiseAbs().maxCoeff() * N.col(k)));
    }
  }
  return starts;
}

/// The k-th of poses that fill the surroundings of q evenly, out to half a turn and to a few
/// characteristic lengths.
VectorXd StartAround(const KinematicTree& tree, const AssemblyOptions& options, const VectorXd& q,
                     int k) {
  constexpr double kFarthest = 3.141592653589793;
  const double radius = kFarthest * std::min(1.0, (k + 1.0) / (0.5 * options.other_starts));
  return Displaced(tree, options, q, radius * (2 * EvenPoint(tree.nv, k).array() - 1).matrix());
}

/// Looks for the closed pose nearest to q_given from other starts.
void TryOtherStarts(const KinematicTree& tree, const AssemblyOptions& options,
                    const VectorXd& q_given, std::optional<PenaltyIteration>* best,
                    AssemblySummary* summary) {
  constexpr int kEnough = 4;            // closed poses to choose from
  constexpr double kNearer = 1 - 1e-6;  // mirror images are alike: the first is taken
  const std::vector<VectorXd> beside = StartsBeside(tree, options, (*best)->q());
  int closed = 0;
  for (int k = 0; k < options.other_starts && closed < kEnough; ++k) {
    const int around = k - static_cast<int>(beside.size());
    if (around == 0 && closed > 0) return;
    PenaltyIteration iteration(
        tree, options, q_given,
        around < 0 ? beside[k] : StartAround(tree, options, q_given, around));
    summary->iterations += CloseLoops(options, &iteration);
    ++summary->starts;
    const bool closes = iteration.error() <= kRounding;
    const bool better = closed > 0
                            ? iteration.SquaredDeparture() < kNearer * (*best)->SquaredDeparture()
                            : iteration.error() < (*best)->error();
    if ((closes || closed == 0) && better) best->emplace(iteration);
    closed += closes;
  }
}

/// What the coordinates of points leave of loop errors by their rounding, where a mechanism is far
/// larger than its characteristic length.
double RoundingOf(const KinematicTree& tree, const TreeWorkspace<double>& ws) {
  constexpr double kUnits = 4 * std::numeric_limits<double>::epsilon();
  double reach = 0;
  for (int node = 0; node < static_cast<int>(tree.nodes.size()); ++node) {
    reach = std::max(reach, (PoseInWorld(ws, node, {}).p - ws.reference).norm());
  }
  return kUnits * reach / tree.length;
}

/// Assemble for loops that belong together.
AssemblySummary AssembleCluster(const KinematicTree& tree, AssemblyOptions options, VectorXd* q) {
  AssemblySummary summary;
  std::optional<PenaltyIteration> best;
  best.emplace(tree, options, *q, *q);
  options.tolerance = std::max(options.tolerance, RoundingOf(tree, best->ws()));
  summary.start_error = best->error();
  summary.iterations = CloseLoops(options, &*best);
  if (best->error() > kRounding) TryOtherStarts(tree, options, *q, &best, &summary);
  *q = best->q();
  summary.error = best->error();
  summary.closed = summary.error <= options.tolerance;
  DescribeError(tree, best->ws(), &summary);
  if (!summary.closed) summary.message = FailureMessage(tree, summary);
  return summary;
}

/// What is wrong with the whole is what is wrong with the worst of its clusters.
void Enter(const AssemblySummary& part, int worst_joint, AssemblySummary* whole) {
  if (whole->worst_joint < 0 || part.error > whole->error) {
    whole->error = part.error;
    whole->worst_joint = worst_joint;
    whole->worst_distance = part.worst_distance;
    whole->worst_angle = part.worst_angle;
    whole->message = part.message;
  }
  whole->closed = whole->closed && part.closed;
  whole->iterations += part.iterations;
  whole->start_error = std::max(whole->start_error, part.start_error);
  whole->starts = std::max(whole->starts, part.starts);
}

}  // namespace

AssemblyOptions AssemblyOptions::Nearby() {
  AssemblyOptions options;
  options.other_starts = 0;
  return options;
}

void AssemblyOptions::Validate() const {
  auto require = [](bool ok, const char* name, double value, const char* range) {
    if (!ok) {
      throw std::invalid_argument(
          fmt::format("AssemblyOptions: {} is {}; it must be in {}", name, value, range));
    }
  };
  require(tolerance > 0 && tolerance <= 1e-3, "tolerance", tolerance, "(0, 1e-3]");
  require(max_iterations >= 1 && max_iterations <= 10000, "max_iterations", max_iterations,
          "1..10000");
  require(other_starts >= 0 && other_starts <= 1000, "other_starts", other_starts, "0..1000");
  require(penalty >= 1 && penalty <= 1e8, "penalty", penalty, "[1, 1e8]");
}

AssemblySummary Assemble(const KinematicTree& tree, const AssemblyOptions& options, VectorXd* q) {
  options.Validate();
  RequireCoordinates("Assemble: q", tree, *q);
  RequireVelocities("AssemblyOptions: fixed", tree, options.fixed);
  std::vector<bool> fixed(tree.nv, false);
  for (const int v : options.fixed) fixed[v] = true;
  AssemblySummary summary;
  summary.closed = true;
  for (const LoopCluster& cluster : SplitLoops(tree)) {
    AssemblyOptions of_cluster = options;
    of_cluster.fixed.clear();
    for (int v = 0; v < cluster.tree.nv; ++v) {
      if (fixed[cluster.v[v]]) of_cluster.fixed.push_back(v);
    }
    VectorXd part = (*q)(cluster.q);
    const AssemblySummary result = AssembleCluster(cluster.tree, of_cluster, &part);
    (*q)(cluster.q) = part;
    Enter(result, cluster.joints[result.worst_joint], &summary);
  }
  return summary;
}

}  // namespace vmech
