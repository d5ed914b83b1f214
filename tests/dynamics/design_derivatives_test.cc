// Derivatives of joint loads by numbers of a study, taken through the kernels by dual numbers,
// against differences of whole studies that are changed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/driven_examples.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/dynamics/sensitivity/load_derivatives.h"
#include "vmech/dynamics/sensitivity/load_gradient.h"
#include "vmech/dynamics/sensitivity/study_change.h"

namespace vmech {
namespace {

constexpr double kExact = 1e-8;    // relative to the largest load: what differences resolve
constexpr double kClosed = 1e-14;  // of poses that differences are taken of
constexpr double kStep = 2e-3;     // of the parameters, which are shares of what the file has

/// A change of a study by a share of what it is.
using Change = std::function<void(double by, LoadStudy*)>;

/// All lengths together: whatever loops a mechanism has stay closed.
void ChangeSize(double by, LoadStudy* study) {
  for (Link& link : study->mechanism.links) {
    for (Anchor& anchor : link.anchors) anchor.X_LA.p *= 1 + by;
  }
}

/// Everything but the geometry: bodies, springs, dampers, friction, weight, speed and push.
void ChangeForces(double by, LoadStudy* study) {
  for (Link& link : study->mechanism.links) {
    MassProperties& body = link.mass_properties;
    body.mass *= 1 + by;
    body.I_Lcm *= 1 + 2 * by;
    body.p_LoLcm *= 1 - by;
  }
  for (Joint& joint : study->mechanism.joints) {
    for (Passive& passive : joint.passive) {
      passive.stiffness *= 1 + 3 * by;
      passive.rest += 0.1 * by;
      passive.viscous *= 1 - 2 * by;
      passive.coulomb *= 1 + by;
    }
    joint.load_friction.coefficient *= 1 + by;
    joint.load_friction.radius *= 1 - by;
    joint.load_friction.length *= 1 + by;
  }
  study->mechanism.gravity_W += by * Vector3d(1, 2, 3);
  for (ExternalLoad& load : study->external) {
    load.p_L += by * Vector3d(0.01, 0.02, -0.03);
    for (Wrenchd& W : load.wrenches) W.force *= 1 - by;
  }
}

/// The same path in less time.
void ChangeSpeed(double by, LoadStudy* study) {
  for (double& time : study->times) time /= 1 + by;
  for (JointDrive& drive : study->drives) {
    const MotionSample start = drive.law.At(0);
    drive.law = MotionLaw::Uniform(start.position, start.velocity * (1 + by),
                                   start.acceleration * (1 + by) * (1 + by));
  }
}

StudyAt Changed(const LoadStudy& study, const Change& change) {
  return [&study, change](double by) {
    LoadStudy changed = study;
    change(by, &changed);
    return changed;
  };
}

/// All joint wrenches and drive forces of a study.
VectorXd Loads(const LoadStudy& study) {
  LoadStudyOptions options;
  options.closure_tolerance = kClosed;
  const LoadStudyResult result = RunLoadStudy(study, options);
  const LoadArrays& loads = result.poses.arrays();
  VectorXd all(loads.wrenches.size() + loads.drive_forces.size());
  all << Eigen::Map<const VectorXd>(loads.wrenches.data(), loads.wrenches.size()),
      Eigen::Map<const VectorXd>(loads.drive_forces.data(), loads.drive_forces.size());
  return all;
}

/// By a stencil of sixth order.
VectorXd Difference(const StudyAt& at) {
  const auto change = [&](int k) -> VectorXd {
    return Loads(at(k * kStep)) - Loads(at(-k * kStep));
  };
  return (45 * change(1) - 9 * change(2) + change(3)) / (60 * kStep);
}

VectorXd Slopes(const LoadStudy& study, const StudyAt& at) {
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, kClosed);
  const StudyChange change = ChangeOfStudy(prepared, motion, at, 0, 1e-3);
  const LoadRows<Dual> loads = DifferentiateLoads(prepared, motion, change);
  const LoadLayout& layout = loads.layout;
  std::vector<double> wrenches, drive_forces;
  for (size_t i = 0; i < motion.size(); ++i) {
    const auto slope = [&](size_t k) { return loads.row(i)[k].slope; };
    for (size_t k = 0; k < 6 * layout.joints; ++k) wrenches.push_back(slope(layout.wrench(0) + k));
    for (size_t k = 0; k < layout.drives; ++k) drive_forces.push_back(slope(layout.drive_force(k)));
  }
  wrenches.insert(wrenches.end(), drive_forces.begin(), drive_forces.end());
  return Eigen::Map<const VectorXd>(wrenches.data(), static_cast<Eigen::Index>(wrenches.size()));
}

/// A sum over some of the poses of everything that comes of a study, each with a weight of its own.
LoadRows<double> SomeSum(const LoadModel& model, const Motion& motion) {
  LoadRows<double> weights{LoadLayout(model), {}, {}};
  for (size_t i = 0; i < motion.size(); ++i) {
    if (i % 7 == 3) continue;
    weights.poses.push_back(i);
    for (size_t k = 0; k < weights.layout.width(); ++k) {
      weights.numbers.push_back(std::sin(1.0 + 2.3 * static_cast<double>(i + 5 * k)));
    }
  }
  return weights;
}

/// The slope of the sum by what one pass backwards through the poses has, and by what duals have.
void ExpectSameGradient(const LoadStudy& study, const Change& change) {
  constexpr double kRounding = 1e-11;  // of the terms, of which there are thousands
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, kClosed);
  if (!LoadGradients::Exist(prepared.model, motion)) return;
  const std::vector<StudyChange> changes{
      ChangeOfStudy(prepared, motion, Changed(study, change), 0, 1e-3)};
  const LoadRows<double> weights = SomeSum(prepared.model, motion);
  const LoadRows<Dual> loads = DifferentiateLoads(prepared, motion, changes[0]);
  double slope = 0, size = 0;
  for (size_t i = 0; i < weights.poses.size(); ++i) {
    for (size_t k = 0; k < weights.layout.width(); ++k) {
      const double term = weights.row(i)[k] * loads.row(weights.poses[i])[k].slope;
      slope += term;
      size += std::abs(term);
    }
  }
  LoadGradients gradients(prepared, motion, changes);
  for (int again = 0; again < 2; ++again) {
    const double swept = SlopeAlong(changes[0], gradients.Of(weights), prepared.model, motion);
    EXPECT_LE(std::abs(swept - slope), kRounding * size);
  }
}

/// Zero where statics does not determine a component: the rule that settles it goes by the size of
/// the mechanism, which slopes leave alone.
VectorXd CertainPart(const LoadStudyResult& result, VectorXd loads) {
  const size_t joints = result.certainty.size();
  for (size_t i = 0; i < result.poses.size(); ++i) {
    for (size_t j = 0; j < joints; ++j) {
      for (size_t k = 0; k < 6; ++k) {
        if (result.certainty[j][k] != Certainty::kCertain) loads[6 * (i * joints + j) + k] = 0;
      }
    }
  }
  return loads;
}

void ExpectSameDerivative(const LoadStudy& study, const Change& change) {
  const LoadStudyResult result = RunLoadStudy(study);
  const StudyAt at = Changed(study, change);
  const VectorXd slopes = CertainPart(result, Slopes(study, at));
  const VectorXd differences = CertainPart(result, Difference(at));
  const double scale = CertainPart(result, Loads(study)).lpNorm<Eigen::Infinity>();
  EXPECT_LE((slopes - differences).lpNorm<Eigen::Infinity>(),
            kExact * (scale + slopes.lpNorm<Eigen::Infinity>()));
}

class EveryDesign : public testing::TestWithParam<DrivenExample> {
 protected:
  const LoadStudy study_ = StudyOf(GetParam().name);
};

TEST_P(EveryDesign, HasTheDerivativeBySizeThatDifferencesHave) {
  ExpectSameDerivative(study_, ChangeSize);
}

TEST_P(EveryDesign, HasTheDerivativeByForcesThatDifferencesHave) {
  ExpectSameDerivative(study_, ChangeForces);
  EXPECT_GT(Slopes(study_, Changed(study_, ChangeForces)).lpNorm<Eigen::Infinity>(), 0);
}

TEST_P(EveryDesign, HasTheDerivativeBySpeedThatDifferencesHave) {
  ExpectSameDerivative(study_, ChangeSpeed);
}

TEST_P(EveryDesign, HasTheGradientForwardsAndBackwards) {
  ExpectSameGradient(study_, ChangeSize);
  ExpectSameGradient(study_, ChangeForces);
  ExpectSameGradient(study_, ChangeSpeed);
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryDesign, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

/// The length of a link: where its last anchor is.
Change LengthOf(const std::string& name) {
  return [name](double by, LoadStudy* study) {
    Mechanism& mechanism = study->mechanism;
    mechanism.links[FindLink(mechanism, name)].anchors.back().X_LA.p *= 1 + by;
  };
}

TEST(DesignDerivatives, OfTheSliderCrankByTheLengthOfItsCrank) {
  ExpectSameDerivative(StudyOf("slider-crank"), LengthOf("crank"));
}

TEST(DesignDerivatives, OfALoadThatGoesByTheDrivesCoordinate) {
  LoadStudy study = StudyOf("slider-crank");
  ExternalLoad& load = study.external[0];
  load.over = ExternalLoad::Over::kDriveCoordinate;
  load.at = {-20, -1, 0.3, 20};
  load.wrenches = {{{1, 2, 0}, {0, 0, 0}},
                   {{30, -20, 0}, {0, 0, 1}},
                   {{-70, 15, 0}, {0, 0, 2}},
                   {{5, 80, 0}, {0, 0, 0}}};
  const auto shift = [](double by, LoadStudy* changed) {
    for (double& at : changed->external[0].at) at += by;
  };
  for (const Change& change : {Change(ChangeForces), Change(shift), Change(ChangeSpeed)}) {
    ExpectSameDerivative(study, change);
    ExpectSameGradient(study, change);
  }
}

TEST(DesignDerivatives, AreSweptBackThroughMostExamples) {
  size_t swept = 0;
  for (const DrivenExample& example : DrivenExamples()) {
    const LoadStudy study = StudyOf(example.name);
    const PreparedStudy prepared = PrepareStudy(study);
    swept += LoadGradients::Exist(prepared.model, TrackMotion(study, prepared, kClosed)) ? 1 : 0;
  }
  EXPECT_GE(2 * swept, DrivenExamples().size());
}

TEST(DesignDerivatives, OfFrictionThatGoesByTheLoadsOfItsJoints) {
  LoadStudy study = StudyOf("slider-crank");
  for (Joint& joint : study.mechanism.joints) {
    const bool slides = joint.type == JointType::kPrismatic;
    joint.load_friction = {0.12, slides ? 0 : 0.008, 0, 0.04, slides ? 0.03 : 0};
  }
  const PreparedStudy prepared = PrepareStudy(study);
  ASSERT_TRUE(prepared.model.has_load_friction);
  const StudyAt at = Changed(study, ChangeForces);
  const VectorXd slopes = Slopes(study, at), differences = Difference(at);
  EXPECT_GT(slopes.lpNorm<Eigen::Infinity>(), 1);
  EXPECT_LE((slopes - differences).lpNorm<Eigen::Infinity>(),
            kExact * (Loads(study).lpNorm<Eigen::Infinity>() + slopes.lpNorm<Eigen::Infinity>()));
}

/// Runs a study with this change and returns what is said against it.
std::string Refusal(const LoadStudy& study, const Change& change) {
  try {
    Slopes(study, Changed(study, change));
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(DesignDerivatives, AreRefusedWhereTheLoopOpens) {
  // A planar four-bar whose rod leaves the plane.
  const auto lift = [](double by, LoadStudy* study) {
    Mechanism& mechanism = study->mechanism;
    mechanism.links[FindLink(mechanism, "coupler")].anchors.back().X_LA.p.z() += by;
  };
  EXPECT_THAT(Refusal(StudyOf("four-bar"), lift), testing::HasSubstr("cannot stay closed"));
}

TEST(DesignDerivatives, AreRefusedWhereTheStudyTakesAnotherForm) {
  const auto longer = [](double by, LoadStudy* study) {
    if (by > 0) study->times.push_back(study->times.back() + 1);
  };
  EXPECT_THAT(Refusal(StudyOf("four-bar"), longer), testing::HasSubstr("another form"));
}

}  // namespace
}  // namespace vmech
