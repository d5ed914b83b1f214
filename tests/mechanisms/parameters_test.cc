// Parameters, bodies, relative anchors and used files: the same mechanism as with numbers typed in.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "same_mechanism.h"
#include "slider_crank.h"
#include "support/examples.h"
#include "support/temp_folder.h"
#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech::parameters_test {
namespace {

constexpr double kPi = std::numbers::pi;

std::string Replaced(std::string text, const std::string& passage, const std::string& replacement) {
  const size_t at = text.find(passage);
  if (at == text.npos) throw std::logic_error("the passage is not in the text: " + passage);
  return text.replace(at, passage.size(), replacement);
}

/// The slider-crank by its dimensions.
std::string WithParameters(const std::string& block) {
  std::string text = Replaced(kSliderCrank, "gravity:", "parameters: " + block + "\ngravity:");
  text = Replaced(text, "center_of_gravity: [25, 0, 0]", "center_of_gravity: [crank/2, 0, 0]");
  text = Replaced(text, "origin: [50, 0, 0]", "origin: [crank, 0, 0]");
  text = Replaced(text, "center_of_gravity: [100, 0, 0]", "center_of_gravity: [rod/2, 0, 0]");
  text = Replaced(text, "origin: [200, 0, 0]", "origin: [rod, 0, 0]");
  return Replaced(text, "link: coupler, origin: [100, 0, 0]",
                  "link: coupler, origin: [\"max(rod, crank)/2\", 0, 0]");
}

void ExpectSameBits(const Mechanism& a, const Mechanism& b) {
  EXPECT_EQ(Words(a), Words(b));
  EXPECT_EQ(Figures(a), Figures(b));
  EXPECT_EQ(WriteMechanism(a), WriteMechanism(b));
}

std::string ErrorsOf(const std::string& text) {
  try {
    ParseMechanism(text, "test.yaml");
  } catch (const FileErrors& errors) {
    return errors.what();
  }
  return "accepted";
}

void ExpectError(const std::string& text, const std::string& part) {
  EXPECT_NE(ErrorsOf(text).find(part), std::string::npos) << ErrorsOf(text);
}

TEST(Parameters, GiveTheMechanismOfTheFileWithTheNumbersTypedIn) {
  const Mechanism typed = ParseMechanism(kSliderCrank, "test.yaml");
  for (const char* block : {"{crank: 50, rod: 4*crank}", "{crank: 50 mm, rod: 4*crank}",
                            "{rod: crank + 150, crank: 5 cm}", "{crank: 0.05 m, rod: 20 cm}"}) {
    ExpectSameBits(ParseMechanism(WithParameters(block), "test.yaml"), typed);
  }
}

TEST(Parameters, AreSetFromOutsideAndTakeOthersAlong) {
  const TempFolder folder;
  const auto path = folder.path() / "slider-crank.yaml";
  std::ofstream(path) << WithParameters("{crank: 50 mm, rod: 4*crank}");
  const auto with = [&](std::vector<ParameterSetting> settings) {
    return ReadMechanism(path, settings);
  };
  std::string typed = Replaced(kSliderCrank, "[25, 0, 0]", "[30, 0, 0]");
  typed = Replaced(typed, "[50, 0, 0]", "[60, 0, 0]");
  for (int i = 0; i < 2; ++i) typed = Replaced(typed, "[100, 0, 0]", "[120, 0, 0]");
  typed = Replaced(typed, "[200, 0, 0]", "[240, 0, 0]");
  ExpectSameBits(with({{"crank", "60"}}), ParseMechanism(typed, "slider-crank.yaml"));
  ExpectSameBits(with({{"crank", "6 cm"}}), with({{"crank", "60"}}));
  ExpectSameBits(with({{"crank", "60"}, {"rod", "200"}}), with({{"rod", "200"}, {"crank", "60"}}));
  EXPECT_EQ(with({{"rod", "crank*3"}}).links[2].anchors[1].X_LA.p.x(), 0.15);
  const auto error = [&](const std::string& name, const std::string& text) -> std::string {
    try {
      with({{name, text}});
    } catch (const FileErrors& errors) {
      return errors.what();
    }
    return "accepted";
  };
  EXPECT_NE(error("crnak", "60").find("--set crnak=60: "), std::string::npos);
  EXPECT_NE(error("crnak", "60").find("did you mean 'crank'?"), std::string::npos);
  EXPECT_NE(error("crank", "5 kg").find("a mass, and crank is a length"), std::string::npos);
  EXPECT_NE(error("crank", "rod").find("crank -> rod -> crank"), std::string::npos);
  EXPECT_NE(error("crank", "1/0").find("division by zero"), std::string::npos);
}

TEST(Parameters, OfWhichOneStandsAloneWhereALengthIsAskedAreLengths) {
  std::string text = WithParameters("{crank: 50, rod: 4*crank}");
  text = Replaced(text, "origin: [crank, 0, 0]", "origin: [crank, crank*rod, 0]");
  ExpectError(text,
              "test.yaml:18:30: links.crank.anchors.pin.origin[1]: 'crank*rod': an area, "
              "where a length is asked");
  // A number that stands for a length and for an angle is a number.
  text = WithParameters("{crank: 50, rod: 4*crank}");
  text = Replaced(text, "start: 40,", "start: crank,");
  EXPECT_EQ(ParseMechanism(text, "test.yaml").joints[0].start[0], 50 * (kPi / 180));
}

TEST(Parameters, ThatAreWrongAreNamedWithTheirPlace) {
  const auto wrong = [](const std::string& block, const std::string& part) {
    ExpectError(Replaced(kSliderCrank, "gravity:", "parameters: " + block + "\ngravity:"), part);
  };
  wrong("{a: b, b: a}", "test.yaml:4:23: parameters.b: the parameter needs its own value: a -> b");
  wrong("{a: a}", "a -> a");
  wrong("{a: 1, b: c}", "test.yaml:4:23: parameters.b: there is no parameter 'c'");
  wrong("{crank: 1, b: cramk}", "did you mean 'crank'?");
  wrong("{a: 1/0}", "parameters.a: '1/0': division by zero");
  wrong("{a: 1e200*1e200}", "'1e200*1e200': not finite");
  wrong("{a: .inf}", "expected a number, not '.inf'");
  wrong("{mm: 1}", "mm is a unit; give the parameter another name");
  wrong("{sin: 1}", "sin has a meaning in expressions");
  wrong("{a-b: 1}", "made of letters, digits and '_'");
  wrong("{a: [1, 2]}", "expected a number or an expression");
  wrong("[1, 2]", "expected a map, not a list of 2");
  wrong("{a: 1, a: 2}", "this key is already given");
  wrong("{a: 2 mm + 1 kg}", "the sum of a length and a mass");
  ExpectError(Replaced(kSliderCrank, "mass: 0.4", "mass: 4*weight"),
              "test.yaml:12:11: links.crank.mass: expected a number, not '4*weight': there is no "
              "parameter 'weight'");
  ExpectError(Replaced(kSliderCrank, "[50, 0, 0]", "[max(1, 2), 0, 0]"),
              "an expression with a comma is written in quotes");
  ExpectError(Replaced(kSliderCrank, "mass: 0.4", "mass: 3 - 4"), "must not be negative");
  ExpectError(Replaced(kSliderCrank, "mass: 0.4", "mass: 1e20*1e20"), "beyond the range");
}

/// The text with a link's own mass replaced by bodies.
MassProperties OfBodies(const std::string& bodies) {
  const std::string text =
      Replaced(kSliderCrank,
               "    mass: 0.4\n    center_of_gravity: [25, 0, 0]\n    inertia: {about: "
               "center_of_gravity, xx: 10, yy: 100, zz: 110}\n",
               "    bodies: " + bodies + "\n");
  return ParseMechanism(text, "test.yaml").links[1].mass_properties;
}

void ExpectBody(const MassProperties& body, double mass, const Vector3d& p, const Vector3d& I) {
  EXPECT_NEAR(body.mass, mass, 1e-12 * mass);
  EXPECT_LT((body.p_LoLcm - p).norm(), 1e-15);
  EXPECT_LT((body.I_Lcm.diagonal() - I).norm(), 1e-12 * I.norm());
  EXPECT_LT((body.I_Lcm - Matrix3d(body.I_Lcm.diagonal().asDiagonal())).norm(), 1e-15 * I.norm());
}

/// Closed forms from textbooks of mechanics; lengths in metres.
TEST(Bodies, HaveTheMassAndInertiaOfTheirShape) {
  const double rho = 7850;
  ExpectBody(OfBodies("[{shape: box, size: [100, 20, 10], density: 7850}]"),
             rho * 0.1 * 0.02 * 0.01, Vector3d::Zero(),
             rho * 0.1 * 0.02 * 0.01 / 12 * Vector3d(4e-4 + 1e-4, 1e-2 + 1e-4, 1e-2 + 4e-4));
  const double cylinder = rho * kPi * 0.01 * 0.01 * 0.1;
  const double across = 0.01 * 0.01 / 4 + 0.1 * 0.1 / 12;
  ExpectBody(OfBodies("[{shape: cylinder, radius: 10, length: 100, density: 7.85 g/cm^3}]"),
             cylinder, Vector3d::Zero(), cylinder * Vector3d(across, across, 0.5e-4));
  const double tube = (1e-4 + 0.64e-4) / 4 + 0.1 * 0.1 / 12;
  ExpectBody(OfBodies("[{shape: tube, radius: 10, inner_radius: 8, length: 100, mass: 2}]"), 2,
             Vector3d::Zero(), 2 * Vector3d(tube, tube, (1e-4 + 0.64e-4) / 2));
  ExpectBody(OfBodies("[{shape: sphere, radius: 10, density: 7850}]"), rho * 4 * kPi / 3 * 1e-6,
             Vector3d::Zero(), rho * 4 * kPi / 3 * 1e-6 * 0.4e-4 * Vector3d::Ones());
  const double cone = 3.0 / 20 * 1e-4 + 3.0 / 80 * 1e-2;
  ExpectBody(OfBodies("[{shape: cone, radius: 10, length: 100, mass: 3}]"), 3,
             Vector3d(0, 0, 0.025), 3 * Vector3d(cone, cone, 0.3e-4));
}

/// Two halves of a box are the box; so are a body that is turned and turned back.
TEST(Bodies, AddUpByTheParallelAxisTheorem) {
  const MassProperties whole = OfBodies("[{shape: box, size: [100, 20, 10], mass: 2}]");
  const MassProperties halves = OfBodies(
      "[{shape: box, size: [50, 20, 10], mass: 1, origin: [-25, 0, 0]}, "
      "{shape: box, size: [10, 20, 50], mass: 1, origin: [25, 0, 0], z: [1, 0, 0], "
      "x: [0, 0, -1]}]");
  EXPECT_EQ(halves.mass, 2);
  EXPECT_LT(halves.p_LoLcm.norm(), 1e-17);
  EXPECT_LT((halves.I_Lcm - whole.I_Lcm).norm(), 1e-15 * whole.I_Lcm.norm());
  const MassProperties at_pin =
      OfBodies("[{shape: box, size: [100, 20, 10], mass: 2, relative: pin, origin: [-50, 0, 0]}]");
  EXPECT_LT((at_pin.I_Lcm - whole.I_Lcm).norm(), 1e-15 * whole.I_Lcm.norm());
}

TEST(Bodies, ThatAreWrongAreNamedWithTheirPlace) {
  const auto wrong = [](const std::string& body, const std::string& part) {
    ExpectError(Replaced(kSliderCrank, "    mass: 1.2\n", "    bodies: [" + body + "]\n"), part);
  };
  wrong("{shape: box, size: [1, 2, 0], mass: 1}", "links.slider.bodies[0].size: the three edges");
  wrong("{shape: box, radius: 1, mass: 1}", "the key 'size' is missing");
  wrong("{shape: sphere, radius: 1}", "give either 'density' or 'mass'");
  wrong("{shape: sphere, radius: 1, mass: 1, density: 1}", "give either 'density' or 'mass'");
  wrong("{shape: tube, radius: 1, inner_radius: 1, length: 1, mass: 1}", "less than 'radius'");
  wrong("{shape: sphere, radius: 1, length: 1, mass: 1}", "this shape has no such length");
  wrong("{shape: torus, mass: 1}", "'torus' is not one of: box, cylinder");
  wrong("{shape: sphere, radius: 1, mass: 1, relative: tip}", "has no anchor 'tip'");
  ExpectError(Replaced(kSliderCrank, "    mass: 1.2\n",
                       "    mass: 1.2\n    bodies: [{shape: sphere, radius: 1, mass: 1}]\n"),
              "links.slider.mass: not used beside 'bodies'");
}

TEST(Anchors, MayBeRelativeToOthersInAnyOrder) {
  const std::string text =
      Replaced(kSliderCrank, "      pin:  {origin: [50, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}",
               "      pin:  {relative: knee, origin: [0, -20, 0], z: [0, 0, 1], x: [0, -1, 0]}\n"
               "      knee: {relative: main, origin: [30, 0, 0], z: [0, 0, 1], x: [0, 1, 0]}");
  const Link& crank = ParseMechanism(text, "test.yaml").links[1];
  EXPECT_LT((crank.anchors[1].X_LA.p - Vector3d(0.05, 0, 0)).norm(), 1e-17);
  EXPECT_LT((crank.anchors[1].X_LA.R - Matrix3d::Identity()).norm(), 1e-15);
  ExpectError(Replaced(text, "relative: main", "relative: pin"), "relative to itself");
  ExpectError(Replaced(text, "relative: main", "relative: mein"), "did you mean 'main'?");
}

/// A leg of one link on a hinge, and a table on two of them.
class Uses : public testing::Test {
 protected:
  Uses() {
    Write("leg.yaml",
          "vmech: \"1.0\"\nname: leg\nunits: {length: cm, angle: deg}\n"
          "parameters: {shin: 40 cm}\ngravity: [0, 0, -9.81]\nground: hip\nlinks:\n"
          "  hip: {anchors: {top: {}}}\n"
          "  bar: {mass: 1, anchors: {top: {}, foot: {origin: [shin, 0, 0]}}}\n"
          "joints:\n  hinge: {type: revolute, connects: [hip/top, bar/top], start: 10}\n"
          "grasps:\n  toe: {link: bar, origin: [shin, 0, 0]}\ncuts: []\n");
  }
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  std::string Table(const std::string& uses) {
    return "vmech: \"1.0\"\nname: table\nunits: {length: mm, angle: deg}\n"
           "gravity: [0, 0, -9.81]\nground: floor\nparameters: {long: 500 mm}\n"
           "mechanisms:\n" +
           uses +
           "links:\n  floor: {anchors: {a: {}}}\n  plate: {mass: 2, anchors: {b: {}}}\n"
           "joints:\n  slide: {type: prismatic, connects: [left.bar/foot, plate/b]}\n";
  }
  std::string ErrorsOfTable(const std::string& uses) {
    Write("table.yaml", Table(uses));
    try {
      ReadMechanism(folder_.path() / "table.yaml");
    } catch (const FileErrors& errors) {
      return errors.what();
    }
    return "accepted";
  }
  const TempFolder folder_;
};

TEST_F(Uses, AreTheMechanismWithTheirPartsTypedIn) {
  Write("table.yaml",
        Table("  left:  {use: leg.yaml, origin: [0, 200, 0], parameters: {shin: long}}\n"
              "  right: {use: leg.yaml, on: plate, relative: b, z: [0, 1, 0], x: [1, 0, 0]}\n"));
  const Mechanism read = ReadMechanism(folder_.path() / "table.yaml");
  const Mechanism typed = ParseMechanism(
      "vmech: \"1.0\"\nname: table\nunits: {length: mm, angle: deg}\n"
      "gravity: [0, 0, -9.81]\nground: floor\nlinks:\n"
      "  floor: {anchors: {a: {}, left.top: {origin: [0, 200, 0]}}}\n"
      "  plate: {mass: 2, anchors: {b: {}, right.top: {z: [0, 1, 0], x: [1, 0, 0]}}}\n"
      "  left.bar: {mass: 1, anchors: {top: {}, foot: {origin: [500, 0, 0]}}}\n"
      "  right.bar: {mass: 1, anchors: {top: {}, foot: {origin: [400, 0, 0]}}}\n"
      "joints:\n"
      "  slide: {type: prismatic, connects: [left.bar/foot, plate/b]}\n"
      "  left.hinge: {type: revolute, connects: [floor/left.top, left.bar/top], start: 10}\n"
      "  right.hinge: {type: revolute, connects: [plate/right.top, right.bar/top], start: 10}\n"
      "grasps:\n"
      "  left.toe: {link: left.bar, origin: [500, 0, 0]}\n"
      "  right.toe: {link: right.bar, origin: [400, 0, 0]}\n",
      "table.yaml");
  ExpectSameBits(read, typed);
}

TEST_F(Uses, OfUsesHaveTheirPrefixesInARow) {
  Write("pair.yaml",
        "vmech: \"1.0\"\ngravity: [0, 0, 0]\nground: beam\nparameters: {reach: 1 m}\n"
        "mechanisms:\n  a: {use: leg.yaml, parameters: {shin: reach/2}}\n"
        "links:\n  beam: {anchors: {}}\njoints: {}\n");
  Write("table.yaml", Table("  left: {use: leg.yaml}\n"
                            "  both: {use: pair.yaml, parameters: {reach: 3*long}}\n"));
  const Mechanism mechanism = ReadMechanism(folder_.path() / "table.yaml");
  const int bar = FindLink(mechanism, "both.a.bar");
  ASSERT_GE(bar, 0);
  EXPECT_EQ(mechanism.links[bar].anchors[1].X_LA.p.x(), 0.75);
  EXPECT_GE(FindJoint(mechanism, "both.a.hinge"), 0);
}

TEST_F(Uses, ThatAreWrongAreNamedWithTheirPlace) {
  const auto wrong = [this](const std::string& use, const std::string& part) {
    const std::string errors = ErrorsOfTable(use);
    EXPECT_NE(errors.find(part), std::string::npos) << errors;
  };
  wrong("  left: {use: table.yaml}\n", "the file uses itself: table.yaml -> table.yaml");
  wrong("  left: {use: log.yaml}\n", "table.yaml:8:15: mechanisms.left.use: ");
  wrong("  left: {use: leg.yaml, on: flor}\n", "did you mean 'floor'?");
  wrong("  left: {use: leg.yaml, relative: b}\n", "link 'floor' has no anchor 'b'");
  wrong("  left: {use: leg.yaml, parameters: {chin: 3}}\n",
        "has no parameter 'chin'; did you mean");
  wrong("  left: {use: leg.yaml, parameters: {shin: 3 kg}}\n",
        "table.yaml:8:44: mechanisms.left.parameters.shin: a mass, and shin is a length");
  wrong("  left: {use: leg.yaml, parameters: {shin: -lang}}\n", "did you mean 'long'?");
  wrong("  left: {usse: leg.yaml}\n", "the key 'use' is missing");
  Write("leg.yaml", "vmech: \"1.0\"\ngravity: [0, 0, 0]\nground: a\nlinks: {a: 3}\njoints: {}\n");
  wrong("  left: {use: leg.yaml}\n", "leg.yaml:4:12: links.a: expected a map");
}

/// The starts are closed forms of the lengths; those of four-bar.yaml were computed elsewhere.
TEST(ExamplesWithParameters, AreTheLinkagesThatTheySay) {
  const std::vector<double> by_lengths = Figures(Example("four-bar-by-lengths"));
  const std::vector<double> typed = Figures(Example("four-bar"));
  ASSERT_EQ(by_lengths.size(), typed.size());
  for (size_t i = 0; i < typed.size(); ++i) {
    if (std::isinf(typed[i])) continue;  // a limit that there is not
    EXPECT_NEAR(by_lengths[i], typed[i], 1e-15) << i;
  }
  // The hexapod's legs are as long as those of the platform with its numbers typed in.
  const Mechanism hexapod = Example("hexapod"), platform = Example("stewart-gough");
  for (int leg = 1; leg <= 6; ++leg) {
    const Joint& slide = hexapod.joints[FindJoint(hexapod, fmt::format("leg{}.slide", leg))];
    const Joint& same = platform.joints[FindJoint(platform, fmt::format("leg{}", leg))];
    EXPECT_NEAR(slide.start[0], same.start[0], 1e-11);
  }
}

}  // namespace
}  // namespace vmech::parameters_test
