#include "vmech/apps/report/load_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "vmech/apps/report/certainty_words.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/apps/report/joint_section.h"
#include "vmech/dynamics/bearings/catalogue.h"
#include "vmech/dynamics/loads/load_result.h"

namespace vmech {
namespace {

constexpr int kPoses = 73;
constexpr double kSpeed = 20;  // [rad/s]

/// A crank that turns once against a rotating load of 1000 N with its peak of 1500 N at 90 degrees:
/// numbers that can be looked for in the report.
struct Example {
  StudyFile file;
  StudyOutcome outcome;
  LoadStudy& study = file.study;
  LoadStudyResult& result = outcome.loads;
  std::shared_ptr<LoadArrays> loads;  ///< behind the result

  explicit Example(int poses = kPoses) {
    Mechanism& mechanism = study.mechanism;
    mechanism.name = "test crank";
    file.name = "test study";
    file.path = "somewhere/test.yaml";
    mechanism.links = {{"frame", {}, {{"main", {}}}}, {"crank", {}, {{"main", {}}}}};
    mechanism.joints = {MakeJoint("main", JointType::kRevolute, {0, 0}, {1, 0})};
    study.drives = {{0, 0, MotionLaw::Uniform(0, kSpeed)}};
    result.certainty.push_back({});
    result.mobility = 1;
    loads = std::make_shared<LoadArrays>(
        LoadArrays::Shape{.poses = static_cast<size_t>(poses), .drives = 1, .freedoms = {1}});
    for (int i = 0; i < poses; ++i) EnterPose(i, 2 * std::numbers::pi * i / (kPoses - 1));
    result.poses = PoseSeries(loads);
  }

  void EnterPose(size_t i, double angle) {
    loads->times[i] = angle / kSpeed;
    loads->drives[i] = {angle, kSpeed, 0};
    loads->drive_forces[i] = 12.5 * std::cos(angle);
    const double radial = 1000 + 500 * std::max(0.0, std::sin(angle));
    const double wrench[] = {radial * std::cos(angle), radial * std::sin(angle), 50, 0, 3, 0};
    std::copy_n(wrench, 6, &loads->wrenches[6 * i]);
    loads->positions[i] = angle;
    loads->rates[i] = kSpeed;
    loads->accelerations[i] = 0;
    loads->powers[i] = loads->drive_forces[i] * kSpeed;
    loads->power_errors[i] = 1e-14;
    study.times.push_back(loads->times[i]);
  }

  Example& WithBearings(LoadCertainty certainty = LoadCertainty::kCertain) {
    DutyCycle cycle;
    cycle.duration = DurationsFromTimes(study.times);
    for (const PoseLoads& pose : result.poses) {
      cycle.angle.push_back(pose.drives[0].position);
      cycle.speed.push_back(pose.drives[0].velocity);
      cycle.wrench.push_back(pose.joints[0]);
    }
    BearingRequest request{0, {{-0.015, 0.015}, 0}, {}};
    request.requirements.shaft_min = 0.015;
    request.requirements.shaft_max = 0.030;
    file.bearings = {request};
    outcome.bearings = {{0, SelectJointBearings(cycle, request.arrangement, request.requirements,
                                                certainty, BuiltInCatalogue())}};
    return *this;
  }

  /// As it is read: without the scene and the scripts, which are tested in a browser.
  std::string Render() const { return WithoutScripts(RenderLoadReport(file, outcome, "1.2.3")); }

  static std::string WithoutScripts(std::string page) {
    constexpr std::string_view kEnd = "</script>";
    for (const char* begin :
         {"<script type=\"application/json\" id=\"vmech-scene\">", "<script>//<![CDATA[\n"}) {
      for (size_t at = page.find(begin); at != std::string::npos; at = page.find(begin)) {
        page.erase(at, page.find(kEnd, at) + kEnd.size() - at);
      }
    }
    return page;
  }
};

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Every element that is opened is closed, in order; text holds no stray < or &.
void ExpectWellFormed(const std::string& page) {
  std::vector<std::string> open;
  for (size_t at = page.find("<html"); at < page.size(); at = page.find('<', at + 1)) {
    const size_t end = page.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = page.substr(at + 1, end - at - 1);
    const std::string name =
        tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" /", 1) - (tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(open.back(), tag.substr(1)) << page.substr(at, 80);
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty());
  for (size_t at = page.find('&'); at != std::string::npos; at = page.find('&', at + 1)) {
    EXPECT_LT(page.find(';', at), at + 8) << page.substr(at, 30);
  }
}

TEST(LoadReport, IsWellFormedAndNeedsNothingFromElsewhere) {
  std::string page = Example().WithBearings().Render();
  ExpectWellFormed(page);
  // The picture for paper is in the page.
  const std::string picture = "href=\"data:image/svg+xml;base64,";
  const size_t at = page.find(picture);
  ASSERT_NE(at, page.npos);
  page.erase(at, picture.size());
  for (const char* outside : {"src=", "href=", "url(", "@import", "<script"}) {
    EXPECT_FALSE(Contains(page, outside)) << outside;
  }
}

TEST(LoadReport, HeadlineNumbersAreThoseOfTheResult) {
  const std::string page = Example().Render();
  EXPECT_TRUE(Contains(page, "<h1>test study</h1>"));
  EXPECT_TRUE(Contains(
      page, "<strong>test crank</strong>. Joint main turns at 191 rpm; 73 poses over 0.314 s."));
  EXPECT_TRUE(Contains(page, "1501&#160;<small>N<"));  // |(1500, 50)|
  EXPECT_TRUE(Contains(page, "at joint main, 90°"));
  EXPECT_TRUE(Contains(page, "12.50&#160;<small>N m<"));
}

TEST(LoadReport, EveryJointHasItsPlots) {
  const std::string page = Example().Render();
  for (const char* text : {"Load over the cycle", "Polar load diagram", "Drive torque",
                           "Error of the power balance", "angle of main [°]"}) {
    EXPECT_TRUE(Contains(page, text)) << text;
  }
}

/// The cosine of the crank's angle, 0.1 m to both sides.
Example WithSlide() {
  Example example;
  example.study.mechanism.joints.push_back(
      MakeJoint("slide", JointType::kPrismatic, {0, 0}, {1, 0}));
  example.result.certainty.resize(2);
  example.study.cycle = 2 * std::numbers::pi / kSpeed;
  const auto both = std::make_shared<LoadArrays>(
      LoadArrays::Shape{.poses = kPoses, .drives = 1, .freedoms = {1, 1}});
  for (int i = 0; i < kPoses; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoses;
    both->times[i] = angle / kSpeed;
    both->drives[i] = {angle, kSpeed, 0};
    both->drive_forces[i] = both->powers[i] = both->power_errors[i] = 0;
    std::fill_n(&both->wrenches[12 * i], 12, 1.0);
    const double figures[][2] = {{angle, 0.1 * std::cos(angle)},
                                 {kSpeed, -0.1 * kSpeed * std::sin(angle)},
                                 {0, -0.1 * kSpeed * kSpeed * std::cos(angle)}};
    std::copy_n(figures[0], 2, &both->positions[2 * i]);
    std::copy_n(figures[1], 2, &both->rates[2 * i]);
    std::copy_n(figures[2], 2, &both->accelerations[2 * i]);
  }
  example.result.poses = PoseSeries(both);
  return example;
}

TEST(LoadReport, SaysHowFarAndHowFastJointsMove) {
  const std::string page = WithSlide().Render();
  ExpectWellFormed(page);
  EXPECT_TRUE(Contains(page,
                       "<td>slide</td><td class=\"number\">−100.0 mm</td>"
                       "<td class=\"number\">180.0°</td><td class=\"number\">100.0 mm</td>"
                       "<td class=\"number\">0.0°</td><td class=\"number\">200.0 mm</td>"));
  EXPECT_TRUE(Contains(page, "Dead centres: slide turns back at 0° and 180°."));
  EXPECT_TRUE(Contains(page, "Time ratio of slide: 1.000."));
  EXPECT_TRUE(Contains(page, "without plots: main."));
  for (const char* plot :
       {">Coordinate<", ">Rate<", ">Acceleration<", ">Load over the joint&#39;s own coordinate<"}) {
    EXPECT_TRUE(Contains(page, plot)) << plot;
  }
}

TEST(LoadReport, ShowsEveryInput) {
  Example example;
  example.study.mechanism.gravity_W = {0, 0, -9.81};
  example.study.mechanism.links[1].mass_properties = {
      1.25, {0.01, 0.02, 0.03}, Vector3d(1e-6, 2e-6, 3e-6).asDiagonal()};
  example.study.mechanism.joints[0].passive[0].viscous = 0.125;
  ExternalLoad load;
  load.link = 1;
  load.p_L = {0.5, 0, 0};
  load.at = {0};
  load.wrenches = {{{-300, 0, 0}, {0, 0, 4}}};
  example.study.external = {load};
  example.file.inputs = {{"somewhere/test.yaml", "0123abcd"}};
  const std::string page = Example::WithoutScripts(
      RenderLoadReport(example.WithBearings().file, example.outcome, "1.2.3", "2026-01-31"));
  ExpectWellFormed(page);
  for (const char* text :
       {"vmech 1.2.3 on 2026-01-31 (UTC)", "Gravity 0, 0, −9.81 m/s²", "<code>0123abcd</code>",
        ">1.25<", ">10, 20, 30<", ">1, 2, 3<", "viscous 0.125 N m s/rad", ">500, 0, 0<",
        "fx −300 N, mz 4 N m", ">−15, 15<"}) {
    EXPECT_TRUE(Contains(page, text)) << text;
  }
}

TEST(LoadReport, HostileNamesStayNames) {
  Example example;
  example.study.mechanism.name = "</p><script>alert(1)</script>";
  example.file.name = "</title><script>alert(2)</script>";
  example.file.description = "<script>alert(3)</script>";
  example.file.path = "<script>.yaml";
  example.study.mechanism.joints[0].name = "a\"b<c>&d'\x01";
  example.study.mechanism.links[0].name = "<img src=x>";
  example.result.warnings = {"<b>warning</b>"};
  const std::string page = example.WithBearings().Render();
  ExpectWellFormed(page);
  EXPECT_FALSE(Contains(page, "<script"));
  EXPECT_FALSE(Contains(page, "<img"));
  EXPECT_FALSE(Contains(page, "<b>"));
  EXPECT_FALSE(Contains(page, "\x01"));
}

TEST(LoadReport, NumbersThatAreNotFiniteAreShownAsDashes) {
  Example example;
  example.loads->wrenches[60] = std::numeric_limits<double>::quiet_NaN();
  example.loads->powers[11] = std::numeric_limits<double>::infinity();
  const std::string page = example.Render();
  ExpectWellFormed(page);
  for (const char* word : {"nan", "NaN", ">inf", "-inf"})
    EXPECT_FALSE(Contains(page, word)) << word;
}

TEST(LoadReport, BearingsStandWithTheirReasons) {
  Example example;
  const std::string page = example.WithBearings(LoadCertainty::kDependsOnRule).Render();
  const JointBearings& bearings = example.outcome.bearings[0].bearings;
  ASSERT_TRUE(bearings.complete());
  for (const BearingSelection& selection : bearings.selections) {
    EXPECT_TRUE(Contains(page, html::EscapeText(selection.message))) << selection.message;
    for (size_t i = 0; i < selection.candidates.size(); ++i) {
      EXPECT_TRUE(Contains(page, selection.candidates[i].bearing.designation));
      if (static_cast<int>(i) == selection.chosen) continue;
      const std::string reason = selection.ReasonAgainst(static_cast<int>(i));
      EXPECT_TRUE(Contains(page, html::EscapeText(reason))) << reason;
    }
  }
  EXPECT_TRUE(Contains(page, "hold for the rule <code>stiffness</code>"));
}

TEST(LoadReport, SaysThatNoBearingFits) {
  Example example;
  for (int i = 0; i < kPoses; ++i) {
    for (int k = 0; k < 3; ++k) example.loads->wrenches[6 * i + k] *= 1000;
  }
  const std::string page = example.WithBearings().Render();
  EXPECT_TRUE(Contains(page, "no bearing of the catalogue fits"));
}

TEST(LoadReport, SameInputGivesSameBytes) {
  EXPECT_EQ(Example().WithBearings().Render(), Example().WithBearings().Render());
}

TEST(LoadReport, ResultsOfAnotherMechanismAreRefused) {
  Example example;
  example.study.mechanism.joints.push_back(example.study.mechanism.joints[0]);
  EXPECT_THROW(example.Render(), std::invalid_argument);
  Example without_poses;
  without_poses.result.poses = PoseSeries();
  EXPECT_THROW(without_poses.Render(), std::invalid_argument);
  Example without_bearings;
  without_bearings.WithBearings().outcome.bearings.clear();
  EXPECT_THROW(without_bearings.Render(), std::invalid_argument);
}

TEST(LoadReport, ASinglePoseIsEnough) {
  const Example example(1);
  ExpectWellFormed(example.Render());
}

constexpr Certainty kYes = Certainty::kCertain;
constexpr Certainty kNo = Certainty::kNotDetermined;

TEST(CertaintyWords, NameTheComponentsOfAPlanarFourBarInSpace) {
  const JointCertainty planar = {kYes, kYes, kNo, kNo, kNo, kYes};
  EXPECT_EQ(ComponentsInWords(JointType::kRevolute, planar, kNo),
            "the axial force and the two tilting moments");
  EXPECT_EQ(ComponentsInWords(JointType::kRevolute, planar, Certainty::kSingular), "");
}

TEST(CertaintyWords, NameComponentsOneByOneWhereTheyDiffer) {
  EXPECT_EQ(ComponentsInWords(JointType::kPrismatic, {kNo, kYes, kYes, kYes, kNo, kNo}, kNo),
            "the force along x, the moment about y and the moment about z");
}

TEST(CertaintyWords, JointsOfEqualVerdictShareASentence) {
  Example example;
  example.study.mechanism.joints.push_back(example.study.mechanism.joints[0]);
  example.study.mechanism.joints[1].name = "pin";
  example.result.certainty = {{kYes, kYes, kNo}, {kYes, kYes, kNo}};
  example.result.redundant_equations = 1;
  const std::string section = CertaintySection(example.study, example.result).html();
  EXPECT_TRUE(Contains(section,
                       "<strong>main and pin</strong>: the axial force cannot be known "
                       "from statics; the figures shown follow the rule "
                       "<code>stiffness</code>"));
}

TEST(CertaintyWords, WhereAllIsCertainNoRuleIsNamed) {
  const Example example;
  EXPECT_FALSE(
      Contains(CertaintySection(example.study, example.result).html(), "stiffness</code>"));
}

TEST(Cycle, RunsOverTimeWhereTheDriveTurnsBack) {
  Example example;
  EXPECT_EQ(CycleOf(example.study, example.result).axis.unit, "°");
  example.loads->drives[5].position = 0;
  EXPECT_EQ(CycleOf(example.study, example.result).axis.unit, "s");
}

/// The example, its motor from one angle to another [deg].
Example Turned(double from, double to) {
  Example example;
  for (int i = 0; i < kPoses; ++i) {
    const double degrees = from + (to - from) * i / (kPoses - 1);
    example.loads->drives[i].position = degrees * std::numbers::pi / 180;
  }
  return example;
}

TEST(Cycle, CountsAnglesWithinTheirTurn) {
  const Example forward = Turned(3630, 4350), backward = Turned(-10, -370);
  const Cycle ahead = CycleOf(forward.study, forward.result);
  EXPECT_EQ(ahead.At(0), "30°");
  EXPECT_EQ(ahead.At(33), "0°");
  EXPECT_EQ(ahead.At(40), "70°, turn 2");
  EXPECT_NEAR(ahead.values.front(), 30, 1e-9);
  const Cycle back = CycleOf(backward.study, backward.result);
  EXPECT_EQ(back.At(0), "350°");
  EXPECT_EQ(back.At(36), "170°");
}

TEST(Cycle, LeavesALeverAsItIs) {
  const Example lever = Turned(-30, 42);
  EXPECT_EQ(CycleOf(lever.study, lever.result).At(0), "−30°");
}

TEST(Cycle, MarksTheDeadCentresOfWhatStandsOnTheGround) {
  Example example = Turned(-60, 300);
  example.study.mechanism.joints.push_back(
      MakeJoint("guide", JointType::kPrismatic, {0, 0}, {1, 0}));
  example.result.certainty.resize(2);
  const auto both = std::make_shared<LoadArrays>(
      LoadArrays::Shape{.poses = kPoses, .drives = 1, .freedoms = {1, 1}});
  both->drives = example.loads->drives;
  both->drive_forces = example.loads->drive_forces;
  for (int i = 0; i < kPoses; ++i) {
    for (int j = 0; j < 2; ++j) {
      std::copy_n(&example.loads->wrenches[6 * i], 6, &both->wrenches[6 * (2 * i + j)]);
    }
    std::fill_n(&both->accelerations[2 * i], 2, 0.0);
    both->rates[2 * i] = kSpeed;
    both->rates[2 * i + 1] = kSpeed * std::sin(both->drives[i].position - 0.3);
  }
  example.result.poses = PoseSeries(both);
  const std::string words = DescribeDeadCentres(example.study, example.result);
  EXPECT_EQ(words, "guide turns back at 17.19° and 197.2°");  // 0.3 rad, and pi more
  const Cycle cycle = CycleOf(example.study, example.result);
  ASSERT_EQ(cycle.dead_centres.size(), 2u);
  EXPECT_NEAR(cycle.dead_centres[0].x - cycle.values.front(), 60 + 17.19, 0.01);
}

TEST(Cycle, MarksTheQuartersOfATurn) {
  const Example example;
  const Cycle cycle = CycleOf(example.study, example.result);
  ASSERT_EQ(cycle.marks.size(), 4u);
  EXPECT_EQ(cycle.marks[1].label, "90°");
  EXPECT_EQ(cycle.marks[1].index, 18u);
}

TEST(JointPeaks, StandWhereTheLoadIsLargest) {
  const Example example;
  const JointPeaks peaks = PeaksOf(example.result, 0);
  constexpr double kRounding = 1e-9;
  EXPECT_NEAR(peaks.radial, 1500, kRounding);
  EXPECT_EQ(peaks.radial_pose, 18u);
  EXPECT_EQ(peaks.axial, 50);
  EXPECT_EQ(peaks.tilting, 3);
}

}  // namespace
}  // namespace vmech
