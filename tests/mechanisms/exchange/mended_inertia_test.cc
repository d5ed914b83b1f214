#include "vmech/mechanisms/exchange/mended_inertia.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/examples.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech::mended_inertia_test {
namespace {

constexpr double kRounding = 1e-14;  // of figures of order one

Matrix3d SecondMoments(const Matrix3d& I) {
  return 0.5 * I.trace() * Matrix3d::Identity() - I;
}

Matrix3d RandomInertia(Random* random) {
  const Matrix3d M = Matrix3d::NullaryExpr([&] { return random->Between(-1, 1); });
  return 0.5 * (M + M.transpose()) + Matrix3d::Identity();
}

/// In principal axes: (b + c - a) / 2 and so on, of which the one below zero is put to zero.
TEST(NearestInertia, IsThatOfAFlatBodyWhereOneMomentIsTooLarge) {
  const Matrix3d I = NearestInertia(Vector3d(0.001, 0.002, 0.0035).asDiagonal());
  EXPECT_LT((I - Matrix3d(Vector3d(0.00125, 0.00225, 0.0035).asDiagonal())).norm(),
            kRounding * I.norm());
}

TEST(NearestInertia, IsTheSameWhereABodyHasIt) {
  const Matrix3d I = Vector3d(1, 2, 2.5).asDiagonal();
  EXPECT_LT((NearestInertia(I) - I).norm(), kRounding);
}

TEST(NearestInertia, TurnsWithTheAxes) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Matrix3d I = RandomInertia(&random);
    const Matrix3d R = AxesFromZX(random.Vector(3), random.Vector(3));
    EXPECT_LT((NearestInertia(RotatedInertia(R, I)) - RotatedInertia(R, NearestInertia(I))).norm(),
              10 * kRounding);
  }
}

/// The projection P of X on a convex cone: <X - P, Y - P> <= 0 for every Y of the cone.
TEST(NearestInertia, HasNoBodyNearer) {
  Random random(2);
  int mended = 0;
  for (int i = 0; i < 200; ++i) {
    const Matrix3d I = RandomInertia(&random);
    const Matrix3d X = SecondMoments(I), P = SecondMoments(NearestInertia(I));
    const double lowest =
        Eigen::SelfAdjointEigenSolver<Matrix3d>(P, Eigen::EigenvaluesOnly).eigenvalues()[0];
    EXPECT_GT(lowest, -kRounding);
    mended += (X - P).norm() > 1e-3 ? 1 : 0;
    for (int k = 0; k < 20; ++k) {
      const Vector3d y = random.Vector(3);
      const Matrix3d Y = y * y.transpose();  // of a point mass
      EXPECT_LT(((X - P).array() * (Y - P).array()).sum(), 10 * kRounding);
    }
  }
  EXPECT_GT(mended, 50);
}

TEST(MendInertia, SaysTheFiguresBeforeAndAfter) {
  MassProperties bar{2, {0.5, 0, 0}, Vector3d(0.001, 0.002, 0.0035).asDiagonal()};
  const Mending mending = MendInertia(&bar);
  EXPECT_EQ(mending.defect,
            "the largest moment of inertia exceeds the sum of the two others: principal moments "
            "0.001, 0.002, 0.0035 kg m^2 about the centre of gravity");
  EXPECT_EQ(mending.change, "mended by the least change to [0.00125, 0.00225, 0.0035] kg m^2");
  EXPECT_EQ(MendInertia(&bar).defect, "");
}

TEST(MendInertia, DropsThatWithoutMass) {
  MassProperties base{0, Vector3d::Zero(), 0.1 * Matrix3d::Identity()};
  EXPECT_EQ(MendInertia(&base).defect,
            "no mass, but principal moments of inertia [0.1, 0.1, 0.1] kg m^2");
  EXPECT_EQ(base.I_Lcm, Matrix3d::Zero());
}

TEST(MendInertia, LeavesPointsAndRodsAndRoundedFiguresAlone) {
  for (const Vector3d& moments :
       {Vector3d(0, 0, 0), Vector3d(0, 1, 1), Vector3d(0.0345, 0.0612, 0.0958)}) {
    MassProperties body{1, Vector3d::Zero(), moments.asDiagonal()};
    EXPECT_EQ(MendInertia(&body).defect, "");
    EXPECT_EQ(body.I_Lcm, Matrix3d(moments.asDiagonal()));
  }
}

}  // namespace
}  // namespace vmech::mended_inertia_test
