#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>

#include "step_writer.h"
#include "support/temp_folder.h"
#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/cad/step/step_reader.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech::step_density_test {
namespace {

using samples::Box;
using samples::StepWriter;
using Path = std::filesystem::path;

constexpr double kRelative = 1e-12;

constexpr const char* kGram = "(MASS_UNIT()NAMED_UNIT(*)SI_UNIT($,.GRAM.))";
constexpr const char* kKilogram = "(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.KILO.,.GRAM.))";
constexpr const char* kMetre = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))";
constexpr const char* kMillimetre = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))";
constexpr const char* kCentimetre = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.))";

/// Puts entities before the end of the data of a STEP file.
std::string WithEntities(std::string text, const std::string& entities) {
  const size_t end = text.rfind("ENDSEC;");
  return text.insert(end, entities);
}

/// States a density of every product, its unit being the entity #900000 of `unit`.
std::string WithDensity(const std::string& text, double value, const std::string& unit,
                        const std::string& measure = "POSITIVE_RATIO_MEASURE") {
  std::string entities =
      unit + fmt::format(
                 "#900100=MEASURE_REPRESENTATION_ITEM('density measure',{}({:.17G}{}),"
                 "#900000);\n",
                 measure, value, value == std::floor(value) ? "." : "");
  std::smatch context;
  EXPECT_TRUE(std::regex_search(text, context, std::regex(R"(#(\d+) = \( GEOMETRIC_REPR)")));
  entities += fmt::format("#900101=REPRESENTATION('density',(#900100),#{});\n", context[1].str());
  const std::regex product(R"(#(\d+) = PRODUCT_DEFINITION\()");
  int next = 900200;
  for (std::sregex_iterator it(text.begin(), text.end(), product), end; it != end; ++it) {
    entities += fmt::format("#{}=PROPERTY_DEFINITION('material property','density of part',#{});\n",
                            next, (*it)[1].str());
    entities +=
        fmt::format("#{}=PROPERTY_DEFINITION_REPRESENTATION(#{},#900101);\n", next + 1, next);
    next += 2;
  }
  return WithEntities(text, entities);
}

std::string Derived(const std::string& mass, double mass_exponent, const std::string& length,
                    double length_exponent) {
  return fmt::format(
      "#900000=DERIVED_UNIT((#900001,#900002));\n#900001=DERIVED_UNIT_ELEMENT(#900003,{:.1f});\n"
      "#900002=DERIVED_UNIT_ELEMENT(#900004,{:.1f});\n#900003={};\n#900004={};\n",
      mass_exponent, length_exponent, mass, length);
}

/// A unit by conversion, of the entity #900010: "pound" of 0.45359237 kg.
std::string Converted(const std::string& kind, const std::string& name, double factor,
                      const std::string& measure) {
  // The parts of an entity stand in the order of the alphabet.
  const std::string named = "NAMED_UNIT(#900012)", own = kind + "()";
  return fmt::format(
      "(CONVERSION_BASED_UNIT('{}',#900011){}{});\n#900011=MEASURE_WITH_UNIT({}({:#.17G}),#900010);"
      "\n#900012=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.)",
      name, own < named ? own : named, own < named ? named : own, measure, factor);
}

CadAssembly ReadText(const std::string& text) {
  const TempFolder folder;
  std::ofstream(folder / "it.step", std::ios::binary) << text;
  return ReadStep(folder / "it.step");
}

std::string BlockText() {
  const TempFolder folder;
  StepWriter step;
  step.AddPart(step.root(), "block", Box({0, 0, 0}, {10, 20, 30}));
  step.Write(folder / "it.step");
  return ReadTextFile(folder / "it.step");
}

struct Spelling {
  const char* name;
  double value;
  std::string unit;
  double density;  ///< [kg/m^3]
};

const Spelling kSpellings[] = {
    {"kg/m^3", 7850, Derived(kKilogram, 1, kMetre, -3), 7850},
    {"g/cm^3", 7.85, Derived(kGram, 1, kCentimetre, -3), 7850},
    {"g/mm^3", 0.00785, Derived(kGram, 1, kMillimetre, -3), 7850},
    {"kg/mm^3", 7.85e-6, Derived(kKilogram, 1, kMillimetre, -3), 7850},
    {"kg/cm^3", 7.85e-3, Derived(kKilogram, 1, kCentimetre, -3), 7850},
    {"t/m^3 as Mg/m^3", 7.85,
     Derived("(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.MEGA.,.GRAM.))", 1, kMetre, -3), 7850},
    {"mg/mm^3", 7.85,
     Derived("(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.GRAM.))", 1, kMillimetre, -3), 7850},
    {"g/cm^3 as Open CASCADE writes it", 7.85, Derived(kGram, 3, kCentimetre, 2), 7850},
    {"lb/m^3", 100,
     Derived(
         Converted("MASS_UNIT", "POUND", 0.45359237, "MASS_MEASURE") + ";\n#900010=" + kKilogram, 1,
         kMetre, -3),
     45.359237},
    {"g/inch^3", 100,
     Derived(kGram, 1,
             Converted("LENGTH_UNIT", "INCH", 25.4, "LENGTH_MEASURE") + ";\n#900010=" + kMillimetre,
             -3),
     0.1 / (0.0254 * 0.0254 * 0.0254)},
    {"kg/litre", 2.7,
     Derived(kKilogram, 1,
             Converted("VOLUME_UNIT", "LITRE", 1000, "VOLUME_MEASURE") +
                 ";\n#900010=DERIVED_UNIT((#900020));\n#900020=DERIVED_UNIT_ELEMENT(#900021,3.);\n"
                 "#900021=" +
                 kCentimetre,
             -1),
     2700},
};

TEST(StepDensity, IsReadInEveryUnit) {
  const std::string block = BlockText();
  for (const Spelling& spelling : kSpellings) {
    const CadAssembly read = ReadText(WithDensity(block, spelling.value, spelling.unit));
    ASSERT_TRUE(read.shapes[0].material.density.has_value()) << spelling.name;
    EXPECT_NEAR(*read.shapes[0].material.density / spelling.density, 1, kRelative) << spelling.name;
    EXPECT_TRUE(read.remarks.empty()) << spelling.name << ": " << read.remarks.front();
  }
}

TEST(StepDensity, ThatNothingHasIsPassedOverWithARemark) {
  const std::string block = BlockText();
  const auto remark = [&](double value, const std::string& unit) {
    const CadAssembly read = ReadText(WithDensity(block, value, unit));
    EXPECT_FALSE(read.shapes[0].material.density.has_value()) << value;
    return read.remarks.empty() ? "none" : read.remarks.back();
  };
  EXPECT_EQ(
      remark(7.85, Derived(kGram, 1, kCentimetre, -2)),
      "the density of 'block' is passed over: it is 7.85 in a unit that is no mass per volume");
  EXPECT_EQ(
      remark(7.85, std::string("#900000=") + kGram + ";\n"),
      "the density of 'block' is passed over: it is 7.85 in a unit that is no mass per volume");
  EXPECT_EQ(remark(-7850, Derived(kKilogram, 1, kMetre, -3)),
            "the density of 'block' is passed over: it is -7850 kg/m^3, which nothing weighs");
  EXPECT_EQ(remark(7850, Derived(kKilogram, 1, kMillimetre, -3)),
            "the density of 'block' is passed over: it is 7.85e+12 kg/m^3, which nothing weighs");
  const std::string circle =
      Converted("MASS_UNIT", "POUND", 2.5, "MASS_MEASURE") + ";\n#900010=" +
      "(CONVERSION_BASED_UNIT('STONE',#900030)MASS_UNIT()NAMED_UNIT(#900012));\n"
      "#900030=MEASURE_WITH_UNIT(MASS_MEASURE(14.),#900003)";
  EXPECT_EQ(
      remark(7.85, Derived(circle, 1, kMetre, -3)),
      "the density of 'block' is passed over: it is 7.85 in a unit that is no mass per volume")
      << "a unit defined by itself";
}

/// The arm of the samples with a density of 7850 in kg/m^3 for everything.
TEST(StepDensity, OfThePartsOfAnArmIsTheLastThatTheFileStates) {
  const std::string arm = ReadTextFile(Path(VMECH_CAD_SAMPLES) / "arm.step");
  const CadImport import =
      MechanismFromCad(ReadText(WithDensity(arm, 7850, Derived(kKilogram, 1, kMetre, -3))));
  // base plate 100 x 100 x 12 less a bore of 6, servo 40 x 20 x 38 with a shaft of 8 x 8 [mm]
  const double volume = 120000 - M_PI * 9 * 12 + 30400 + M_PI * 16 * 8;
  EXPECT_NEAR(import.mechanism.links[0].mass_properties.mass, 7850e-9 * volume, 1e-6 * 1.18);
  EXPECT_NEAR(7850e-9 * volume, 1.18113, 5e-6);
  const std::string expected =
      "'servo' has two densities in the file, 1800 and 7850 kg/m^3; the "
      "second is taken";
  EXPECT_EQ(std::count(import.remarks.begin(), import.remarks.end(), expected), 1);
}

/// A sketch beside the solid of a product of the arm, as CAD systems keep construction lines.
TEST(StepNames, OfAProductWithASketchBesideItsSolidIsThatOfTheProduct) {
  const std::string arm = ReadTextFile(Path(VMECH_CAD_SAMPLES) / "arm.step");
  const CadAssembly read = ReadText(WithEntities(
      arm,
      "#900000=CARTESIAN_POINT('',(0.,0.,0.));\n#900001=CARTESIAN_POINT('',(10.,0.,0.));\n"
      "#900002=POLYLINE('',(#900000,#900001));\n#900003=GEOMETRIC_CURVE_SET('',(#900002));\n"
      "#900004=GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',(#900003,#11),#933);\n"
      "#900005=SHAPE_REPRESENTATION_RELATIONSHIP('','',#512,#900004);\n"));
  const CadAssembly plain = ReadStep(Path(VMECH_CAD_SAMPLES) / "arm.step");
  ASSERT_EQ(read.parts.size(), plain.parts.size());
  EXPECT_EQ(read.groups.size(), plain.groups.size());
  EXPECT_EQ(read.frames.size(), plain.frames.size());
  EXPECT_TRUE(read.remarks.empty());
  EXPECT_EQ(read.parts[1].name, "servo-yaw");
  for (size_t i = 0; i < read.parts.size(); ++i) {
    EXPECT_EQ(read.parts[i].name, plain.parts[i].name);
    EXPECT_EQ(read.parts[i].X_WP.p, plain.parts[i].X_WP.p);
    const CadShape &one = read.shapes[read.parts[i].shape],
                   &other = plain.shapes[plain.parts[i].shape];
    EXPECT_EQ(one.volume.volume, other.volume.volume);
    EXPECT_EQ(one.material.density, other.material.density) << "the servo has 1800 kg/m^3";
    EXPECT_EQ(one.defect, "");
  }
}

struct Encoded {
  const char* bytes;  ///< in the file
  const char* name;
};

/// Every string of ISO 10303-21:2016, 6.4.3, and what programs write that know none.
const Encoded kEncoded[] = {
    {R"(Fu\X2\00DF\X0\)", "Fuß"},
    {R"(Men\X2\00FC\X0\)", "Menü"},
    {R"(\X2\00E0\X0\)", "à"},
    {R"(Gr\X2\00F600DF\X0\e)", "Größe"},
    {R"(\X4\0001F600\X0\)", "😀"},
    {R"(Fu\X\DF)", "Fuß"},
    {R"(Fu\S\_)", "Fuß"},
    {R"(\PB\\S\[)", "Ű"},
    {"Gr\xC3\xB6\xC3\x9F", "Größ"},
    {"Fu\xDF", "Fuß"},
    {"M\xFCller", "Müller"},
    {"M\xC3\xBCller", "Müller"},
    {"o''neil", "o'neil"},
    {R"(a\\b)", "a_b"},
    {R"(\X2\65E5672C\X0\)", "日本"},
};

TEST(StepNames, ComeThroughInEveryEncoding) {
  for (const Encoded& encoded : kEncoded) {
    std::string text = BlockText();
    for (size_t at = 0; (at = text.find("'block'", at)) != std::string::npos; ++at) {
      text.replace(at, 7, std::string("'") + encoded.bytes + "'");
    }
    const CadAssembly read = ReadText(text);
    ASSERT_EQ(read.parts.size(), 1u);
    EXPECT_EQ(read.parts[0].name, encoded.name) << encoded.bytes;
  }
}

}  // namespace
}  // namespace vmech::step_density_test
