#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "slider_crank.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech::malformed_test {
namespace {

/// The slider-crank with one passage replaced, and what must be said about it: the line of the
/// text, and a part of the message that names the place and the remedy.
struct Malformed {
  std::string subject;
  std::string passage, replacement;
  int line;
  std::string message;
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
  *out << malformed.subject;
}

std::string Replaced(std::string text, const std::string& passage, const std::string& replacement) {
  const size_t at = text.find(passage);
  if (at == text.npos) throw std::logic_error("the passage is not in the text: " + passage);
  return text.replace(at, passage.size(), replacement);
}

std::vector<FileError> ErrorsOf(const std::string& text) {
  try {
    ParseMechanism(text, "test.yaml");
  } catch (const FileErrors& errors) {
    return errors.errors();
  }
  return {};
}

class MalformedFile : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedFile, IsRefusedWithPlaceAndRemedy) {
  const Malformed& malformed = GetParam();
  const std::string text = Replaced(kSliderCrank, malformed.passage, malformed.replacement);
  const std::vector<FileError> errors = ErrorsOf(text);
  ASSERT_FALSE(errors.empty()) << "accepted";
  EXPECT_EQ(errors[0].line, malformed.line) << ToString(errors[0]);
  EXPECT_NE(ToString(errors[0]).find(malformed.message), std::string::npos) << ToString(errors[0]);
  EXPECT_EQ(errors.size(), 1u) << ToString(errors[1]);
}

const Malformed kSyntax[] = {
    {"ListNotClosed", "gravity: [0, -9.81, 0]", "gravity: [0, -9.81, 0", 5, "end of sequence"},
    {"MapNotClosed", "angle: deg}", "angle: deg", 4, "end of map"},
    {"TabAsIndentation", "    mass: 0.4", "\tmass: 0.4", 12, ""},
    {"NulByte", "slider-crank", std::string("slider\0crank", 12), 2, "control character 0x00"},
    {"InvalidUtf8", "slider-crank", "slider\xFF", 2, "not UTF-8"},
    {"OverlongUtf8", "slider-crank", "slider\xC0\xAF", 2, "not UTF-8"},
    {"Alias", "gravity: [0, -9.81, 0]", "gravity: *g", 4, ""},
    {"Anchor", "gravity: [", "gravity: &g [", 4, "anchors (&) and aliases (*) are not used"},
    {"Tag", "gravity: [", "gravity: !!seq [", 4, "tags (!) are not used"},
    {"SecondDocument", "cuts: [wrist]", "---\nmore: 1", 38, "a second document"},
    {"KeyThatIsAList", "cuts: [wrist]", "? [a]\n: 1", 38, "a key must be a word"},
    {"DuplicateKey", "    mass: 0.4", "    mass: 0.4\n    mass: 0.5", 13,
     "links.crank.mass: this key is already given in line 12"},
    {"DuplicateJoint", "  crank: {type", "  main: {type", 32,
     "joints.main: this key is already given in line 31"},
};

const Malformed kKeysAndKinds[] = {
    {"NoVersion", "vmech: \"1.0\"", "x-vmech: 1", 1, "the key 'vmech' is missing"},
    {"VersionAsNumber", "\"1.0\"", "1.0", 1, "write it in quotes: \"1.0\""},
    {"UnknownVersion", "\"1.0\"", "\"7.3\"", 1, "this is format '7.3'; only 1.0 can be read"},
    {"NoGravity", "gravity: [0, -9.81, 0]", "x-gravity: [0, -9.81, 0]", 1, "'gravity' is missing"},
    {"UnknownKey", "    center_of_gravity", "    center_of_gravty", 13,
     "did you mean 'center_of_gravity'?"},
    {"UnknownKeyFarFromAll", "cuts:", "colour:", 38, "unknown key 'colour'; known here: vmech,"},
    {"UnknownKeyOfAJoint", "viscous: 0.01", "viscuos: 0.01", 32, "did you mean 'viscous'?"},
    {"TextForNumber", "mass: 0.4", "mass: heavy", 12, "expected a number, not 'heavy'"},
    {"QuotedNumber", "mass: 0.4", "mass: \"0.4\"", 12, "expected a number, not text '0.4'"},
    {"NothingForNumber", "mass: 0.4", "mass:", 12, "expected a number, not nothing"},
    {"NotANumber", "mass: 0.4", "mass: .nan", 12, "expected a finite number, not '.nan'"},
    {"Infinite", "-9.81", "-.inf", 4, "gravity[1]: expected a finite number, not '-.inf'"},
    {"Overflow", "mass: 0.4", "mass: 1e400", 12, "'1e400' is beyond the range"},
    {"NumberWithUnit", "start: 40", "start: 40deg", 31, "expected a number"},
    {"DecimalComma", "-9.81", "-9,81", 4, "expected a list of 3 numbers, not a list of 4"},
    {"NumberForVector", "[25, 0, 0]", "25", 13, "expected a list of 3 numbers, not the number 25"},
    {"MapForList", "cuts: [wrist]", "cuts: {wrist: 1}", 38, "expected a list, not a map"},
    {"ListForMap", "grasps:\n  handle: ", "grasps:\n  - ", 37, "expected a map, not a list of 1"},
    {"UnknownLengthUnit", "length: mm", "length: furlong", 3,
     "units.length: 'furlong' is not a known unit of length; an example is 'mm'"},
    {"UnitOfAnotherKind", "angle: deg", "angle: kg", 3, "'kg' is not a unit of angle"},
    {"UnknownUnitKey", "angle: deg", "angel: deg", 3, "did you mean 'angle'?"},
};

const Malformed kLinks[] = {
    {"NegativeMass", "mass: 0.4", "mass: -0.4", 12, "links.crank.mass: must not be negative"},
    {"MasslessWithInertia", "    mass: 0.4", "    mass: 0", 14,
     "a link without mass has no inertia"},
    {"NegativeInertia", "xx: 10, yy: 100", "xx: -10, yy: 100", 14, "not positive definite"},
    {"TriangleInequality", "zz: 110", "zz: 120", 14, "exceeds the sum of the two others"},
    {"OriginForCenterOfGravity", "about: center_of_gravity, xx: 10, yy: 100",
     "about: origin, xx: 10, yy: 100", 14, "not positive definite"},
    {"MissingMoment", "yy: 100, zz: 110", "zz: 110", 14, "'yy' (or 'principal') is missing"},
    {"UnknownPoint", "about: center_of_gravity", "about: center_of_mass", 14,
     "'center_of_mass' is not one of: center_of_gravity, origin"},
    {"PrincipalBesideElements", "xx: 10, yy: 100, zz: 110", "principal: [10, 100, 110], xx: 10", 14,
     "links.crank.inertia.xx: not used beside 'principal'"},
    {"AxesWithoutPrincipal", "zz: 110}", "zz: 110, axes: {z: [0, 0, 1], x: [1, 0, 0]}}", 14,
     "used with 'principal' only"},
    {"AxisWithoutLength", "pin:  {origin: [50, 0, 0], z: [0, 0, 1]",
     "pin:  {origin: [50, 0, 0], z: [0, 0, 0]", 17,
     "links.crank.anchors.pin.z: the z axis has no length"},
    {"ParallelAxes", "pin:  {origin: [50, 0, 0], z: [0, 0, 1]",
     "pin:  {origin: [50, 0, 0], z: [2, 0, 0]", 17, "the x axis is parallel to the z axis"},
    {"LeftHandedAxes", "pin:  {origin: [50, 0, 0],", "pin:  {origin: [50, 0, 0], y: [0, -1, 0],",
     17, "the axes are left-handed"},
    {"ObliqueAxes", "pin:  {origin: [50, 0, 0],", "pin:  {origin: [50, 0, 0], y: [1, 1, 0],", 17,
     "not at right angles"},
    {"HalfTheAxes", "pin:  {origin: [50, 0, 0], z: [0, 0, 1],", "pin:  {origin: [50, 0, 0],", 17,
     "axes need both 'z' and 'x'"},
    {"SlashInName", "\n  coupler:", "\n  spare: {anchors: {a/b: {}}}\n  coupler:", 18,
     "a name has no '/'"},
    {"NoAnchors", "\n  coupler:", "\n  spare: {mass: 1}\n  coupler:", 18,
     "the key 'anchors' is missing"},
    {"LinkByItself", "\n  coupler:", "\n  spare: {mass: 1, anchors: {a: {}}}\n  coupler:", 18,
     "links.spare: no chain of joints leads from this link to the ground"},
};

const Malformed kJoints[] = {
    {"AbsentAnchor", "[crank/pin, coupler/crank]", "[cranc/pin, coupler/crank]", 32,
     "joints.crank.connects[0]: anchor 'cranc/pin' not found; did you mean 'crank/pin'?"},
    {"AbsentAnchorFarFromAll", "[crank/pin, coupler/crank]", "[crank/pin, bed]", 32,
     "anchor 'bed' not found"},
    {"OneEndOnly", "[crank/pin, coupler/crank]", "[crank/pin]", 32, "expected two anchors"},
    {"LinkWithItself", "[crank/pin, coupler/crank]", "[coupler/slider, coupler/crank]", 32,
     "the joint connects a link with itself"},
    {"UnknownType", "type: prismatic", "type: prismatik", 34, "did you mean 'prismatic'?"},
    {"NoType", "type: prismatic, ", "", 34, "the key 'type' is missing"},
    {"TooManyStartValues", "start: 40", "start: [40, 3]", 31, "expected a number, not a list of 2"},
    {"TooFewStartValues",
     "revolute, connects: [crank/pin, coupler/crank], start: -49, viscous: 0.01",
     "cylindrical, connects: [crank/pin, coupler/crank], start: -49", 32, "a list of 2 numbers"},
    {"UnknownFreedom", "start: 40", "start: {z: 40}", 31,
     "no freedom 'z': a revolute joint has rz"},
    {"StartBeyondLimit", "start: 40", "start: 4000", 31, "outside the limits"},
    {"LimitsTheWrongWayRound", "[-720, 720]", "[720, -720]", 31, "is not below the upper one"},
    {"OneLimit", "[-720, 720]", "[720]", 31, "expected a pair [lower, upper]"},
    {"NegativeFriction", "viscous: 0.01", "viscous: -0.01", 32, "must not be negative"},
    {"FrictionWithoutRadius", "viscous: 0.01", "friction: {coefficient: 0.1}", 32,
     "the key 'radius' is missing"},
    {"RadiusOfASlide", "spring: {stiffness: 800, rest: 200}",
     "friction: {coefficient: 0.1, radius: 3}", 35, "this joint does not rotate"},
    {"WidthOfAPin", "viscous: 0.01", "friction: {coefficient: 0.1, radius: 3, width: 4}", 32,
     "only a slide has faces"},
    {"ThrustOfASlide", "spring: {stiffness: 800, rest: 200}",
     "friction: {coefficient: 0.1, thrust_radius: 3}", 35, "no collars that take a thrust"},
    {"NegativeLengthOfASlide", "spring: {stiffness: 800, rest: 200}",
     "friction: {coefficient: 0.1, length: -3}", 35, "must be greater than zero"},
    {"SpringWithoutStiffness", "spring: {stiffness: 800, rest: 200}", "spring: {rest: 200}", 35,
     "the key 'stiffness' is missing"},
    {"FiveStiffnesses", "[1e8, 1e8, 0, 1e4, 1e4, 1e4]", "[1e8, 1e8, 0, 1e4, 1e4]", 35,
     "a list of 6 numbers, not a list of 5"},
    {"SoftWhereItMustHold", "[1e8, 1e8, 0, 1e4, 1e4, 1e4]", "[0, 1e8, 0, 1e4, 1e4, 1e4]", 35,
     "number 1 must be greater than zero"},
    {"ScrewWithoutPitch", "type: prismatic", "type: screw", 34, "the key 'pitch' is missing"},
    {"ScrewOfPitchZero", "type: prismatic", "pitch: 0, type: screw", 34, "a revolute joint"},
    {"PitchOfARevolute", "viscous: 0.01", "pitch: 2", 32, "only a screw has a pitch"},
    {"StartOfAWeld", "wrist: {type: revolute", "wrist: {type: weld", 33, "a weld has no freedom"},
    {"LimitsOfABall", "revolute, connects: [frame/main, crank/main], start: 40",
     "spherical, connects: [frame/main, crank/main], start: [0, 0, 40]", 31,
     "limits of a spherical"},
    {"QuaternionThatIsNone",
     "wrist: {type: revolute, connects: [coupler/slider, slider/pin], start: 9",
     "wrist: {type: spherical, connects: [coupler/slider, slider/pin], start: [1, 1, 0, 0]", 33,
     "has length 1, not 1.41421"},
    {"AbsentGround", "ground: frame", "ground: frane", 5,
     "link 'frane' not found; did you mean 'frame'?"},
    {"AbsentGraspLink", "link: coupler", "link: couper", 37, "did you mean 'coupler'?"},
    {"UnknownGraspKind", "kind: rigid", "kind: firm", 37, "'firm' is not one of: rigid, point"},
    {"AbsentCut", "cuts: [wrist]", "cuts: [wrst]", 38,
     "joint 'wrst' not found; did you mean 'wrist'?"},
    {"CutTwice", "cuts: [wrist]", "cuts: [wrist, wrist]", 38, "already cut"},
};

/// A block `parameters` in line 5, before the ground.
Malformed WithParameters(const std::string& subject, const std::string& block,
                         const std::string& message) {
  return {subject, "ground: frame", "parameters: " + block + "\nground: frame", 5, message};
}

const Malformed kParameters[] = {
    WithParameters("ParenthesisNotClosed", "{a: 2*(3 + 4}",
                   "parameters.a: expected a number, not '2*(3 + 4': a ')' is missing"),
    WithParameters("OperatorWithoutOperand", "{a: 2*}",
                   "it ends where a number or a name is wanted"),
    WithParameters("TwoNumbersInARow", "{a: 2 3}", "an operator is missing before '3'"),
    WithParameters("UnknownFunction", "{a: sinh(1)}",
                   "there is no function 'sinh'; known are sqrt"),
    WithParameters("UnknownUnit", "{a: 3 furlong}", "an operator is missing before 'furlong'"),
    WithParameters("AngleOfALength", "{a: sin(3 mm)}", "sin of a length; it takes an angle"),
    WithParameters("RootOfANegative", "{a: sqrt(-1)}", "root of -1, which is below zero"),
    WithParameters("NothingForAParameter", "{a: }",
                   "parameters.a: expected a number or an expression"),
    WithParameters("EmptyName", "{'': 1}", "made of letters, digits and '_'"),
    WithParameters("NameThatBeginsWithADigit", "{1a: 1}", "made of letters, digits and '_'"),
    WithParameters("MapForAParameter", "{a: {b: 1}}", "expected a number or an expression"),
    WithParameters("LongCircle", "{a: b, b: c, c: a}", "needs its own value: a -> b -> c -> a"),
    {"ParameterOfAnotherKind",
     "ground: frame\nlinks:\n  frame:\n    anchors:\n      main:  {origin: [0, 0, 0]",
     "parameters: {a: 3 kg}\nground: frame\nlinks:\n  frame:\n    anchors:\n      main:  {origin: "
     "[a, 0, 0]",
     10, "links.frame.anchors.main.origin[0]: 'a': a mass, where a length is asked"},
};

std::string SubjectOf(const testing::TestParamInfo<Malformed>& info) {
  return info.param.subject;
}

INSTANTIATE_TEST_SUITE_P(Syntax, MalformedFile, testing::ValuesIn(kSyntax), SubjectOf);
INSTANTIATE_TEST_SUITE_P(Keys, MalformedFile, testing::ValuesIn(kKeysAndKinds), SubjectOf);
INSTANTIATE_TEST_SUITE_P(Links, MalformedFile, testing::ValuesIn(kLinks), SubjectOf);
INSTANTIATE_TEST_SUITE_P(Joints, MalformedFile, testing::ValuesIn(kJoints), SubjectOf);
INSTANTIATE_TEST_SUITE_P(Parameters, MalformedFile, testing::ValuesIn(kParameters), SubjectOf);

TEST(MalformedFiles, HaveAllTheirErrorsReportedInTheOrderOfTheLines) {
  std::string text = Replaced(kSliderCrank, "crank/pin, coupler/crank", "cranc/pin, coupler/crank");
  text = Replaced(text, "mass: 0.4", "mass: -1");
  text = Replaced(text, "cuts: [wrist]", "cuts: [wrst]\ncolour: red");
  const std::vector<FileError> errors = ErrorsOf(text);
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_EQ(errors[0].line, 12);
  EXPECT_EQ(errors[1].line, 32);
  EXPECT_EQ(errors[2].line, 38);
  EXPECT_EQ(errors[3].line, 39);
  EXPECT_EQ(ToString(errors[1]).substr(0, 18), "test.yaml:32:38: j");
}

TEST(MalformedFiles, MustGiveTheLastLinkOfAChainAMass) {
  std::string text =
      Replaced(kSliderCrank, "\n  coupler:", "\n  weight: {anchors: {a: {}}}\n  coupler:");
  text = Replaced(text,
                  "joints:", "joints:\n  hook: {type: revolute, connects: [crank/pin, weight/a]}");
  const std::vector<FileError> errors = ErrorsOf(text);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].path, "links.weight");
  EXPECT_EQ(errors[0].message, "this link ends a chain and has no mass; give its mass");
}

TEST(MalformedFiles, OfEveryLengthEndInAnErrorAndNeverInACrash) {
  int refused = 0;
  for (size_t length = 0; length < kSliderCrank.size(); ++length) {
    refused += !ErrorsOf(kSliderCrank.substr(0, length)).empty();
  }
  EXPECT_GT(refused, static_cast<int>(kSliderCrank.size()) - 40);
}

}  // namespace
}  // namespace vmech::malformed_test
