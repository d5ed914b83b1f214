#include "vmech/apps/mechanism/dh_text.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <regex>
#include <sstream>

#include "support/examples.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr double kPrinted = 1e-12;  // metres and radians; 15 digits are printed

std::vector<std::string> Cells(const std::string& line) {
  static const std::regex kBetween("  +");
  const std::string text = line.substr(2);
  return {std::sregex_token_iterator(text.begin(), text.end(), kBetween, -1), {}};
}

/// The rows of a printed table: poses from nothing but the text.
std::vector<DhRow> Parsed(const std::string& text, const Mechanism& mechanism) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);  // the formula
  std::getline(lines, line);
  const std::vector<std::string> names = Cells(line);
  std::vector<DhRow> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = Cells(line);
    std::map<std::string, std::string> cell;
    for (size_t i = 0; i < names.size(); ++i) cell[names[i]] = cells.at(i);
    const auto length = [&](const char* name) { return std::atof(cell[name].c_str()) / 1000; };
    const auto angle = [&](const char* name) {
      return std::atof(cell[name].c_str()) / 180 * std::numbers::pi;
    };
    DhRow row;
    row.from = cell["from"] == "world" ? -1 : std::stoi(cell["from"]);
    row.parameters = {angle("theta"), length("d"), length("a"), angle("alpha"), angle("beta")};
    row.gamma = angle("gamma");
    row.b = length("b");
    if (const std::string q = cell["q"]; q != "-") {
      const std::string name = q.substr(0, q.find(':'));
      const size_t dot = name.find('.');
      row.joint = FindJoint(mechanism, name.substr(0, dot));
      const JointType type = mechanism.joints[row.joint].type;
      if (dot != name.npos) row.freedom = FindFreedom(type, name.substr(dot + 1));
      row.motion = q.find(": d") != q.npos ? DhMotion::kTranslation : DhMotion::kRotation;
    }
    rows.push_back(row);
  }
  return rows;
}

class DhTextOfExample : public testing::TestWithParam<std::string> {};

TEST_P(DhTextOfExample, GoesBackIntoPoses) {
  const Mechanism mechanism = Example(GetParam());
  const DhTable table = DeduceDhTable(mechanism, FindSpanningTree(mechanism));
  DhTable printed;
  printed.rows = Parsed(DhText(mechanism, table), mechanism);
  std::vector<std::vector<double>> start;
  for (const Joint& joint : mechanism.joints) start.push_back(joint.start);
  const std::vector<Posed> poses = DhPoses(table, start), from_text = DhPoses(printed, start);
  ASSERT_EQ(poses.size(), from_text.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((poses[i].R - from_text[i].R).cwiseAbs().maxCoeff(), kPrinted) << "row " << i;
    EXPECT_LT((poses[i].p - from_text[i].p).cwiseAbs().maxCoeff(), kPrinted) << "row " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DhTextOfExample, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

TEST(DhText, MarksNearlyParallelAxesAndBranches) {
  Mechanism mechanism;
  const Posed tilted{Eigen::AngleAxisd(1e-6, Vector3d::UnitY()).toRotationMatrix(), {0.5, 0, 0}};
  const Anchor plumb{"a", Posed()}, leaning{"b", tilted};
  mechanism.links = {Link{"ground", MassProperties(), {plumb, leaning}},
                     Link{"one", MassProperties(), {plumb}},
                     Link{"two", MassProperties(), {plumb}}};
  mechanism.joints = {MakeJoint("first", JointType::kRevolute, {0, 0}, {1, 0}),
                      MakeJoint("lead", JointType::kScrew, {0, 1}, {2, 0})};
  mechanism.joints[1].pitch = 1e-3 / (2 * std::numbers::pi);
  const std::string text = DhText(mechanism, DeduceDhTable(mechanism, FindSpanningTree(mechanism)));
  EXPECT_NE(text.find("nearly parallel"), text.npos) << text;
  EXPECT_NE(text.find(" Ry(beta)"), text.npos) << text;
  EXPECT_NE(text.find("lead: theta, d 0.00277777777777778 mm/deg"), text.npos) << text;
  EXPECT_NE(text.find("on ground"), text.npos) << text;
}

}  // namespace
}  // namespace vmech
