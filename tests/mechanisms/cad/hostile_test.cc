#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "samples.h"
#include "support/temp_folder.h"
#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/cad/step/step_reader.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech::hostile_test {
namespace {

using samples::At;
using samples::Box;
using samples::StepWriter;
using Path = std::filesystem::path;

std::string ErrorOf(const Path& file, const CadImportOptions& options = {}) {
  try {
    MechanismFromCad(ReadStep(file), options);
  } catch (const FileErrors& error) {
    return error.what();
  }
  return "no error";
}

void WriteText(const Path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string SampleText(const Path& file) {
  StepWriter step;
  samples::BuildSliderCrank(&step);
  step.Write(file);
  return ReadTextFile(file);
}

/// A solid of the given faces, whether they close or not.
TopoDS_Shape SolidOf(const TopoDS_Shape& faces, int leave_out = 0) {
  const BRep_Builder builder;
  TopoDS_Shell shell;
  TopoDS_Solid solid;
  builder.MakeShell(shell);
  TopTools_IndexedMapOfShape once;
  TopExp::MapShapes(faces, TopAbs_FACE, once);
  for (int i = 1 + leave_out; i <= once.Extent(); ++i) builder.Add(shell, once(i));
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

/// The text of a file whose last component is placed otherwise.
std::string WithPlacement(const std::string& text, const std::string& entity) {
  const size_t begin = text.rfind("ITEM_DEFINED_TRANSFORMATION");
  return text.substr(0, begin) + entity + text.substr(text.find(';', begin));
}

/// The text of a file of one block, the first occurrence of something in it replaced.
void WriteChanged(const Path& file, const std::string& what, const std::string& with) {
  StepWriter step;
  step.AddPart(step.root(), "frame", Box({0, 0, 0}, {100, 10, 10}));
  step.AddPart(step.root(), "block", Box({0, 20, 0}, {5, 25, 5}));
  step.Write(file);
  std::string text = ReadTextFile(file);
  const size_t at = text.rfind(what);
  ASSERT_NE(at, std::string::npos) << what;
  WriteText(file, text.replace(at, what.size(), with));
}

/// Shapes that share the edges where they meet.
TopoDS_Shape Glue(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  BRepAlgoAPI_BuilderAlgo glue;
  TopTools_ListOfShape both;
  both.Append(a);
  both.Append(b);
  glue.SetArguments(both);
  glue.Build();
  return glue.Shape();
}

TopoDS_Shape FaceOf(const TopoDS_Shape& solid) {
  return TopExp_Explorer(solid, TopAbs_FACE).Current();
}

TopoDS_Shape ShellOf(const TopoDS_Shape& solid) {
  return TopExp_Explorer(solid, TopAbs_SHELL).Current();
}

/// A frame, and beside it the part that is wrong.
void WriteWithFrame(const Path& file, const std::function<void(StepWriter*)>& add) {
  StepWriter step;
  step.AddPart(step.root(), "frame", Box({0, 0, 0}, {100, 10, 10}));
  add(&step);
  step.Write(file);
}

void WriteWithPart(const Path& file, const TopoDS_Shape& shape) {
  WriteWithFrame(file, [&](StepWriter* step) { step->AddPart(step->root(), "bad", shape); });
}

struct Hostile {
  std::string name;
  std::function<void(const Path&)> write;
  std::string message;  ///< a part of it
};

std::vector<Hostile> Files() {
  return {
      {"missing", [](const Path&) {}, "cannot be opened"},
      {"empty", [](const Path& file) { WriteText(file, ""); }, "is not a STEP file"},
      {"not_step", [](const Path& file) { WriteText(file, "solid cube\nendsolid"); },
       "is not a STEP file"},
      {"cut_off",
       [](const Path& file) {
         const std::string text = SampleText(file);
         WriteText(file, text.substr(0, text.size() / 2));
       },
       "is cut off"},
      {"nonsense_between_the_right_ends",
       [](const Path& file) {
         WriteText(file, "ISO-10303-21;\nHEADER;\n((((\x01\x02;;#1=;\nEND-ISO-10303-21;\n");
       },
       "cannot be understood"},
      {"entities_missing",
       [](const Path& file) {
         const std::string text = SampleText(file);
         WriteText(file, text.substr(0, text.find("#400 =")) + "ENDSEC;\nEND-ISO-10303-21;\n");
       },
       "is damaged: it refers to #"},
      {"empty_assembly", [](const Path& file) { StepWriter().Write(file); }, "holds no part"},
      {"frames_only",
       [](const Path& file) {
         StepWriter step;
         step.AddFrame(step.root(), "anchor_a");
         step.Write(file);
       },
       "holds no part"},
      {"shell",
       [](const Path& file) {
         WriteWithPart(file, ShellOf(Box({0, 20, 0}, {5, 25, 5})));
       },
       "part 'bad' has surfaces but no solid"},
      {"open_solid",
       [](const Path& file) {
         WriteWithPart(file, SolidOf(Box({0, 20, 0}, {5, 25, 5}), 1));
       },
       "part 'bad' has surfaces but no solid"},
      {"face_taken_out_of_the_text",
       [](const Path& file) {
         WriteWithPart(file, Box({0, 20, 0}, {5, 25, 5}));
         const std::string text = ReadTextFile(file);
         const size_t shell = text.rfind("CLOSED_SHELL('',(") + 17;
         WriteText(file, text.substr(0, shell) + text.substr(text.find(',', shell) + 1));
       },
       "part 'bad' has surfaces but no solid"},
      {"mirrored",
       [](const Path& file) {
         WriteText(file,
                   WithPlacement(SampleText(file),
                                 "CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#91,#92,#93,$,$);"
                                 "#91=DIRECTION('',(-1.,0.,0.));#92=DIRECTION('',(0.,1.,0.));"
                                 "#93=CARTESIAN_POINT('',(0.,0.,0.))"));
       },
       "places components by a mirror"},
      {"faulty_placement",
       [](const Path& file) {
         WriteText(file, WithPlacement(SampleText(file), "ITEM_DEFINED_TRANSFORMATION('','')"));
       },
       "has faulty entities (#"},
      {"fin_on_a_block",
       [](const Path& file) {
         WriteWithPart(
             file, SolidOf(Glue(Box({0, 20, 0}, {5, 25, 5}), FaceOf(Box({0, 25, 0}, {5, 30, 5})))));
       },
       "part 'bad' has surfaces beside its solids"},
      {"no_volume",
       [](const Path& file) {
         WriteWithPart(file, Box({0, 20, 0}, {0.001, 20.001, 0.001}));
       },
       "part 'bad' has a volume of 1e-09 mm^3"},
      {"zeros_in_the_data",
       [](const Path& file) { WriteChanged(file, "(5.,25.,5.)", std::string("(5\0,25.,5.)", 12)); },
       "is damaged: there is a zero byte (line "},
      {"cut_off_within_a_text",
       [](const Path& file) {
         const std::string text = SampleText(file);
         WriteText(file, text.substr(0, text.find("'crank'") + 3) + "\nEND-ISO-10303-21;\n");
       },
       "is damaged: it refers to #"},
      {"point_at_infinity",
       [](const Path& file) { WriteChanged(file, "(5.,25.,5.)", "(1.E+999,25.,5.)"); },
       "is damaged: 1.E+999 is beyond the range of numbers (line "},
      {"exponent_beyond_all_integers",
       [](const Path& file) { WriteChanged(file, "(5.,25.,5.)", "(1.E99999999999,25.,5.)"); },
       "is damaged: 1.E99999999999 is beyond the range of numbers (line "},
      {"defined_twice",
       [](const Path& file) {
         WriteChanged(file, "ENDSEC;", "#10=DIRECTION('',(0.,0.,1.));\nENDSEC;");
       },
       "is damaged: it defines #10 a second time (line "},
      {"axes_of_no_length",
       [](const Path& file) {
         WriteChanged(file, "DIRECTION('',(0.,0.,1.))", "DIRECTION('',(0.,0.,0.))");
       },
       "part 'block' has "},
      {"cylinder_of_negative_radius",
       [](const Path& file) {
         std::string text = SampleText(file);
         const size_t at = text.find(",8.5)");
         WriteText(file, text.replace(at, 5, ",-8.5)"));
       },
       "has solids that cannot be built (#"},
      {"length_in_grams",
       [](const Path& file) {
         WriteChanged(file, "SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.MILLI.,.GRAM.)");
       },
       "gives lengths in a unit that is no length (#"},
      {"no_data",
       [](const Path& file) {
         WriteText(file, "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
       },
       "cannot be understood"},
      {"assembly_within_itself",
       [](const Path& file) {
         WriteChanged(file, "ENDSEC;",
                      "#900000=NEXT_ASSEMBLY_USAGE_OCCURRENCE('9','again','',#5,#5,$);\nENDSEC;");
       },
       "has no shapes that can be read"},
      {"nothing_joined",
       [](const Path& file) {
         WriteWithPart(file, Box({0, 20, 0}, {5, 25, 5}));
       },
       "no chain of joints connects the ground link 'frame' to 'bad'"},
  };
}

class HostileFile : public testing::TestWithParam<int> {};

TEST_P(HostileFile, GetsAClearMessage) {
  const Hostile hostile = Files()[GetParam()];
  const TempFolder folder;
  const Path file = folder / (hostile.name + ".step");
  hostile.write(file);
  const std::string error = ErrorOf(file);
  EXPECT_NE(error.find(hostile.message), std::string::npos) << error;
  EXPECT_NE(error.find(hostile.name + ".step: "), std::string::npos) << "names the file: " << error;
}

INSTANTIATE_TEST_SUITE_P(Files, HostileFile, testing::Range(0, static_cast<int>(Files().size())),
                         [](const auto& info) { return Files()[info.param].name; });

}  // namespace
}  // namespace vmech::hostile_test
