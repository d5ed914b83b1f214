#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference_case.h"

namespace vmech::reference::four_bar_test {
namespace {

/// Planar four-bar driven at 5 rad/s and 2 rad/s^2: forces by a free-body matrix of the plane,
/// which agrees with Lagrange multipliers in absolute coordinates to 4e-10. Geometry and masses of
/// the four-bar example of RigidBodyDynamics.jl. Angles of coupler and rocker against the x axis.
struct Row {
  double crank_deg;
  double coupler, rocker;              // [rad]
  double coupler_rate, rocker_rate;    // [rad/s]
  double coupler_alpha, rocker_alpha;  // [rad/s^2]
  double ground_on_crank[2], crank_on_coupler[2], coupler_on_rocker[2], ground_on_rocker[2];  // [N]
  double crank_torque;  // [N m]
};
constexpr Row kRows[] = {
    {0,
     0.5367501772287115,
     0.9581921787462746,
     -4.166666666666666,
     -4.166666666666664,
     25.17647219307144,
     62.52344799792447,
     {-162.74118077817067, -85.0172443671513},
     {-159.61618077817067, -90.17224436715131},
     {-130.44002665854424, -108.6373432544793},
     {113.24541106882441, 122.11116741997527},
     -43.13137218357565},
    {30,
     0.2678721668187818,
     0.8584363889592065,
     -1.2294893338888238,
     1.5142177406506483,
     16.857744644604658,
     30.486967189664043,
     {-76.51248188032763, -15.475401553997767},
     {-73.68115249350126, -19.034407904943876},
     {-58.804049418731985, -32.974292858971765},
     {51.893216192894585, 45.44819704807352},
     11.96861137892761},
    {60,
     0.20376450403606317,
     1.1223506133514483,
     -0.19681996537227614,
     3.1327904031675233,
     5.3026144080887425,
     7.779628868123444,
     {-20.405275796623474, -1.8462342763748714},
     {-18.626269445677366, -4.169904889548501},
     {-10.843668144940482, -6.765631515189141},
     {7.675226695806984, 12.584420564659176},
     8.36456003645812},
    {90,
     0.20671522643209805,
     1.4713626140597063,
     0.21689784712284055,
     3.42146142892766,
     3.299018780642735,
     1.3348799690469602,
     {-3.112551160349721, -0.5576428374861733},
     {-2.862551160349721, -2.3376428374861735},
     {-1.4286587091449943, -1.5791197497884966},
     {0.7282393707414497, 5.697727434015239},
     2.159775580174861},
    {120,
     0.2470439288577873,
     1.8220069343757717,
     0.560488866836842,
     3.2067005713100385,
     3.8287036774238112,
     -2.722589768793933,
     {9.016521047501904, 1.9891609353373232},
     {7.670527398448014, -0.08450967783630581},
     {3.03107861129764, -0.7505768194682688},
     {-1.570482494515694, 5.497121255931797},
     -3.1849333742811936},
    {150,
     0.3278101518580275,
     2.1284743351615867,
     1.0060499361712136,
     2.5750991815538073,
     5.350827938258038,
     -7.033819396321663,
     {19.763901617427084, 7.727073618691757},
     {17.182572230600712, 4.601079969637866},
     {8.46588406639425, -0.936904517549486},
     {-5.800362023478958, 7.758902409359163},
     -6.621432778315908},
    {180,
     0.46195629121858583,
     2.347653493231837,
     1.5625,
     1.5625000000000002,
     5.905119557357832,
     -10.162762840069856,
     {25.719038819505226, 16.224502950700856},
     {22.594038819505226, 11.569502950700857},
     {12.984488770923125, 0.24068902238643952},
     {-10.46482623448655, 8.630921423849374},
     -6.28250147535043},
    {210,
     0.651119297277136,
     2.451783480580695,
     2.004418270659794,
     0.4353690252771979,
     3.4824354639111514,
     -10.157451266974626,
     {23.013530476836962, 24.26568393356763},
     {20.182201090010594, 18.01469028451374},
     {12.040676015564129, 2.619764668265339},
     {-10.181526289968835, 6.907439070340124},
     -3.0885030927368247},
    {240,
     0.8678104604035252,
     2.4427734659215097,
     2.0514514316706203,
     -0.5947602728025745,
     -1.2339471274164595,
     -9.902209937212769,
     {16.161571461542056, 30.60927405380569},
     {14.382565110595944, 23.122944666979322},
     {8.334156665296334, 5.392689850391607},
     {-6.46635985774079, 4.033007181809625},
     0.5624722119350793},
    {270,
     1.0599702126858501,
     2.324617600313459,
     1.4954309200004483,
     -1.709132661804371,
     -8.574630853782875,
     -13.102420530822501,
     {9.9015220100266, 38.1010191194063},
     {9.6515220100266, 30.071019119406305},
     {4.819518838755979, 11.446788124751063},
     {-1.5705164603030148, -2.1661148787596276},
     5.554261005013296},
    {300,
     1.1460855137346238,
     2.064671623050009,
     -0.07790530935299848,
     -3.4075156778927975,
     -22.258889479424056,
     -22.445563314221182,
     {8.320691274335028, 53.59977903343953},
     {9.666684923388917, 45.86344964661316},
     {2.8833418111241023, 30.23461291288796},
     {4.223155996655347, -22.759979442833615},
     16.993284768670705},
    {330,
     0.9850974014197662,
     1.5756616235601915,
     -3.2310238039118717,
     -5.9747308784513455,
     -35.219660660878304,
     -23.78540377545052,
     {17.020607014402955, 61.87770446521394},
     {19.601936401229324, 55.193698114267825},
     {15.780045150055408, 55.168659405084384},
     {-9.041632631435416, -57.81838989961597},
     30.590520099580594},
};

constexpr double kTolerance = 1e-9;  // to which the two methods behind the table agree

MotionSample CrankAt(const Row& row) {
  return {row.crank_deg * std::numbers::pi / 180, 5, 2};
}

/// The linkage in the assembly mode of the table.
Mechanism FourBarAt(const Row& row) {
  Mechanism four_bar = Example("four-bar");
  const double crank = CrankAt(row).position;
  SetStart(&four_bar, "main", {crank});
  SetStart(&four_bar, "crank_pin", {row.coupler - crank});
  SetStart(&four_bar, "rocker_pin", {row.rocker - row.coupler});
  SetStart(&four_bar, "rocker_pivot", {row.rocker});
  return four_bar;
}

class FourBar : public testing::TestWithParam<Row> {
 protected:
  void ExpectForce(const std::string& joint, const double expected[2]) const {
    const Vector3d force = OnSecond_W(four_bar_, loads_, joint).force;
    const double scale = 1 + std::hypot(expected[0], expected[1]);
    EXPECT_NEAR(force.x(), expected[0], kTolerance * scale) << joint;
    EXPECT_NEAR(force.y(), expected[1], kTolerance * scale) << joint;
  }

  const Row row_ = GetParam();
  const Mechanism four_bar_ = FourBarAt(row_);
  const PoseLoads loads_ = LoadsAt(four_bar_, {{"main", CrankAt(row_)}});
};

TEST_P(FourBar, PinForcesAreThoseOfTheFreeBodies) {
  ExpectForce("main", row_.ground_on_crank);
  ExpectForce("crank_pin", row_.crank_on_coupler);
  ExpectForce("rocker_pin", row_.coupler_on_rocker);
  ExpectForce("rocker_pivot", row_.ground_on_rocker);
}

TEST_P(FourBar, CrankTorqueIsThatOfTheFreeBodies) {
  EXPECT_NEAR(loads_.drives[0].force, row_.crank_torque,
              kTolerance * (1 + std::abs(row_.crank_torque)));
}

TEST_P(FourBar, CouplerAndRockerMoveAsTheTableSays) {
  const LinkMotion& coupler = loads_.links[FindLink(four_bar_, "coupler")];
  const LinkMotion& rocker = loads_.links[FindLink(four_bar_, "rocker")];
  EXPECT_NEAR(std::atan2(coupler.X_WL.R(1, 0), coupler.X_WL.R(0, 0)), row_.coupler, kTolerance);
  EXPECT_NEAR(std::remainder(Position(four_bar_, loads_, "rocker_pivot") - row_.rocker,
                             2 * std::numbers::pi),
              0, kTolerance);
  const auto expect_near = [](double actual, double expected) {
    EXPECT_NEAR(actual, expected, kTolerance * (1 + std::abs(expected)));
  };
  expect_near(coupler.w.z(), row_.coupler_rate);
  expect_near(rocker.w.z(), row_.rocker_rate);
  expect_near(coupler.alpha.z(), row_.coupler_alpha);
  expect_near(rocker.alpha.z(), row_.rocker_alpha);
}

INSTANTIATE_TEST_SUITE_P(Every30Degrees, FourBar, testing::ValuesIn(kRows));

}  // namespace
}  // namespace vmech::reference::four_bar_test
