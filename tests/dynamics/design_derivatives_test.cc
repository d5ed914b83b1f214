// Derivatives of joint loads by dimensions and masses, taken through the kernels by dual numbers,
// against differences of whole studies of changed mechanisms.

#include <gtest/gtest.h>

#include <functional>

#include "dynamics/driven_examples.h"
#include "vmech/base/dual.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/track_motion.h"

namespace vmech {
namespace {

constexpr double kExact = 1e-9;    // relative to the largest load: what differences resolve
constexpr size_t kPose = 12;       // of the study
constexpr double kClosed = 1e-14;  // of poses that differences are taken of

/// What is changed: the same in a mechanism and in the slopes of a design.
struct Parameter {
  std::function<void(double by, Mechanism*)> change;
  std::function<void(const Mechanism&, Design<Dual>*)> seed;
};

/// All lengths together: whatever loops a mechanism has stay closed.
Parameter Size() {
  return {[](double by, Mechanism* mechanism) {
            for (Link& link : mechanism->links) {
              for (Anchor& anchor : link.anchors) anchor.X_LA.p *= 1 + by;
            }
          },
          [](const Mechanism& mechanism, Design<Dual>* design) {
            for (size_t l = 0; l < mechanism.links.size(); ++l) {
              for (size_t a = 0; a < mechanism.links[l].anchors.size(); ++a) {
                const Vector3d& p = mechanism.links[l].anchors[a].X_LA.p;
                for (int k = 0; k < 3; ++k) design->links[l].X_LA[a].p[k].slope = p[k];
              }
            }
          }};
}

/// Mass and inertia of one link.
Parameter MassOf(const std::string& name) {
  return {[name](double by, Mechanism* mechanism) {
            MassProperties& body = mechanism->links[FindLink(*mechanism, name)].mass_properties;
            body.mass *= 1 + by;
            body.I_Lcm *= 1 + by;
          },
          [name](const Mechanism& mechanism, Design<Dual>* design) {
            Design<Dual>::LinkNumbers& link = design->links[FindLink(mechanism, name)];
            link.mass.slope = link.mass.value;
            for (Dual& entry : link.I_Lcm.reshaped()) entry.slope = entry.value;
          }};
}

/// The length of a link: where its last anchor is.
Parameter LengthOf(const std::string& name) {
  return {[name](double by, Mechanism* mechanism) {
            mechanism->links[FindLink(*mechanism, name)].anchors.back().X_LA.p *= 1 + by;
          },
          [name](const Mechanism& mechanism, Design<Dual>* design) {
            const int link = FindLink(mechanism, name);
            const Vector3d& p = mechanism.links[link].anchors.back().X_LA.p;
            for (int k = 0; k < 3; ++k) design->links[link].X_LA.back().p[k].slope = p[k];
          }};
}

/// All joint wrenches at one pose, [6 joints].
VectorXd Loads(const LoadStudy& study) {
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, kClosed);
  LoadWorkspace<double> ws(prepared.model);
  EXPECT_TRUE(EvaluatePoseLoads(prepared.model, motion, kPose, &ws));
  VectorXd loads(6 * ws.loads.size());
  for (size_t j = 0; j < ws.loads.size(); ++j) loads.segment<6>(6 * j) = ws.loads[j].W_F.Stacked();
  return loads;
}

VectorXd LoadsOf(const std::string& example, const Parameter& parameter, double by) {
  LoadStudy study = StudyOf(example);
  parameter.change(by, &study.mechanism);
  return Loads(study);
}

/// By a stencil of sixth order.
VectorXd Difference(const std::string& example, const Parameter& parameter) {
  constexpr double h = 2e-3;
  const auto change = [&](int k) -> VectorXd {
    return LoadsOf(example, parameter, k * h) - LoadsOf(example, parameter, -k * h);
  };
  return (45 * change(1) - 9 * change(2) + change(3)) / (60 * h);
}

VectorXd Slopes(const std::string& example, const Parameter& parameter) {
  const LoadStudy study = StudyOf(example);
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, kClosed);
  const KinematicTree& tree = prepared.model.tree;
  Design<Dual> design = DesignOf<Dual>(tree.mechanism);
  parameter.seed(tree.mechanism, &design);
  LoadWorkspace<Dual> ws(prepared.model, DesignOfTree(tree, design));
  EXPECT_TRUE(EvaluatePoseLoads(prepared.model, motion, kPose, &ws));
  VectorXd slopes(6 * ws.loads.size());
  for (size_t j = 0; j < ws.loads.size(); ++j) {
    const Vector6<Dual> W = ws.loads[j].W_F.Stacked();
    for (int k = 0; k < 6; ++k) slopes[6 * j + k] = W[k].slope;
  }
  return slopes;
}

/// Zero where statics does not determine a component: the rule that settles it goes by the size of
/// the mechanism, which a design's slopes leave alone.
VectorXd CertainPart(const LoadStudyResult& result, VectorXd loads) {
  for (size_t j = 0; j < result.certainty.size(); ++j) {
    for (int k = 0; k < 6; ++k) {
      if (result.certainty[j][k] != Certainty::kCertain) loads[6 * j + k] = 0;
    }
  }
  return loads;
}

void ExpectSameDerivative(const std::string& example, const Parameter& parameter) {
  const LoadStudyResult result = RunLoadStudy(StudyOf(example));
  const VectorXd slopes = CertainPart(result, Slopes(example, parameter));
  const VectorXd differences = CertainPart(result, Difference(example, parameter));
  const double scale = Loads(StudyOf(example)).lpNorm<Eigen::Infinity>();
  EXPECT_LE((slopes - differences).lpNorm<Eigen::Infinity>(),
            kExact * (scale + slopes.lpNorm<Eigen::Infinity>()));
}

TEST(DesignDerivatives, OfTheSliderCrankByTheLengthOfItsCrank) {
  ExpectSameDerivative("slider-crank", LengthOf("crank"));
}

TEST(DesignDerivatives, OfTheSliderCrankByTheMassOfItsSlider) {
  ExpectSameDerivative("slider-crank", MassOf("slider"));
}

/// Those whose poses need no dense system of their own, as local freedoms do.
std::vector<DrivenExample> ExamplesWithoutLocalFreedoms() {
  std::vector<DrivenExample> examples = DrivenExamples();
  std::erase_if(examples, [](const DrivenExample& example) {
    return !RunsInLanes(PrepareStudy(StudyOf(example.name)).model);
  });
  return examples;
}

class EveryDesign : public testing::TestWithParam<DrivenExample> {};

TEST_P(EveryDesign, HasTheDerivativeBySizeThatDifferencesHave) {
  ExpectSameDerivative(GetParam().name, Size());
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryDesign, testing::ValuesIn(ExamplesWithoutLocalFreedoms()),
                         [](const auto& info) { return TestName(info.param.name); });

}  // namespace
}  // namespace vmech
