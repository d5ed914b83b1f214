#include "vmech/studies/study_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <ostream>

#include "support/temp_folder.h"
#include "vmech/studies/sha256.h"

namespace vmech {
namespace {

constexpr double kRounding = 1e-15;  // relative; a few roundings of the conversion
constexpr double kTurn = 2 * std::numbers::pi;

const std::string kStudy = R"(vmech_study: "1.0"
mechanism: slider-crank.yaml
units: {length: mm, angle: deg}
motion: {joint: main, rpm: 1500, turns: 2, steps: 720}
external:
  - {link: slider, at: [10, 0, 0], force: [-200, 0, 0], moment: [0, 0, 1], axes: world}
  - {link: coupler, table: gas.csv, axes: link}
rule: minimum_norm
bearings:
  main: {positions: [-15, 15], locating: 1, shaft: [15, 30], housing: 60, life_hours: 5000,
         reliability: 95, static_safety: 1.5, lubrication: oil}
)";

std::string Replaced(std::string text, const std::string& passage, const std::string& replacement) {
  const size_t at = text.find(passage);
  if (at == text.npos) throw std::logic_error("the passage is not in the text: " + passage);
  return text.replace(at, passage.size(), replacement);
}

/// Studies of the shipped slider-crank, with tables of their own beside it.
class StudyReader : public testing::Test {
 protected:
  StudyReader() {
    std::filesystem::copy_file(std::filesystem::path(VMECH_EXAMPLES) / "slider-crank.yaml",
                               folder_ / "slider-crank.yaml",
                               std::filesystem::copy_options::overwrite_existing);
    Write("gas.csv", "main,fx\n0,-100\n180,-50\n360,-100\n");
  }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  StudyFile Parse(const std::string& text) const {
    return ParseStudy(text, folder_ / "study.yaml");
  }
  StudyFile WithMotion(const std::string& motion) const {
    return Parse(
        "vmech_study: \"1.0\"\nmechanism: slider-crank.yaml\n"
        "units: {length: mm, angle: deg}\nmotion: " +
        motion);
  }
  /// Everything that is said of a study, without the folder.
  std::string Refusal(const std::string& text) const {
    try {
      Parse(text);
    } catch (const FileErrors& errors) {
      std::string what = errors.what();
      const std::string folder = folder_.path().string() + "/";
      for (size_t at; (at = what.find(folder)) != what.npos;) what.erase(at, folder.size());
      return what;
    }
    return "";
  }

  TempFolder folder_;
};

TEST(Sha256, OfTheExamplesOfTheStandard) {
  // FIPS 180-4, and the lengths around the end of a block
  EXPECT_EQ(Sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(StudyReader, SaysOnceWhatIsWrongWithItsUnits) {
  const std::string told = Refusal(Replaced(kStudy, "length: mm", "length: furlong"));
  const size_t first = told.find("'furlong' is not a known unit of length");
  ASSERT_NE(first, told.npos) << told;
  EXPECT_EQ(told.find("furlong", first + 10), told.npos) << told;
}

TEST_F(StudyReader, RemembersTheFilesThatWereReadEachOnce) {
  const StudyFile study =
      Parse(Replaced(kStudy, "rule:", "  - {link: slider, table: gas.csv}\nrule:"));
  ASSERT_EQ(study.inputs.size(), 3u);
  EXPECT_EQ(study.inputs[0].path.filename(), "study.yaml");
  EXPECT_EQ(study.inputs[1].path.filename(), "slider-crank.yaml");
  EXPECT_EQ(study.inputs[2].path.filename(), "gas.csv");
  EXPECT_EQ(study.inputs[2].sha256, Sha256("main,fx\n0,-100\n180,-50\n360,-100\n"));
}

TEST_F(StudyReader, ReadsTheMotionOfAMotor) {
  const LoadStudy loads = Parse(kStudy).study;
  ASSERT_EQ(loads.drives.size(), 1u);
  EXPECT_EQ(loads.mechanism.joints[loads.drives[0].joint].name, "main");
  const MotionSample start = loads.drives[0].law.At(0);
  EXPECT_NEAR(start.position, 40 * kTurn / 360, kRounding);
  EXPECT_NEAR(start.velocity, 25 * kTurn, 25 * kTurn * kRounding);
  ASSERT_EQ(loads.times.size(), 720u);  // the pose after the last is the first of the next cycle
  EXPECT_NEAR(loads.times[719], 0.08 * 719 / 720, kRounding);
  EXPECT_NEAR(loads.cycle, 0.08, kRounding);
}

TEST_F(StudyReader, ReadsWhatActsFromOutside) {
  const LoadStudy loads = Parse(kStudy).study;
  ASSERT_EQ(loads.external.size(), 2u);
  const ExternalLoad &push = loads.external[0], &gas = loads.external[1];
  EXPECT_EQ(push.link, FindLink(loads.mechanism, "slider"));
  EXPECT_NEAR(push.p_L.x(), 0.01, kRounding);
  EXPECT_EQ(push.wrenches[0].force.x(), -200);
  EXPECT_EQ(push.wrenches[0].moment.z(), 1);
  EXPECT_EQ(gas.over, ExternalLoad::Over::kDriveCoordinate);
  EXPECT_EQ(gas.axes, ExternalLoad::Axes::kLink);
  EXPECT_NEAR(gas.at[1], kTurn / 2, kRounding * kTurn);
  EXPECT_EQ(gas.wrenches[1].force.x(), -50);
  EXPECT_NEAR(gas.period, kTurn, kRounding * kTurn);  // it fills one turn
}

TEST_F(StudyReader, ReadsTheBearingsAskedFor) {
  const StudyFile study = Parse(kStudy);
  EXPECT_EQ(study.study.rule, ReactionRule::kMinimumNorm);
  ASSERT_EQ(study.bearings.size(), 1u);
  const BearingRequest& main = study.bearings[0];
  EXPECT_EQ(main.joint, FindJoint(study.study.mechanism, "main"));
  EXPECT_NEAR(main.arrangement.positions[1], 0.015, kRounding);
  EXPECT_EQ(main.arrangement.locating, 1);
  EXPECT_NEAR(main.requirements.shaft_max, 0.03, kRounding);
  EXPECT_NEAR(main.requirements.housing_max, 0.06, kRounding);
  EXPECT_EQ(main.requirements.life_hours, 5000);
  EXPECT_EQ(main.requirements.reliability, 95);
  EXPECT_EQ(main.requirements.lubrication, Lubrication::kOil);
}

TEST_F(StudyReader, KeepsTheWordsOfTheStudy) {
  const StudyFile study = Parse(kStudy + "description: trial\n");
  EXPECT_EQ(study.name, "study");
  EXPECT_EQ(study.description, "trial");
  EXPECT_EQ(study.motion, "main at 1500 rpm, 2 turns");
  EXPECT_EQ(study.mechanism_path.filename(), "slider-crank.yaml");
  EXPECT_FALSE(study.catalogue.empty());
}

TEST_F(StudyReader, EndsAPassageWithAPose) {
  const LoadStudy loads = WithMotion("{joint: main, speed: -90, duration: 2, steps: 4}").study;
  EXPECT_EQ(loads.times, (std::vector<double>{0, 0.5, 1, 1.5, 2}));
  EXPECT_EQ(loads.cycle, 0);
  EXPECT_NEAR(loads.drives[0].law.At(0).velocity, -kTurn / 4, kRounding * kTurn);
}

TEST_F(StudyReader, TakesThePosesOfATable) {
  Write("move.csv", "t,value\n0,0\n1,90\n2,0\n");
  const LoadStudy rows = WithMotion("{joint: main, table: move.csv}").study;
  EXPECT_EQ(rows.times, (std::vector<double>{0, 1, 2}));
  EXPECT_NEAR(rows.drives[0].law.At(1).position, kTurn / 4, kRounding * kTurn);
  const LoadStudy steps = WithMotion("{joint: main, table: move.csv, steps: 4}").study;
  EXPECT_EQ(steps.times, (std::vector<double>{0, 0.5, 1, 1.5, 2}));
  const LoadStudy cycle = WithMotion("{joint: main, table: move.csv, repeats: true}").study;
  EXPECT_EQ(cycle.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(cycle.cycle, 2);
}

// The curve of a table that repeats has no ends: half a turn of 0, 90, 0 deg in 2 s, with the
// curvatures +-540 deg/s^2 that make both pieces meet again.
TEST_F(StudyReader, MakesASmoothCycleOfATable) {
  Write("move.csv", "t,value\n0,0\n1,90\n2,0\n");
  const LoadStudy study = WithMotion("{joint: main, table: move.csv, repeats: true}").study;
  const MotionLaw& law = study.drives[0].law;
  EXPECT_NEAR(law.At(0).velocity, 0, kRounding * kTurn);
  EXPECT_NEAR(law.At(0).acceleration, 1.5 * kTurn, 1e-12 * kTurn);
  EXPECT_NEAR(law.At(1).acceleration, -1.5 * kTurn, 1e-12 * kTurn);
  Write("hand.csv",
        "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,90,0,0,0.8,0,0,0.6\n3,10,5,0,0.6,0,0,0.8\n"
        "4,0,0,0,1,0,0,0\n");
  const HandLaw hand =
      WithMotion("{grasp: handle, table: hand.csv, repeats: true}").study.hand->law;
  EXPECT_NEAR((hand.At(0).V_WH - hand.At(4).V_WH).norm(), 0, 1e-13);
  EXPECT_NEAR((hand.At(0).A_WH - hand.At(4).A_WH).norm(), 0, 1e-13);
}

// A second drive goes round with the first if its table fills the cycle.
TEST_F(StudyReader, MakesASmoothCycleOfTheTablesOfAllDrives) {
  Write("move.csv", "t,value\n0,0\n1,90\n2,0\n");
  Write("lift.csv", "t,value\n0,5\n0.5,7\n1.5,1\n2,5\n");
  const LoadStudy study = WithMotion(
                              "[{joint: main, table: move.csv, repeats: true}, "
                              "{joint: guide, table: lift.csv}]")
                              .study;
  const MotionLaw& law = study.drives[1].law;
  EXPECT_NEAR(law.At(0).velocity, law.At(2).velocity, 1e-15);
  EXPECT_NEAR(law.At(0).acceleration, law.At(2).acceleration, 1e-15);
}

TEST_F(StudyReader, ReadsTheMotionOfAHand) {
  Write("hand.csv", "t,x,y,z,qw,qx,qy,qz\n0,100,0,0,1,0,0,0\n1,200,0,0,0.8,0,0,0.6\n");
  const LoadStudy loads = WithMotion("{grasp: handle, table: hand.csv}").study;
  ASSERT_TRUE(loads.hand.has_value());
  const HandSample end = loads.hand->law.At(1);
  EXPECT_NEAR(end.X_WH.p.x(), 0.2, kRounding);
  EXPECT_NEAR(end.X_WH.R(1, 0), 2 * 0.8 * 0.6, 10 * kRounding);  // the sine of its angle
}

TEST_F(StudyReader, ReadsEveryExample) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(VMECH_EXAMPLES)) {
    const std::string text = file.path().extension() == ".yaml" ? ReadTextFile(file.path()) : "";
    if (text.find("\nvmech_study: ") == text.npos) continue;
    EXPECT_NO_THROW(ReadStudy(file.path())) << file.path();
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST_F(StudyReader, ReportsTheErrorsOfTheMechanismAsThoseOfItsFile) {
  Write("broken.yaml", "vmech: \"1.0\"\ncolour: red\n");
  const std::string what = Refusal(Replaced(kStudy, "slider-crank.yaml", "broken.yaml"));
  EXPECT_NE(what.find("broken.yaml:2:1: colour: unknown key"), std::string::npos) << what;
  EXPECT_NE(Refusal(Replaced(kStudy, "slider-crank.yaml", "absent.yaml")).find("cannot be opened"),
            std::string::npos);
}

TEST_F(StudyReader, ReportsTheErrorsOfATableAsThoseOfItsFile) {
  Write("gas.csv", "main,fx\n0,-100\n180,none\n");
  EXPECT_EQ(Refusal(kStudy), "gas.csv:3:5: fx: expected a finite number, not 'none'");
  Write("gas.csv", "crank,fx\n0,-100\n");
  EXPECT_EQ(Refusal(kStudy),
            "gas.csv:1:1: the first column must be 't' or the driven joint 'main', not 'crank'");
  Write("gas.csv", "main,fw\n0,-100\n");
  EXPECT_NE(Refusal(kStudy).find("unknown column 'fw'"), std::string::npos);
  Write("gas.csv", "main,fx\n0,-100\n180,-50\n360,-99\n");
  EXPECT_EQ(Refusal(kStudy), "gas.csv:4:1: one period after the first row, but with other values");
}

struct Malformed {
  std::string passage, replacement, message;
};

TEST_F(StudyReader, RefusesWhatIsMalformed) {
  const Malformed cases[] = {
      {"\"1.0\"", "\"2.0\"", ":1:14: vmech_study: this is format '2.0'"},
      {"vmech_study", "vmech", "the key 'vmech_study' is missing"},
      {"motion:", "motoin:", "did you mean 'motion'?"},
      {"joint: main", "joint: mian", "joint 'mian' not found; did you mean 'main'?"},
      {"joint: main, ", "", "the key 'joint' is missing"},
      {"rpm: 1500, ", "", "a drive needs one of 'rpm', 'speed' and 'table'"},
      {"rpm: 1500", "rpm: 1500, speed: 3", "give either 'rpm' or 'speed'"},
      {"rpm: 1500", "rpm: 0", "a drive that stands still makes no turns"},
      {"rpm: 1500", "rpm: fast", "expected a number, not 'fast'"},
      {"turns: 2", "turns: 2, duration: 1", "give either 'turns' or 'duration'"},
      {"turns: 2", "turns: -2", "must be greater than zero"},
      {"steps: 720", "steps: 0", "a whole number from 1"},
      {"steps: 720", "steps: 7.5", "a whole number from 1"},
      {", steps: 720", "", "the key 'steps' is missing"},
      {"steps: 720", "steps: 720, repeats: true", "used with a table only"},
      {"joint: main, rpm: 1500", "joint: guide, rpm: 1500", "this freedom is a translation"},
      {"joint: main", "joint: main, freedom: z", "no freedom 'z': a revolute joint has rz"},
      {"joint: main", "joint: main, freedom: 1", "freedoms have names: a revolute joint has rz"},
      {"link: slider", "link: slidr", "did you mean 'slider'?"},
      {"force: [-200, 0, 0]", "force: [-200, 0]", "a list of 3 numbers, not a list of 2"},
      {"force: [-200, 0, 0], moment: [0, 0, 1], ", "", "give 'force', 'moment' or 'table'"},
      {"axes: world", "axes: ground", "'ground' is not one of: world, link"},
      {"table: gas.csv", "table: gas.csv, force: [1, 0, 0]", "give either this or a table"},
      {"table: gas.csv", "table: gsa.csv", "gsa.csv: cannot be opened as a file"},
      {"table: gas.csv", "table: gas.csv, period: 90", "beyond one period of the table"},
      {"rule: minimum_norm", "rule: minimal_norm", "did you mean 'minimum_norm'?"},
      {"  main: {positions", "  mian: {positions", "joint 'mian' not found"},
      {"  main: {positions", "  guide: {positions", "a prismatic joint has no axis"},
      {"[-15, 15]", "[-15, 0, 15]", "3 positions"},
      {"[-15, 15]", "[]", "a joint has one or two bearings"},
      {"[-15, 15], locating: 1", "[0], pair_life_hours: 5000", "there is one bearing"},
      {"shaft: [15, 30]", "shaft: 15", "a list of 2 numbers"},
      {"shaft: [15, 30]", "shaft: [30, 15]", "shaft"},
      {"reliability: 95", "reliability: 50", "reliability"},
      {"lubrication: oil", "lubrication: water", "'water' is not one of: grease, oil"},
      {"locating: 1", "locating: 2", "a whole number from 0 to 1"},
  };
  for (const Malformed& malformed : cases) {
    const std::string what = Refusal(Replaced(kStudy, malformed.passage, malformed.replacement));
    EXPECT_NE(what.find(malformed.message), std::string::npos) << malformed.replacement << "\n"
                                                               << what;
  }
}

TEST_F(StudyReader, RefusesTablesOfMotionThatDoNotFit) {
  Write("open.csv", "t,value\n0,0\n1,90\n");
  EXPECT_THROW(WithMotion("{joint: main, table: open.csv, repeats: true}"), FileErrors);
  EXPECT_THROW(WithMotion("{joint: main, table: open.csv, turns: 1}"), FileErrors);
  EXPECT_THROW(WithMotion("{grasp: handle, table: open.csv}"), FileErrors);
  EXPECT_THROW(WithMotion("[]"), FileErrors);
  Write("hand.csv", "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,1\n");
  EXPECT_THROW(WithMotion("{grasp: handle, table: hand.csv}"), FileErrors);
}

}  // namespace
}  // namespace vmech
