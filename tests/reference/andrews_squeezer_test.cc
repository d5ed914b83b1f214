#include <gtest/gtest.h>

#include <array>

#include "reference_case.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech::reference::andrews_squeezer_test {
namespace {

/// Andrews' squeezing mechanism: problem "andrews" of the CWI/Bari test set for initial value
/// problems. The digits published at 0.03 s (PSIDE, tolerance 1e-14) are met by the extrapolation
/// with projection behind this table to 1.4e-9 in q, 5e-8 in v and 1.3e-6 in the pin forces.
struct Row {
  double t;
  double q[7], v[7], a[7];  // beta, Theta, gamma, Phi, delta, Omega, epsilon [rad]
  double pin[6];            // force of the common pin on K3, K4, K6 (x, y) [N]
};
constexpr Row kRows[] = {
    {0,
     {-0.06171389001427645, 0, 0.45527981916307037, 0.22266839016588588, 0.48736497954384256,
      -0.22266839016588588, 1.2305474445498212},
     {0, 0, 0, 0, 0, 0, 0},
     {14222.443919954108, -10666.832939965581, 0, 0, 0, 0, 0},
     {98.56687039624114, -6.122688344255667, 0, 0, 0, 0}},
    {0.006,
     {0.39855864753146014, -0.3385474842625296, 0.43822824315877384, 0.18847115133242007,
      0.4911068490961541, -0.18847115133241998, 1.2177310251794824},
     {227.53025912079246, -166.36990615606072, -16.262727157025104, -32.39478004333738,
      3.4624482789407023, 32.39478004333737, -12.029029868861054},
     {86986.64360059802, -64894.273226701094, -13401.253549708617, -26286.240701482053,
      2653.609173539261, 26286.240701482046, -9542.493951845105},
     {82.15281896166876, 9.506366371299181, -3.542929193453813, 2.9376490771683366,
      -5.4396551745907376, -7.999373622889737}},
    {0.01,
     {2.1601131315314817, -1.8833642311069945, 0.1585167580012353, -0.3286410751746553,
      0.5251547747977292, 0.3286410751746554, 1.0684272046324037},
     {711.9231528310961, -786.7700808599222, -136.4381913781203, -240.293029267866,
      4.791548225371859, 240.29302926786602, -41.140566961612976},
     {209058.27853253466, -369745.6001716043, -6373.7739358478975, -5657.410331004695,
      -11869.750534558167, 5657.410331004683, 34721.43750142918},
     {57.02529043750047, 2.967904246250924, 3.21886038500867, -18.179269867939766,
      5.159502718031898, 34.24011729160405}},
    {0.016,
     {6.083336444320994, -6.178445618756641, 0.4536022298807781, 0.21928292268071886,
      0.48774314912732936, -0.21928292268071886, 1.2292683889302334},
     {420.4882144311659, -322.6610082897044, 10.305077212737329, 20.781749256198335,
      -2.3161912306394288, -20.781749256198346, 7.8447772906316375},
     {-785.4041194379674, 26092.276026696654, -32200.26394880542, -64759.518340548406,
      7153.6927977814075, 64759.51834054841, -24362.83949957482},
     {74.76935381393102, 8.287845881181672, -9.557370089439896, 7.819359783822198,
      -14.175404044263692, -20.323910779534746}},
    {0.02,
     {8.184905889662906, -7.890505363731717, 0.20953691338445085, -0.23832559659629077,
      0.5225369171560129, 0.2383255965962905, 1.0862751085997755},
     {726.5583426094728, -748.6324206329523, -145.73923758446978, -259.5007994768743,
      9.790501855145445, 259.5007994768743, -57.75747174270867},
     {177724.33274478946, -341202.0452728731, -33195.92383618986, -49292.53467824334,
      -10758.941706749265, 49292.53467824331, 24149.46019532651},
     {48.493256981780505, 9.300377345690336, 2.3032331312989784, -15.77388980800903,
      2.942253254541557, 22.988032419331745}},
    {0.026,
     {12.70238752233775, -12.71294959565028, 0.4520036511850386, 0.21606127281294554,
      0.48810144351644774, -0.21606127281294601, 1.2280532660302768},
     {603.3077760763903, -443.1135074162168, -19.692675898184923, -39.66094894305044,
      4.401412135601729, 39.66094894305045, -14.94675769174528},
     {18744.251593765148, 4492.4696398803335, -57950.09324746329, -116069.32641650234,
      12647.888250797581, 116069.32641650237, -43437.93732207989},
     {54.02795915666197, 23.419120369542497, -16.917312540937544, 13.839121084150152,
      -25.23301385263384, -36.25379212052935}},
    {0.03,
     {15.810771195155032, -15.756371058413496, 0.040822240119658605, -0.5347301163420572,
      0.5244099658799546, 0.5347301163420572, 1.0480807410419382},
     {1139.9203022591341, -1424.3792951775504, 11.032911910996063, 19.293374105692106,
      0.5735699148488163, -19.29337410569211, 0.32317914926047386},
     {-24631.763124191697, 51850.31963849757, 324102.60070753994, 566749.4220009266,
      16743.635418332688, -566749.4220009266, 9826.507801577154},
     {199.17534810452693, -29.755309975079463, 23.066543611618478, 31.452725275748136,
      22.642494786391474, 11.617392352646883}},
};
constexpr const char* kJoints[] = {"main", "k2", "k3", "k4", "k5", "k6", "k7"};
constexpr double kMotorTorque = 0.033;  // [N m]

// What the source of the table recommends.
constexpr double kPositionTolerance = 1e-8;  // [rad]
constexpr double kVelocityTolerance = 1e-6;  // relative
constexpr double kForceTolerance = 1e-5;     // relative, accelerations and pin forces

double Largest(const double* values, int count) {
  return Eigen::Map<const VectorXd>(values, count).cwiseAbs().maxCoeff();
}

class AndrewsSqueezer : public testing::TestWithParam<Row> {
 protected:
  AndrewsSqueezer() : squeezer_(Example("andrews-squeezer")) {
    for (int i = 0; i < 7; ++i) SetStart(&squeezer_, kJoints[i], {row_.q[i]});
    const double k2 = row_.q[0] + row_.q[1];  // angle of K2 against the x axis
    SetStart(&squeezer_, "k3_p", {row_.q[2] - k2});
    SetStart(&squeezer_, "k4_p", {row_.q[3] + row_.q[4] - k2});
    SetStart(&squeezer_, "k6_p", {row_.q[5] + row_.q[6] - k2});
    study_ = StudyAt(squeezer_, {{"main", {row_.q[0], row_.v[0], row_.a[0]}}});
    loads_ = RunLoadStudy(study_).poses.front();
  }

  const Row row_ = GetParam();
  Mechanism squeezer_;
  LoadStudy study_;
  PoseLoads loads_;
};

TEST_P(AndrewsSqueezer, SevenAnglesMoveTogetherAsInTheTable) {
  for (int i = 0; i < 7; ++i) {
    const int joint = FindJoint(squeezer_, kJoints[i]);
    EXPECT_NEAR(loads_.joints[joint].position[0], row_.q[i], kPositionTolerance) << kJoints[i];
    EXPECT_NEAR(loads_.joints[joint].rate[0], row_.v[i],
                kVelocityTolerance * (1 + Largest(row_.v, 7)))
        << kJoints[i];
  }
}

TEST_P(AndrewsSqueezer, PinForcesAreTheMultipliers) {
  const std::array<const char*, 3> pins = {"k3_p", "k4_p", "k6_p"};
  for (int i = 0; i < 3; ++i) {
    const Vector3d force = OnSecond_W(squeezer_, loads_, pins[i]).force;
    const double tolerance = kForceTolerance * Largest(row_.pin, 6);
    EXPECT_NEAR(force.x(), row_.pin[2 * i], tolerance) << pins[i];
    EXPECT_NEAR(force.y(), row_.pin[2 * i + 1], tolerance) << pins[i];
  }
}

TEST_P(AndrewsSqueezer, TheDriveExertsTheTorqueOfTheMotor) {
  // Moments of the crank's pin make the scale: its force times its radius of 7 mm.
  EXPECT_NEAR(loads_.drives[0].force, kMotorTorque,
              kForceTolerance * (kMotorTorque + 0.007 * Largest(row_.pin, 6)));
}

INSTANTIATE_TEST_SUITE_P(History, AndrewsSqueezer, testing::ValuesIn(kRows));

}  // namespace
}  // namespace vmech::reference::andrews_squeezer_test
