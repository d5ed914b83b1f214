//%% [markdown]
// # Bearing loads, and what statics cannot tell
//
// A bearing catalogue asks for numbers: so much radial, so much axial load. Inverse dynamics gives
// them, but not all of them are facts. This chapter shows which ones statics can determine, what
// decides the others, how much a bearing's life depends on it, and how to build a mechanism that
// leaves no such question open.

//%%
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "notebook.h"
#include "vmech/dynamics/bearings/catalogue.h"
#include "vmech/dynamics/bearings/joint_bearings.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/mechanisms/files/reader.h"

using namespace vmech;

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## A door on two hinges
  //
  // A door of 30 kg hangs on two hinges, 1.6 m apart on one axis. Which of them carries its weight?
  // Equilibrium only says that both together do,
  //
  // $$
  // f_\mathrm{lower} + f_\mathrm{upper} = m g
  // $$
  //
  // and any carpenter knows that it depends on how they were fitted. If the hinges are springs of
  // stiffness $k$ along the axis and the door is rigid, both yield by the same amount, and the
  // shares are
  //
  // $$
  // \frac{f_\mathrm{lower}}{m g} = \frac{k_\mathrm{lower}}{k_\mathrm{lower} + k_\mathrm{upper}}
  // $$
  //
  // That is what the rule `stiffness` computes: of all wrenches in equilibrium, those with the
  // least elastic energy in the joints.

  //%%
  LoadStudy door;
  door.mechanism = ReadMechanism("mechanisms/examples/door-on-two-hinges.yaml");
  door.drives = {{0, 0, MotionLaw::Uniform(0, 0)}};  // held open where it is
  door.times = {0};

  plot::LinePlot shares;
  shares.title = "Share of the lower hinge in the weight of the door";
  shares.x = {"stiffness of the lower hinge over that of the upper", "", plot::ScaleType::kLog};
  shares.y = {"share", ""};
  shares.series = {{"closed form", {}, {}}, {"computed", {}, {}}};
  shares.series[1].line = plot::LineStyle::kNone;
  shares.series[1].marker = plot::Marker::kCircle;
  const double weight = 30 * 9.81;
  double worst = 0;
  for (double exponent = -2; exponent <= 2.001; exponent += 0.25) {
    const double ratio = std::pow(10, exponent);
    (*door.mechanism.joints[0].stiffness)[2] = 1e7 * ratio;
    (*door.mechanism.joints[1].stiffness)[2] = 1e7;
    const LoadStudyResult hung = RunLoadStudy(door);
    const double share = hung.poses[0].joints[0].force.z() / weight;
    const double closed_form = ratio / (1 + ratio);
    for (plot::Series& series : shares.series) series.x.push_back(ratio);
    shares.series[0].y.push_back(closed_form);
    shares.series[1].y.push_back(share);
    worst = std::max(worst, std::abs(share - closed_form));
    const double both = hung.poses[0].joints[0].force.z() + hung.poses[0].joints[1].force.z();
    worst = std::max(worst, std::abs(both / weight - 1));
  }
  notebook.Show(shares);
  notebook.CheckNear("largest difference between computed and closed form", worst, 0, 1e-9);

  //%% [markdown]
  // A program that prints one number here, without a word, hides a guess. So every component of
  // every joint comes with a verdict, found from the equations themselves: component $i$ is certain
  // if, and only if, no self-stress of the mechanism reaches it.

  //%%
  const LoadStudyResult hung = RunLoadStudy(door);
  const char* names[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  html::Table verdicts;
  verdicts.columns = {{"Joint"}};
  for (const char* name : names) verdicts.columns.push_back({name});
  for (size_t j = 0; j < 2; ++j) {
    verdicts.rows.push_back({door.mechanism.joints[j].name});
    for (const Certainty verdict : hung.certainty[j]) {
      const bool certain = verdict == Certainty::kCertain;
      verdicts.rows.back().push_back(html::Badge(
          certain ? "certain" : "open", certain ? html::Tone::kGood : html::Tone::kWarning));
    }
  }
  notebook.Show(verdicts);
  notebook.Check("the axial force of the lower hinge is not determined",
                 hung.certainty[0][2] == Certainty::kNotDetermined);
  notebook.Check("the moment about the hinges is certain",
                 hung.certainty[0][5] == Certainty::kCertain);

  //%% [markdown]
  // ## A planar four-bar lives in space
  //
  // The four-bar of chapter 1 has three redundant loop equations. Each of them is a self-stress: a
  // set of wrenches that the joints can hold against each other while nothing acts from outside. In
  // the plane nothing of it is seen. Out of the plane it decides everything.
  //
  // Let something push sideways on the coupler, with 100 N along the axes of the hinges.

  //%%
  const Mechanism four_bar = ReadMechanism("mechanisms/examples/four-bar.yaml");
  const int poses = 360;
  LoadStudy study;
  study.mechanism = four_bar;
  study.drives = {{FindJoint(four_bar, "main"), 0,
                   MotionLaw::Uniform(four_bar.joints[0].start[0], 2 * std::numbers::pi)}};
  for (int i = 0; i < poses; ++i) study.times.push_back(double(i) / poses);
  study.cycle = 1;
  ExternalLoad push;
  push.link = FindLink(four_bar, "coupler");
  push.p_L = {0.6, 0, 0};
  push.at = {0};
  push.wrenches = {{{0, 0, 100}, {0, 0, 0}}};
  study.external = {push};

  study.rule = ReactionRule::kStiffness;
  const LoadStudyResult by_stiffness = RunLoadStudy(study);
  study.rule = ReactionRule::kMinimumNorm;
  study.norm_length = 0.05;
  const LoadStudyResult by_norm = RunLoadStudy(study);

  notebook.Check("three equations are redundant", by_stiffness.redundant_equations == 3);
  int open = 0;
  for (const JointCertainty& joint : by_stiffness.certainty) {
    for (const Certainty verdict : joint) open += verdict == Certainty::kNotDetermined;
  }
  notebook.Check("in each hinge the axial force and both tilting moments are open: 12 components",
                 open == 12);

  //%% [markdown]
  // Two rules, two answers. `minimum_norm` takes the least sum of squares, with moments divided by
  // a length that somebody must choose; `stiffness` asks the springs. What is certain is the same
  // for both, and what is not differs:

  //%%
  double certain_change = 0, open_change = 0, largest = 0;
  for (int i = 0; i < poses; ++i) {
    for (size_t j = 0; j < four_bar.joints.size(); ++j) {
      const Vector6d one = by_stiffness.poses[i].joints[j].Stacked();
      const Vector6d two = by_norm.poses[i].joints[j].Stacked();
      for (int k = 0; k < 6; ++k) {
        const bool certain = by_stiffness.certainty[j][k] == Certainty::kCertain;
        double& change = certain ? certain_change : open_change;
        change = std::max(change, std::abs(one[k] - two[k]));
        largest = std::max(largest, std::abs(one[k]));
      }
    }
  }
  notebook.Print(fmt::format("largest change of an open component {:.3g} N or N m", open_change));
  notebook.CheckNear("largest change of a certain component, of the largest load",
                     certain_change / largest, 0, 1e-9);
  notebook.Check("open components do change", open_change > 1);

  //%%
  const int pivot = FindJoint(four_bar, "rocker_pivot");
  plot::LinePlot axial;
  axial.title = "Axial force at the main bearing: two rules";
  axial.x = {"crank angle from its start", "°", plot::ScaleType::kDegrees};
  axial.y = {"axial force", "N"};
  axial.series = {{"stiffness", {}, {}}, {"minimum_norm", {}, {}, plot::LineStyle::kDashed}};
  double total_error = 0;
  for (int i = 0; i < poses; ++i) {
    for (plot::Series& series : axial.series) series.x.push_back(360.0 * i / poses);
    axial.series[0].y.push_back(by_stiffness.poses[i].joints[0].force.z());
    axial.series[1].y.push_back(by_norm.poses[i].joints[0].force.z());
    for (const LoadStudyResult* result : {&by_stiffness, &by_norm}) {
      const auto& joints = result->poses[i].joints;
      total_error =
          std::max(total_error, std::abs(joints[0].force.z() + joints[pivot].force.z() + 100));
    }
  }
  notebook.Show(axial);
  notebook.CheckNear("both rules: the frame's axial forces add up to 100 N, error [N]", total_error,
                     0, 1e-7);

  //%% [markdown]
  // ## What it does to a bearing
  //
  // Suppose the main bearings are two 6002, 40 mm apart. How stiff that joint is out of the plane,
  // beside the other three, is not well known: it hangs on clearance, preload and housing. The
  // stiffer it is, the more of the tilting moment it draws to itself. The life of a ball bearing
  // falls with the third power of its load: twice the load leaves an eighth of the life. So a doubt
  // about the load is a large doubt about the life:

  //%%
  const std::vector<Bearing>& catalogue = BuiltInCatalogue();
  const Bearing bearing = *std::find_if(catalogue.begin(), catalogue.end(),
                                        [](const Bearing& b) { return b.designation == "6002"; });
  const Arrangement arrangement{{-0.02, 0.02}, 0};
  const auto life_with_stiffness = [&](double factor) {
    LoadStudy variant = study;
    variant.rule = ReactionRule::kStiffness;
    for (Joint& joint : variant.mechanism.joints) {
      joint.stiffness = Vector6d{1e8, 1e8, 1e7, 1e5, 1e5, 1e5};
    }
    variant.mechanism.joints[0].stiffness->tail(4) *= factor;  // axial and tilting
    const LoadStudyResult loads = RunLoadStudy(variant);
    DutyCycle cycle;
    cycle.duration = DurationsFromTimes(variant.times);
    for (const PoseLoads& pose : loads.poses) {
      cycle.angle.push_back(pose.drives[0].position);
      cycle.speed.push_back(pose.drives[0].velocity);
      cycle.wrench.push_back(pose.joints[0]);
    }
    const ArrangementLoads shares = DistributeLoads(arrangement, cycle.wrench);
    return RateBearing(bearing, shares.forces[0], SummariseRotation(cycle), 90).life_hours;
  };

  plot::LinePlot life;
  life.title = "Life of the locating 6002";
  life.x = {"stiffness of the main joint over that of the others", "", plot::ScaleType::kLog};
  life.y = {"L10h", "h", plot::ScaleType::kLog};
  life.series = {{"life", {}, {}}};
  life.series[0].marker = plot::Marker::kCircle;
  for (double exponent = -2; exponent <= 2.001; exponent += 0.5) {
    life.series[0].x.push_back(std::pow(10, exponent));
    life.series[0].y.push_back(life_with_stiffness(std::pow(10, exponent)));
  }
  notebook.Show(life);
  const double longest = *std::max_element(life.series[0].y.begin(), life.series[0].y.end());
  const double shortest = *std::min_element(life.series[0].y.begin(), life.series[0].y.end());
  notebook.Print(fmt::format("life between {} and {}: a factor of {:.0f}", FormatHours(shortest),
                             FormatHours(longest), longest / shortest));
  notebook.Check("the doubt is worth a factor of a hundred at least", longest > 100 * shortest);

  //%% [markdown]
  // ## Building it so that statics can tell
  //
  // The remedy is not a better computation but a better joint. Give the loop exactly the freedoms
  // that make $n - \operatorname{rank} C$ come out right without redundancy: let the crank pin
  // slide along its axis (a cylindrical joint), and make the rocker pin a ball joint. The loop then
  // has $1 + 2 + 3 + 1 = 7$ freedoms, one more than the six equations that close a loop in space.
  // It moves exactly as before.

  //%%
  LoadStudy better = study;
  const int crank_pin = FindJoint(four_bar, "crank_pin");
  const int rocker_pin = FindJoint(four_bar, "rocker_pin");
  Joint& sliding = better.mechanism.joints[crank_pin];
  sliding = MakeJoint("crank_pin", JointType::kCylindrical, sliding.first, sliding.second);
  sliding.start[1] = four_bar.joints[crank_pin].start[0];
  Joint& ball = better.mechanism.joints[rocker_pin];
  ball = MakeJoint("rocker_pin", JointType::kSpherical, ball.first, ball.second);

  better.rule = ReactionRule::kStiffness;
  const LoadStudyResult isostatic = RunLoadStudy(better);
  better.rule = ReactionRule::kMinimumNorm;
  const LoadStudyResult isostatic_by_norm = RunLoadStudy(better);

  bool all_certain = true;
  for (const JointCertainty& joint : isostatic.certainty) {
    for (const Certainty verdict : joint)
      all_certain = all_certain && verdict == Certainty::kCertain;
  }
  double motion_change = 0, rule_change = 0;
  for (int i = 0; i < poses; ++i) {
    motion_change =
        std::max(motion_change, std::abs(isostatic.poses[i].joints[pivot].position[0] -
                                         by_stiffness.poses[i].joints[pivot].position[0]));
    for (size_t j = 0; j < four_bar.joints.size(); ++j) {
      rule_change = std::max(rule_change, (isostatic.poses[i].joints[j].Stacked() -
                                           isostatic_by_norm.poses[i].joints[j].Stacked())
                                              .cwiseAbs()
                                              .maxCoeff());
    }
  }
  notebook.Check("one freedom, as before", isostatic.mobility == 1);
  notebook.Check("no equation is redundant", isostatic.redundant_equations == 0);
  notebook.Check("every component of every joint is certain", all_certain);
  notebook.CheckNear("the rocker moves as before, difference [rad]", motion_change, 0, 1e-9);
  notebook.CheckNear("the rules agree, difference of the largest load", rule_change / largest, 0,
                     1e-9);

  //%% [markdown]
  // Now a bearing can be chosen on facts. The smallest that does it, and why not a smaller one:

  //%%
  DutyCycle cycle;
  cycle.duration = DurationsFromTimes(better.times);
  for (const PoseLoads& pose : isostatic.poses) {
    cycle.angle.push_back(pose.drives[0].position);
    cycle.speed.push_back(pose.drives[0].velocity);
    cycle.wrench.push_back(pose.joints[0]);
  }
  BearingRequirements requirements;
  requirements.shaft_min = 0.012;
  requirements.shaft_max = 0.030;
  requirements.housing_max = 0.062;
  requirements.life_hours = 20000;
  requirements.static_safety = 1.5;
  const JointBearings chosen =
      SelectJointBearings(cycle, arrangement, requirements, LoadCertainty::kCertain, catalogue);
  notebook.Print(chosen.BriefReport());
  const BearingSelection& selection = chosen.selections[0];
  notebook.Print(selection.message);
  notebook.Print(fmt::format("passed over, {}: {}",
                             selection.candidates[selection.chosen - 1].bearing.designation,
                             selection.ReasonAgainst(selection.chosen - 1)));
  notebook.Check("both positions are filled", chosen.complete());

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
