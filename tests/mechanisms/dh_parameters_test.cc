#include "vmech/mechanisms/dh/dh_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/examples.h"

namespace vmech::dh_parameters_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPublished = 1e-12;  // the figures have 15 digits and more
constexpr double kRounding = 1e-13;   // lengths and turns of order one through a few products
constexpr double kFarFeet = 1e-10;    // feet up to 1e4 m away, each figure good to 1e-16 of that

struct Line {
  Vector3d point, direction;
};

Posed FrameOn(const Line& line) {
  const Vector3d x =
      std::abs(line.direction.normalized().x()) > 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
  return {AxesFromZX(line.direction, x), line.point};
}

DhPair Between(const Line& a, const Line& b) {
  return DeduceDh(FrameOn(a).inverse() * FrameOn(b));
}

double Defect(const Posed& X, const Posed& Y) {
  return std::max((X.R - Y.R).cwiseAbs().maxCoeff(), (X.p - Y.p).cwiseAbs().maxCoeff());
}

Posed Rebuilt(const DhPair& pair) {
  return PoseOf(pair.row) * PoseOf({pair.theta, pair.d, 0, 0, 0});
}

// Pairs of lines with distance, angle and feet of the common normal, computed from the line
// geometry with 40 digits.
struct Published {
  const char* name;
  Line first, second;
  AxesRelation relation;
  double a, alpha, d, d_second;
};

const Published kPairs[] = {
    {"perpendicular skew",
     {{0, 0, 0}, {0, 0, 1}},
     {{0.3, 0.1, 0.4}, {0, 1, 0}},
     AxesRelation::kSkew,
     0.3,
     -kPi / 2,
     0.4,
     0.1},
    {"general skew",
     {{0.1, -0.2, 0.3}, {1, 2, 3}},
     {{-0.4, 0.5, 0.6}, {-2, 1, 0.5}},
     AxesRelation::kSkew,
     0.242863039881227866,
     -1.39492757670217163,
     0.350534218339874509,
     0.746075481564740268},
    {"intersecting",
     {{0, 0, 0}, {0, 0, 1}},
     {{1, 0, 0.7}, {1, 0, 0}},
     AxesRelation::kIntersecting,
     0,
     kPi / 2,
     0.7,
     1},
    {"parallel",
     {{0, 0, 0}, {0, 0, 1}},
     {{0.3, 0.4, 5}, {0, 0, 2}},
     AxesRelation::kParallel,
     0.5,
     0,
     0,
     5},
    {"antiparallel",
     {{0, 0, 0}, {0, 0, 1}},
     {{0.3, 0.4, 5}, {0, 0, -1}},
     AxesRelation::kParallel,
     0.5,
     kPi,
     0,
     -5},
    {"collinear",
     {{0, 0, 0}, {1, 1, 1}},
     {{2, 2, 2}, {1, 1, 1}},
     AxesRelation::kCoincident,
     0,
     0,
     0,
     2 * std::numbers::sqrt3},
};

TEST(DeduceDh, GivesTheCommonNormalOfEveryKindOfPair) {
  for (const Published& pair : kPairs) {
    SCOPED_TRACE(pair.name);
    const DhPair found = Between(pair.first, pair.second);
    EXPECT_EQ(found.relation, pair.relation) << NameOf(found.relation);
    EXPECT_NEAR(found.row.a, pair.a, kPublished);
    EXPECT_NEAR(found.row.alpha, pair.alpha, kPublished);
    EXPECT_NEAR(found.row.d, pair.d, kPublished);
    EXPECT_NEAR(found.d, pair.d_second, kPublished);
    EXPECT_EQ(found.row.beta, 0);
  }
}

// Hayati's form of nearly parallel pairs: Rz(theta) Tx(a) Rx(alpha) Ry(beta), second axis through
// the plane z = 0 of the first, computed with 40 digits.
struct PublishedHayati {
  const char* name;
  Line second;
  double theta, a, alpha, beta;
};

const PublishedHayati kNearPairs[] = {
    {"1e-6 rad about the normal",
     {{0.5, 0, 0.2}, {0, 1e-6, 1}},
     -3.999999999999787e-07,
     0.50000000000004,
     -9.999999999995866e-07,
     -3.9999999999976807e-13},
    {"1e-6 rad across the normal, where the foot is 500 km away",
     {{0.5, 0, 0.2}, {1e-6, 0, 1}},
     0,
     0.4999998,
     0,
     9.999999999996666e-07},
    {"1e-9 rad oblique",
     {{0.5, 0.2, 0.1}, {6e-10, 8e-10, 1}},
     0.3805063770158132,
     0.5385164806280306,
     -5.199469469782195e-10,
     8.541985555642368e-10},
};

TEST(DeduceDh, TakesHayatisFormWhereAxesAreNearlyParallel) {
  for (const PublishedHayati& pair : kNearPairs) {
    SCOPED_TRACE(pair.name);
    const DhPair found = Between({{0, 0, 0}, {0, 0, 1}}, pair.second);
    EXPECT_EQ(found.relation, AxesRelation::kNearlyParallel);
    EXPECT_NEAR(found.row.theta, pair.theta, kPublished);
    EXPECT_NEAR(found.row.a, pair.a, kPublished);
    EXPECT_NEAR(found.row.alpha, pair.alpha, kPublished * 1e-6);
    EXPECT_NEAR(found.row.beta, pair.beta, kPublished * 1e-6);
    EXPECT_EQ(found.row.d, 0);
  }
}

// Axes of the PUMA 560 at q = 0 from its table (robotics-toolbox-python, MIT licence).
const std::vector<Line> kPuma{{{0, 0, 0}, {0, 0, 1}},
                              {{0, 0, 0.67183}, {0, -1, 0}},
                              {{0.4318, 0, 0.67183}, {0, -1, 0}},
                              {{0.4521, -0.15005, 0.67183}, {0, 0, 1}},
                              {{0.4521, -0.15005, 1.10363}, {0, -1, 0}},
                              {{0.4521, -0.15005, 1.10363}, {0, 0, 1}}};

TEST(DeduceDh, GivesBackTheTableOfThePuma560) {
  const double a[] = {0, 0.4318, 0.0203, 0, 0};
  const double alpha[] = {kPi / 2, 0, -kPi / 2, kPi / 2, -kPi / 2};
  const AxesRelation relation[] = {AxesRelation::kIntersecting, AxesRelation::kParallel,
                                   AxesRelation::kSkew, AxesRelation::kIntersecting,
                                   AxesRelation::kIntersecting};
  for (size_t i = 0; i + 1 < kPuma.size(); ++i) {
    const DhPair pair = Between(kPuma[i], kPuma[i + 1]);
    EXPECT_NEAR(pair.row.a, a[i], kPublished);
    EXPECT_NEAR(pair.row.alpha, alpha[i], kPublished);
    EXPECT_EQ(pair.relation, relation[i]) << i;
  }
  EXPECT_NEAR(Between(kPuma[0], kPuma[1]).row.d, 0.67183, kPublished);
  EXPECT_NEAR(Between(kPuma[2], kPuma[3]).row.d, 0.15005, kPublished);
  EXPECT_NEAR(Between(kPuma[3], kPuma[4]).row.d, 0.4318, kPublished);
}

TEST(DeduceDh, PutsAnyPoseBackTogetherFromSixParameters) {
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const Posed X{AxesFromZX(random.Vector(3), random.Vector(3)), random.Vector(3)};
    EXPECT_LT(Defect(Rebuilt(DeduceDh(X)), X), kFarFeet);
  }
}

TEST(DeduceDh, PutsNearlyParallelAxesBackTogetherAtEveryAngle) {
  Random random(2);
  for (double exponent = -16; exponent < -1; exponent += 0.01) {
    const Vector3d tilt = std::pow(10, exponent) * random.Vector(3).normalized();
    const double half_turn = random.Between(0, 1) < 0.5 ? 0 : kPi;
    const Posed X{(Eigen::AngleAxisd(half_turn, Vector3d::UnitX()) *
                   Eigen::AngleAxisd(tilt.norm(), tilt.normalized()) *
                   Eigen::AngleAxisd(random.Between(-3, 3), Vector3d::UnitZ()))
                      .toRotationMatrix(),
                  random.Vector(3)};
    const DhPair pair = DeduceDh(X);
    EXPECT_LT(Defect(Rebuilt(pair), X), kFarFeet) << "tilt " << tilt.norm();
    EXPECT_LT(std::abs(pair.row.d), 2 / kNearlyParallel);
    EXPECT_GE(pair.row.a, 0);
  }
}

TEST(DeduceDh, SaysNothingOfACoincidentAxisButItsOwnTurnAndShift) {
  const Posed X = PoseOf({0.3, -0.2, 0, 0, 0});
  const DhPair pair = DeduceDh(X);
  EXPECT_EQ(pair.relation, AxesRelation::kCoincident);
  EXPECT_EQ(Defect(PoseOf(pair.row), Posed()), 0);
  EXPECT_NEAR(pair.theta, 0.3, kRounding);
  EXPECT_NEAR(pair.d, -0.2, kRounding);
}

}  // namespace
}  // namespace vmech::dh_parameters_test
