#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference_case.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/paper_joint.h"

namespace vmech::reference::paper_cases_test {
namespace {

/// Equations (9)-(14) of the paper with numbers; the paper prints none. Computed in the plane from
/// textbook closed forms: the moments of the two-link arm, the free bodies of the four-bar.
constexpr double kTolerance = 1e-10;  // of the largest figure of a case: rounding

double Degrees(double angle) {
  return angle * std::numbers::pi / 180;
}

void ExpectPlanar(const Wrenchd& actual, const Vector3d& fx_fy_mz, const char* what) {
  const Vector3d planar(actual.force.x(), actual.force.y(), actual.moment.z());
  const double scale = 1 + fx_fy_mz.cwiseAbs().maxCoeff();
  EXPECT_LT((planar - fx_fy_mz).cwiseAbs().maxCoeff(), kTolerance * scale)
      << what << ": " << planar.transpose() << " instead of " << fx_fy_mz.transpose();
}

/// Newtons and newton metres weighted alike, as these cases are.
HeldLoads Held(const Mechanism& mechanism, const std::string& grasp,
               const std::vector<Driven>& drives, ReactionRule rule = ReactionRule::kMinimumNorm) {
  return LoadsInHand(mechanism, grasp, Vector6d::Ones(), drives, rule);
}

TEST(PaperEquations9And10, CrankHeldAtItsEnd) {
  const Mechanism crank = Example("crank");
  const std::vector<Driven> turn = {{"main", {Degrees(40), 3, 5}}};
  EXPECT_NEAR(LoadsAt(crank, turn).drives[0].force, 1.0217875184396612, kTolerance);
  ExpectPlanar(Held(crank, "tip", turn).hand, {-2.1893078552845684, 2.6091155018301095, 0}, "tip");
  ExpectPlanar(Held(crank, "handle", turn).hand,
               {-0.18076853850973498, 0.2154315551969815, 0.9374197416877625}, "handle");
}

TEST(PaperEquations9And10, TwoLinkArmHeldAtItsTip) {
  const Mechanism arm = Example("two-link-arm");
  const std::vector<Driven> swing = {{"shoulder", {Degrees(30), 1.5, 3}},
                                     {"elbow", {Degrees(50), -2, 4}}};
  const PoseLoads driven = LoadsAt(arm, swing);
  EXPECT_NEAR(driven.drives[0].force, 14.509677848245957, kTolerance * 14);
  EXPECT_NEAR(driven.drives[1].force, 1.6188410107853741, kTolerance * 14);
  ExpectPlanar(Held(arm, "tip", swing).hand, {1.2689173056660785, 30.502722220755334, 0}, "tip");
  ExpectPlanar(Held(arm, "handle", swing).hand,
               {-11.675464799920844, 23.029279727601317, -4.579991274279884}, "handle");
}

/// The four-bar held at the middle of its coupler while the crank turns at 5 rad/s and 2 rad/s^2,
/// cut between coupler and rocker. w_cut acts on the coupler.
struct Row {
  double crank_deg;
  Vector3d hand_point, cut_point;      // the hand's smallest wrench that moves the mechanism
  Vector3d hand_rigid, cut_rigid;      // the same with a moment of the hand
  Vector3d printed_hand, printed_cut;  // eq. (14) in one step as printed, with moments
  Vector3d tau;                        // of the opened chains: crank and crank pin, rocker [N m]
  Eigen::Vector4d printed_forces;      // eq. (14) with forces alone: hand, cut
};
const Row kRows[] = {
    {30,
     {-19.567786937914907, 26.968810633644654, 0},
     {40.500449059654294, 11.780750580623367, 0},
     {-13.323846856631988, 18.363257118869605, -15.531236050843027},
     {61.53347903881145, 36.13467010247086, 0},
     {-7.188284978825631, 17.382437075328966, 16.248245384992455},
     {9.17120587575879, 10.42648594172349, -17.119100602398373},
     {31.02674136795887, 19.480854699865574, 17.21359215583769},
     {-11.335013946541983, 32.9422719772617, 38.39849267116891, 9.346917853035636}},
    {75,
     {-9.91572936429899, 2.7411476691167813, 0},
     {3.96974105179879, 0.7485639909167628, 0},
     {-9.913580233672484, 2.7405535540304333, 0.15143904090391969},
     {3.9309627159035174, 0.6124560508992036, 0},
     {-4.765075222694605, 2.291003731878419, 1.8237290775057706},
     {-0.9116405862060052, 2.2036465926700886, -3.8199469482455837},
     {6.051101952046577, 2.7278081953516193, 2.7095267588044107},
     {-9.7226060108067, 3.4397451685255853, 3.8700416389560814, 0.3986293846554514}},
    {120,
     {6.061589802000292, 2.49205867334184, 0},
     {-2.9149791781996495, 0.29818001468966465, 0},
     {5.7553505531382125, 2.3661566903352376, -1.4354156365835447},
     {-3.2181897127947736, 1.479679987305994, 0},
     {3.237271188829728, 1.2456921337037787, -0.9352625427999494},
     {0.7803906700890969, 0.035841559107405115, 2.63562681573008},
     {-0.29727603527892466, 1.7628060047436291, -2.0620228375871736},
     {5.908402680021004, 2.8646652681706186, -2.8654182283039793, 0.10505921490358597}},
    {200,
     {-2.438035905919236, 14.81475227545657, 0},
     {-7.523467147183818, -6.456040026295415, 0},
     {-0.8812380947229597, 5.354853075510225, -7.21306314001596},
     {-15.702288467166733, 0.5936397258415548, 0},
     {-2.4139671766547606, 9.327115505542306, -6.625734737434909},
     {-5.6406543745508975, -0.2743551494176739, 4.433715766429878},
     {1.0981078063561043, 6.72893526724156, -7.3515988763558155},
     {-2.7349049691861658, 14.765897092315875, -7.475179628871367, -6.497661126306062}},
    {300,
     {29.361789164008712, 16.368825868303535, 0},
     {-8.850533722867098, -19.150930770044123, 0},
     {29.333920996544744, 16.353289717630346, -1.0351568942734533},
     {-9.359404023166118, -18.205736322828766, 0},
     {15.342558857261807, 3.7410688133838135, -9.090861203230336},
     {5.228768055701194, -6.6272205564044535, 13.750214659540873},
     {-3.6113480725417744, -11.79745598487684, -12.653441362964276},
     {31.845281165398262, 11.914030568873837, -10.07284659673125, -16.88056179693381}},
};

class FourBarInHand : public testing::TestWithParam<Row> {
 protected:
  FourBarInHand() {
    four_bar_.preferred_cuts = {FindJoint(four_bar_, "rocker_pin")};
    four_bar_ = LedTo(four_bar_, "main", turn_[0].state.position);
  }

  void ExpectWrenches(const char* grasp, ReactionRule rule, const Vector3d& hand,
                      const Vector3d& cut) const {
    const HeldLoads held = Held(four_bar_, grasp, turn_, rule);
    ExpectPlanar(held.hand, hand, grasp);
    ExpectPlanar(-OnSecond_W(four_bar_, held.loads, "rocker_pin"), cut, "cut");
  }

  const Row row_ = GetParam();
  const std::vector<Driven> turn_ = {{"main", {Degrees(row_.crank_deg), 5, 2}}};
  Mechanism four_bar_ = Example("four-bar");
};

TEST_P(FourBarInHand, SmallestWrenchAlongTheFreeMotionThenTheCut) {
  ExpectWrenches("midpoint", ReactionRule::kMinimumNorm, row_.hand_point, row_.cut_point);
  ExpectWrenches("handle", ReactionRule::kMinimumNorm, row_.hand_rigid, row_.cut_rigid);
}

TEST_P(FourBarInHand, Equation14AsPrintedLetsHandAndHingeShare) {
  ExpectWrenches("handle", ReactionRule::kPaperJoint, row_.printed_hand, row_.printed_cut);
}

TEST_P(FourBarInHand, Equation14WithForcesAloneIsTheSmallestOfItsSolutions) {
  const PoseLoads loads = LoadsAt(four_bar_, turn_);
  const auto across = [](double length, double angle) {
    return Eigen::Vector2d(-length * std::sin(angle), length * std::cos(angle));
  };
  const double crank = turn_[0].state.position;
  const double coupler = crank + Position(four_bar_, loads, "crank_pin");
  const double rocker = Position(four_bar_, loads, "rocker_pivot");
  MatrixXd J = MatrixXd::Zero(2, 3), C(2, 3);  // columns: crank, crank pin, rocker pivot
  J << across(0.5, crank) + across(0.6, coupler), across(0.6, coupler), Eigen::Vector2d::Zero();
  C << across(0.5, crank) + across(1.2, coupler), across(1.2, coupler), -across(0.75, rocker);
  const VectorXd forces = MinimumNormWrenches(J, C, row_.tau);
  EXPECT_LT((forces - row_.printed_forces).norm(), kTolerance * (1 + forces.norm()));
}

INSTANTIATE_TEST_SUITE_P(RoundTheTurn, FourBarInHand, testing::ValuesIn(kRows));

}  // namespace
}  // namespace vmech::reference::paper_cases_test
