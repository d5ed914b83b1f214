#include "vmech/dynamics/reactions/certainty.h"

#include <algorithm>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/reactions/reactions.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {
namespace {

constexpr double kTouches = 1e-7;  // share of a unit self-stress that counts as load

MatrixXd DependentColumns(const KinematicTree& tree, const CoordinatePartition& partition,
                          const VectorXd& q) {
  const MatrixXd C = DimensionlessLoopJacobian(tree, q);
  MatrixXd C_u(C.rows(), static_cast<Eigen::Index>(partition.dependent.size()));
  for (size_t k = 0; k < partition.dependent.size(); ++k) {
    C_u.col(static_cast<Eigen::Index>(k)) = C.col(partition.dependent[k]);
  }
  return C_u;
}

/// Marks the components that a dimensionless set of multipliers loads.
class LoadMarker {
 public:
  LoadMarker(const KinematicTree& tree, const VectorXd& q, double touches)
      : tree_(tree), touches_(touches), ws_(tree), joints_(tree.mechanism.joints.size()) {
    EvaluatePose(tree, q, &ws_);
    JointFrames(tree, ws_, &joints_);
  }

  void Mark(const VectorXd& direction, Certainty verdict, std::vector<JointCertainty>* result) {
    for (TreeWorkspace<double>::Node& node : ws_.nodes) node.F = {};
    const VectorXd mu = LoopRowScale(tree_).cwiseProduct(direction);
    ApplyMultipliers(tree_, mu.data(), &ws_, &joints_);
    for (size_t j = 0; j < joints_.size(); ++j) {
      Vector6d load = WrenchIn(joints_[j].F, joints_[j].W).Stacked();
      load.head<3>() *= tree_.length;
      for (int i = 0; i < 6; ++i) {
        if (std::abs(load[i]) > touches_) (*result)[j][i] = verdict;
      }
    }
  }

 private:
  const KinematicTree& tree_;
  double touches_;
  TreeWorkspace<double> ws_;
  std::vector<JointState<double>> joints_;
};

}  // namespace

std::vector<JointCertainty> JudgeCertainty(const KinematicTree& tree,
                                           const CoordinatePartition& partition, const VectorXd& q,
                                           double rounding) {
  JointCertainty all_certain;
  all_certain.fill(Certainty::kCertain);
  std::vector<JointCertainty> result(tree.mechanism.joints.size(), all_certain);
  if (tree.rows == 0) return result;

  const MatrixXd C_u = DependentColumns(tree, partition, q);
  const LeftSingularVectors svd = FindLeftSingularVectors(C_u);
  const VectorXd& sigma = svd.values;
  LoadMarker marker(tree, q, std::max(kTouches, TouchOfRounding(rounding)));
  // First what grows at a dead centre, then what stays open anywhere.
  for (Eigen::Index k = 0; k < sigma.size(); ++k) {
    if (sigma[k] <= kSingularTolerance * sigma[0]) {
      marker.Mark(svd.vectors.col(k), Certainty::kSingular, &result);
    }
  }
  for (Eigen::Index k = sigma.size(); k < C_u.rows(); ++k) {
    marker.Mark(svd.vectors.col(k), Certainty::kNotDetermined, &result);
  }
  return result;
}

double DistanceFromDeadCentre(const KinematicTree& tree, const CoordinatePartition& partition,
                              const VectorXd& q) {
  if (partition.dependent.empty() || tree.rows == 0) return 1;
  const VectorXd sigma = FindLeftSingularVectors(DependentColumns(tree, partition, q)).values;
  return sigma.minCoeff() / sigma.maxCoeff();
}

}  // namespace vmech
