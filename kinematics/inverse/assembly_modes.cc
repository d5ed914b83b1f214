#include "vmech/kinematics/inverse/assembly_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/validity.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;

GraspFrame GraspOf(const AssemblyModesOptions& options) {
  return options.hand ? options.hand->grasp : GraspFrame{-1, {}, GraspKind::kPoint};
}

InverseKinematics MakeKinematics(const KinematicTree& tree, const AssemblyModesOptions& options) {
  InverseKinematicsOptions ik_options;
  ik_options.joint_limits = options.joint_limits;
  InverseKinematics ik(tree, GraspOf(options), ik_options);
  if (options.hand) ik.SetTarget(options.hand->X_WH);
  return ik;
}

int CoordinateOfVelocity(const KinematicTree& tree, int v) {
  for (const TreeNode& node : tree.nodes) {
    if (node.v == v && node.motion != NodeMotion::kSpherical) return node.q;
  }
  return -1;
}

/// The joint limits, and the fixed coordinates as bounds without room.
std::vector<Bound> BoundsOf(const InverseKinematics& ik, const std::vector<int>& fixed,
                            const VectorXd& q) {
  std::vector<Bound> bounds;
  for (const Bound& bound : ik.bounds()) {
    const bool is_fixed = std::find(fixed.begin(), fixed.end(), bound.tangent) != fixed.end();
    if (!is_fixed) bounds.push_back(bound);
  }
  for (int v : fixed) {
    const int coordinate = CoordinateOfVelocity(ik.tree(), v);
    bounds.push_back({coordinate, v, q[coordinate], q[coordinate]});
  }
  return bounds;
}

/// Loops and grasp as residuals, nothing as constraints: the zeros are the modes.
class ClosureProblem final : public ConstrainedLeastSquares {
 public:
  ClosureProblem(InverseKinematics& ik, int hand_rows, std::vector<Bound> bounds)
      : ConstrainedLeastSquares(
            {ik.sizes().coordinates, ik.sizes().tangents, hand_rows + ik.sizes().constraints, 0},
            std::move(bounds)),
        ik_(ik),
        hand_rows_(hand_rows),
        r_(ik.sizes().residuals),
        c_(ik.sizes().constraints),
        J_(ik.sizes().residuals, ik.sizes().tangents),
        C_(ik.sizes().constraints, ik.sizes().tangents) {}

  void Evaluate(const VectorXd& q, VectorXd* r, MatrixXd* J, VectorXd*, MatrixXd*) override {
    const bool hand = hand_rows_ > 0;
    ik_.Evaluate(q, r && hand ? &r_ : nullptr, J && hand ? &J_ : nullptr, r ? &c_ : nullptr,
                 J ? &C_ : nullptr);
    if (r) *r << r_.head(hand_rows_), c_;
    if (J) *J << J_.topRows(hand_rows_), C_;
  }
  void Plus(const VectorXd& q, const VectorXd& dq, VectorXd* q_plus) const override {
    ik_.Plus(q, dq, q_plus);
  }

 private:
  InverseKinematics& ik_;
  int hand_rows_;
  VectorXd r_, c_;
  MatrixXd J_, C_;
};

/// Coordinates drawn over the ranges of the joints.
class Starts {
 public:
  Starts(const KinematicTree& tree, const AssemblyModesOptions& options, const VectorXd& q)
      : tree_(tree), options_(options), q_given_(q), engine_(options.seed) {}

  VectorXd Draw() {
    VectorXd q = q_given_;
    for (const TreeNode& node : tree_.nodes) {
      if (node.v < 0 || IsFixed(node.v)) continue;
      if (node.motion == NodeMotion::kSpherical) {
        q.segment<4>(node.q) = DrawQuaternion();
      } else {
        q[node.q] = DrawCoordinate(node);
      }
    }
    return q;
  }

 private:
  // Not std::uniform_real_distribution, whose numbers differ between libraries.
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  bool IsFixed(int v) const {
    return std::find(options_.fixed.begin(), options_.fixed.end(), v) != options_.fixed.end();
  }

  double DrawCoordinate(const TreeNode& node) {
    const Joint& joint = tree_.mechanism.joints[node.joint];
    const double reach = node.motion == NodeMotion::kPrismatic ? 2 * tree_.length : kPi;
    double lower = joint.lower[node.freedom], upper = joint.upper[node.freedom];
    if (!options_.joint_limits) lower = -(upper = std::numeric_limits<double>::infinity());
    if (!std::isfinite(lower) && !std::isfinite(upper)) {
      lower = q_given_[node.q] - reach;
      upper = q_given_[node.q] + reach;
    }
    if (!std::isfinite(lower)) lower = upper - 2 * reach;
    if (!std::isfinite(upper)) upper = lower + 2 * reach;
    return lower + (upper - lower) * Uniform();
  }

  /// Uniform on the sphere [Shoemake 1992].
  Eigen::Vector4d DrawQuaternion() {
    const double u = Uniform(), a = 2 * kPi * Uniform(), b = 2 * kPi * Uniform();
    const double s = std::sqrt(1 - u), t = std::sqrt(u);
    return {t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)};
  }

  const KinematicTree& tree_;
  const AssemblyModesOptions& options_;
  const VectorXd& q_given_;
  std::mt19937_64 engine_;
};

class ModeSearch {
 public:
  ModeSearch(const KinematicTree& tree, const AssemblyModesOptions& options, const VectorXd& q)
      : tree_(tree),
        options_(options),
        ik_(MakeKinematics(tree, options)),
        hand_rows_(options.hand ? ik_.sizes().residuals : 0),
        problem_(ik_, hand_rows_, BoundsOf(ik_, options.fixed, q)),
        workspace_(problem_),
        at_q_(problem_.sizes()),
        links_(options.links) {
    for (int v = 0; v < tree.nv; ++v) {
      if (std::find(options.fixed.begin(), options.fixed.end(), v) == options.fixed.end()) {
        free_.push_back(v);
      }
    }
    if (links_.empty()) {
      for (size_t i = 0; i < tree.mechanism.links.size(); ++i)
        links_.push_back(static_cast<int>(i));
    }
    descent_.weight = 1;
    descent_.max_step = kLongestStep;
    descent_.stopping.max_iterations = kDescentSteps;
  }

  void Try(VectorXd q) {
    ++found_.starts;
    ++found_.since_new;
    (void)Solve(problem_, descent_, &q, &workspace_);
    if (!Polish(&q) || !WithinLimits(q)) return;
    ++found_.converged;
    Count(q);
  }

  /// Enough starts, or modes are no matter of counting.
  bool Done() const {
    constexpr int kLooseModes = 20;
    return found_.starts >= options_.max_starts || found_.since_new >= options_.patience ||
           loose_modes_ >= kLooseModes;
  }

  AssemblyModes Finish() {
    int once = 0;
    for (const AssemblyMode& mode : found_.modes) once += mode.found == 1;
    if (found_.converged > 0) found_.unseen = static_cast<double>(once) / found_.converged;
    found_.settled = found_.since_new >= options_.patience;
    return std::move(found_);
  }

 private:
  static constexpr double kLongestStep = 1;  // [rad or m]
  static constexpr int kDescentSteps = 60;
  static constexpr int kPolishingSteps = 8;
  static constexpr double kNearlyZero = 1e-3;  // from here Newton converges, or it is no mode
  static constexpr double kMoves = 1e-6;

  double ErrorAt(const VectorXd& q) {
    at_q_.Evaluate(problem_, q);
    if (!at_q_.r.allFinite()) return std::numeric_limits<double>::infinity();
    return at_q_.r.lpNorm<Eigen::Infinity>();
  }

  /// Newton's method, of the shortest steps where equations are redundant or freedoms are left.
  bool Polish(VectorXd* q) {
    error_ = ErrorAt(*q);
    for (int i = 0; i < kPolishingSteps && error_ <= kNearlyZero; ++i) {
      if (error_ <= options_.tolerance) return true;
      VectorXd step = VectorXd::Zero(tree_.nv);
      step(free_) = MinimumNormSolution(at_q_.J(Eigen::all, free_), -at_q_.r);
      MoveCoordinates(tree_, step, q);
      error_ = ErrorAt(*q);
    }
    return error_ <= options_.tolerance;
  }

  bool WithinLimits(const VectorXd& q) const {
    if (!options_.joint_limits) return true;
    for (const Bound& bound : problem_.bounds()) {
      const double value = q[bound.coordinate];
      if (value < bound.lower - kLimitSlack || value > bound.upper + kLimitSlack) return false;
    }
    for (size_t l = 0; l < tree_.loops.size(); ++l) {
      if (!CutJointWithinLimits(static_cast<int>(l))) return false;
    }
    return true;
  }

  /// Angles of cut joints are known but for whole turns.
  bool CutJointWithinLimits(int l) const {
    const Joint& joint = tree_.mechanism.joints[tree_.loops[l].joint];
    if (joint.type == JointType::kSpherical) return true;
    const Vector3d now = CutJointCoordinates(tree_.loops[l], ik_.workspace().loops[l]);
    const CutJointFreedoms<double> freedoms =
        FreedomsOfCutJoint(tree_.loops[l], ik_.workspace().loops[l]);
    for (int k = 0; k < freedoms.count; ++k) {
      const bool turns = !freedoms.twist_F[k].tail<3>().isZero() && joint.type != JointType::kScrew;
      double value = now[k];
      if (turns && std::isfinite(joint.lower[k])) {
        value += 2 * kPi * std::ceil((joint.lower[k] - kLimitSlack - value) / (2 * kPi));
      } else if (turns && value > joint.upper[k]) {
        value -= 2 * kPi;
      }
      if (value < joint.lower[k] - kLimitSlack || value > joint.upper[k] + kLimitSlack)
        return false;
    }
    return true;
  }
  static constexpr double kLimitSlack = 1e-9;  // [rad or m], what polishing may add

  void Count(VectorXd& q) {
    std::vector<Posed> poses;
    for (int link : links_) {
      poses.push_back(
          PoseInWorld(ik_.workspace(), tree_.NodeOfLink(link), tree_.X_node_link(link)));
    }
    for (size_t m = 0; m < poses_.size(); ++m) {
      if (Distance(poses, poses_[m]) > options_.separation) continue;
      ++found_.modes[m].found;
      return;
    }
    const bool isolated = IsIsolated();
    loose_modes_ += !isolated;
    Unwind(&q);
    found_.modes.push_back({q, 1, error_, isolated});
    poses_.push_back(std::move(poses));
    found_.since_new = 0;
  }

  double Distance(const std::vector<Posed>& a, const std::vector<Posed>& b) const {
    double distance = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      // |R_a - R_b| = sqrt(8) sin(angle/2)
      distance = std::max({distance, (a[i].p - b[i].p).norm() / tree_.length,
                           (a[i].R - b[i].R).norm() / std::numbers::sqrt2});
    }
    return distance;
  }

  bool IsIsolated() {
    const NullSpace motions = FindNullSpace(at_q_.J(Eigen::all, free_), kRankTolerance);
    TreeWorkspace<double> ws = ik_.workspace();
    for (Eigen::Index k = 0; k < motions.basis.cols(); ++k) {
      VectorXd v = VectorXd::Zero(tree_.nv);
      v(free_) = motions.basis.col(k);
      ForwardVelocities(tree_, v.data(), &ws);
      for (int link : links_) {
        const int node = tree_.NodeOfLink(link);
        if (node < 0) continue;
        const Screw& V = ws.at(node).V;
        const Double4 v = VelocityAt(ws.at(node).X.p, V);
        if (Length(v) / tree_.length + Length(V.angular) > kMoves) return false;
      }
    }
    return true;
  }

  void Unwind(VectorXd* q) const {
    for (const TreeNode& node : tree_.nodes) {
      if (node.motion != NodeMotion::kRevolute) continue;
      const bool bounded = std::any_of(problem_.bounds().begin(), problem_.bounds().end(),
                                       [&](const Bound& b) { return b.coordinate == node.q; });
      if (!bounded) (*q)[node.q] = std::remainder((*q)[node.q], 2 * kPi);
    }
  }

  const KinematicTree& tree_;
  const AssemblyModesOptions& options_;
  InverseKinematics ik_;
  int hand_rows_;
  ClosureProblem problem_;
  PenaltyOptions descent_;
  PenaltyWorkspace workspace_;
  Linearization at_q_;
  std::vector<int> links_, free_;
  std::vector<std::vector<Posed>> poses_;  // of links_, per mode
  double error_ = 0;                       // at the last q that was evaluated
  int loose_modes_ = 0;
  AssemblyModes found_;
};

}  // namespace

void AssemblyModesOptions::Validate(const KinematicTree& tree) const {
  auto require = [](bool ok, const std::string& what) {
    if (!ok) throw std::invalid_argument("AssemblyModesOptions: " + what);
  };
  auto in = [&](const char* name, double value, double low, double high) {
    require(value >= low && value <= high,
            fmt::format("{} is {}; it must be in [{}, {}]", name, value, low, high));
  };
  in("max_starts", max_starts, 1, 1e7);
  in("patience", patience, 1, 1e7);
  in("tolerance", tolerance, 1e-15, 1e-6);
  in("separation", separation, 1e-9, 1);
  for (int v : fixed) {
    require(CoordinateOfVelocity(tree, v) >= 0,
            fmt::format("fixed has {}, which is not the index of a single freedom of a tree joint; "
                        "a spherical or cut joint cannot be held",
                        v));
  }
  for (int link : links) in("links", link, 0, static_cast<double>(tree.mechanism.links.size()) - 1);
}

std::string AssemblyModes::BriefReport() const {
  int loose = 0;
  for (const AssemblyMode& mode : modes) loose += !mode.isolated;
  return fmt::format(
      "{} assembly mode{} from {} starts, {} of which closed; none new in the last {}{}",
      modes.size(), modes.size() == 1 ? "" : "s", starts, converged, since_new,
      loose == 0 ? "" : fmt::format("; {} of them can still move", loose));
}

AssemblyModes FindAssemblyModes(const KinematicTree& tree, const AssemblyModesOptions& options,
                                const VectorXd& q) {
  options.Validate(tree);
  RequireCoordinates("FindAssemblyModes: q", tree, q);
  ModeSearch search(tree, options, q);
  Starts starts(tree, options, q);
  search.Try(q);
  while (!search.Done()) search.Try(starts.Draw());
  return search.Finish();
}

}  // namespace vmech
