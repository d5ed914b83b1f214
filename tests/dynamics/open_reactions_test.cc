#include "vmech/dynamics/reactions/open_reactions.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <random>

#include "driven_examples.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"

namespace vmech {
namespace {

constexpr double kRounding = 1e-12;  // of matrices of the order of 1

/// The dense decomposition of the same matrix, and what it says.
struct Dense {
  MatrixXd Z;                     ///< [rows, open]
  double least = 1, largest = 1;  ///< singular values
  double bound_of_largest = 1;

  Dense(const LoadModel& model, const VectorXd& q) {
    const MatrixXd C_u =
        DimensionlessLoopJacobian(model.tree, q)(Eigen::all, model.partition.dependent);
    Z = MatrixXd::Identity(C_u.rows(), C_u.rows());
    if (C_u.cols() == 0) return;
    const Eigen::JacobiSVD<MatrixXd> svd(C_u, Eigen::ComputeFullU);
    Z = svd.matrixU().rightCols(C_u.rows() - C_u.cols());
    least = svd.singularValues().minCoeff();
    largest = svd.singularValues().maxCoeff();
    const MatrixXd sizes = C_u.cwiseAbs();
    bound_of_largest =
        std::sqrt(sizes.rowwise().sum().maxCoeff() * sizes.colwise().sum().maxCoeff());
  }
};

/// Random loads on the multipliers of `chosen` loops, which are given in their order.
std::vector<OpenReactions::Block> RandomLoads(const KinematicTree& tree,
                                              const std::vector<size_t>& chosen, Random* random) {
  std::vector<OpenReactions::Block> blocks;
  for (const size_t l : chosen) {
    const int rows = tree.loops[l].rows;
    blocks.push_back({l, MatrixXd(random->Vector(6 * rows).reshaped(6, rows))});
  }
  return blocks;
}

VectorXd LargestByDense(const KinematicTree& tree, const MatrixXd& Z,
                        const std::vector<OpenReactions::Block>& blocks) {
  MatrixXd load = MatrixXd::Zero(6, Z.cols());
  for (const auto& block : blocks) {
    const Loop& loop = tree.loops[block.loop];
    load += block.T * Z.middleRows(loop.row, loop.rows);
  }
  return load.rowwise().norm();
}

void ExpectTheSame(const LoadStudy& study, Random* random) {
  const PreparedStudy prepared = PrepareStudy(study);
  const KinematicTree& tree = prepared.model.tree;
  if (tree.rows == 0) return;
  const VectorXd& q = prepared.mobility.q_general;
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  const OpenReactions open(tree, prepared.model.partition, ws);
  const Dense dense(prepared.model, q);
  EXPECT_GE(open.LeastSingularValue(), dense.least / dense.bound_of_largest * (1 - kRounding));
  EXPECT_LE(open.LeastSingularValue(), 3 * dense.least / dense.largest);
  for (size_t first = 0; first < tree.loops.size(); ++first) {
    std::vector<size_t> chosen{first};
    for (size_t l = first + 1; l < tree.loops.size(); ++l) {
      if (random->Between(0, 1) < 0.3) chosen.push_back(l);
    }
    const auto loads = RandomLoads(tree, chosen, random);
    const VectorXd largest = open.LargestOpen(loads);
    EXPECT_LE((largest - LargestByDense(tree, dense.Z, loads)).cwiseAbs().maxCoeff(), kRounding);
  }
}

class OpenReactionsOf : public testing::TestWithParam<DrivenExample> {};

TEST_P(OpenReactionsOf, AreTheNullSpaceOfTheWholeMatrixWhateverIsCut) {
  Random random(5);
  LoadStudy study = StudyOf(GetParam().name);
  ExpectTheSame(study, &random);
  for (size_t cut = 0; cut < study.mechanism.joints.size(); ++cut) {
    study.mechanism.preferred_cuts = {static_cast<int>(cut)};
    ExpectTheSame(study, &random);
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, OpenReactionsOf, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

/// Posts on the ground and beams from each to the next, joints in any order; between
/// two posts a second beam here and there.
LoadStudy Ladder(int windows, Random* random) {
  LoadStudy study;
  Mechanism& m = study.mechanism;
  m.links.push_back({"ground", {}, {}});
  const auto add_link = [&](const std::string& name, const Vector3d& along) {
    m.links.push_back({name, {1, along / 2, Matrix3d::Identity()}, {}});
    return static_cast<int>(m.links.size()) - 1;
  };
  const auto anchor = [&](int link, const Vector3d& p) {
    m.links[link].anchors.push_back(
        {"a" + std::to_string(m.links[link].anchors.size()), {Matrix3d::Identity(), p}});
    return AnchorId{link, static_cast<int>(m.links[link].anchors.size()) - 1};
  };
  const auto hinge = [&](AnchorId first, AnchorId second) {
    m.joints.push_back(
        MakeJoint("j" + std::to_string(m.joints.size()), JointType::kRevolute, first, second));
  };
  const Vector3d up(0, 1, 0), aside(1, 0, 0);
  std::vector<int> posts;
  for (int i = 0; i <= windows; ++i) {
    posts.push_back(add_link("post" + std::to_string(i), up));
    hinge(anchor(0, i * aside), anchor(posts.back(), {0, 0, 0}));
    const int beams = i == 0 ? 0 : random->Between(0, 1) < 0.3 ? 2 : 1;
    for (int b = 0; b < beams; ++b) {
      const Vector3d height = b == 0 ? up : Vector3d(0, random->Between(0.2, 0.8), 0);
      const int beam = add_link("beam" + std::to_string(i) + std::to_string(b), aside);
      hinge(anchor(posts[i - 1], height), anchor(beam, {0, 0, 0}));
      hinge(anchor(beam, aside), anchor(posts[i], height));
    }
  }
  std::shuffle(m.joints.begin(), m.joints.end(), std::minstd_rand(windows));
  study.drives = {{0, 0, MotionLaw::Uniform(0, 1)}};
  study.times = {0};
  return study;
}

TEST(OpenReactions, AreTheNullSpaceOfTheWholeMatrixOfRandomLadders) {
  Random random(6);
  for (int windows = 1; windows <= 12; ++windows) ExpectTheSame(Ladder(windows, &random), &random);
}

}  // namespace
}  // namespace vmech
