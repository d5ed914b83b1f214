//%% [markdown]
// # Sensitivities and optimisation
//
// A study says what a design comes to. Its derivatives say what would change that: the loops are
// differentiated implicitly,
//
// $$
// C \frac{dq}{dp} = -\frac{\partial e}{\partial p}
// $$
//
// and from there on the derivative is taken along with the value, line by line, by dual numbers.
// This chapter compares the derivatives with differences of whole studies, and the designs that
// they lead to with three that have been published.

//%%
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "notebook.h"
#include "vmech/studies/design.h"
#include "vmech/studies/study_reader.h"

using namespace vmech;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A study that was read and run.
struct Case {
  explicit Case(const std::string& path) : file(ReadStudy(path)), outcome(RunStudy(file, {})) {}

  Figure figure(const std::string& name) const {
    return FindFigure(FiguresOf(file, outcome), name);
  }
  StudyParameter parameter(const std::string& name) const {
    std::vector<StudyParameter> known = FileParametersOf(file);
    for (StudyParameter& p : DimensionsOf(file, true)) known.push_back(std::move(p));
    return FindParameter(known, name);
  }
  DesignVariable variable(const std::string& name, double lower, double upper) const {
    return {parameter(name), lower, upper};
  }

  StudyFile file;
  StudyOutcome outcome;
};

/// What a figure comes to for a value of a parameter: a whole study, and no derivative.
double ValueWith(const Case& of, const Figure& figure, const StudyParameter& parameter,
                 double value) {
  StudyFile changed = of.file;
  parameter.put(value, &changed);
  return FindSensitivities(changed, RunStudy(changed, {}), {figure}, {}).figures[0].value;
}

double FivePoints(const Case& of, const Figure& figure, const StudyParameter& parameter) {
  const double step = 1e-3 * parameter.scale;
  const auto at = [&](int k) {
    return ValueWith(of, figure, parameter, parameter.value + k * step);
  };
  return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
}

html::Table TableOf(const DesignTask& task, const DesignResult& result) {
  html::Table table;
  table.columns = {{""}, {"Before", true}, {"After", true}, {"Unit"}};
  const auto row = [&](const std::string& name, double before, double after, std::string unit) {
    table.rows.push_back(
        {name, fmt::format("{:.6g}", before), fmt::format("{:.6g}", after), std::move(unit)});
  };
  row(task.objective.name, result.before[0], result.after[0], task.objective.unit);
  for (size_t k = 0; k < task.variables.size(); ++k) {
    const StudyParameter& p = task.variables[k].parameter;
    row(p.name, p.value, result.values[k], p.unit);
  }
  return table;
}

/// The angles of the drive [deg].
std::vector<double> CrankAngles(const Case& of) {
  std::vector<double> angles;
  for (const double t : of.file.study.times) {
    angles.push_back(of.file.study.drives[0].law.At(t).position / kDegree);
  }
  return angles;
}

/// The force on the frame at every pose [N]: the joints on the frame are in its axes.
std::vector<double> ShakingForces(const StudyFile& file) {
  const StudyOutcome outcome = RunStudy(file, {});
  std::vector<double> forces;
  for (const PoseLoads& pose : outcome.loads.poses) {
    Vector3d sum = Vector3d::Zero();
    for (const char* joint : {"main", "rocker_pivot"}) {
      sum += pose.joints[static_cast<size_t>(FindJoint(file.study.mechanism, joint))].force;
    }
    forces.push_back(sum.norm());
  }
  return forces;
}

}  // namespace

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## What matters
  //
  // The compressor of the examples, a slider-crank at 1500 rpm. An elasticity of 2 says that a
  // percent of the dimension moves the figure by two percent.

  //%%
  const Case compressor("mechanisms/examples/slider-crank-study.yaml");
  const Sensitivities slopes = FindSensitivities(
      compressor.file, compressor.outcome,
      {compressor.figure("pin.force"), compressor.figure("main.drive"),
       compressor.figure("ground.force.rms"), compressor.figure("pin.life")},
      {compressor.parameter("crank/pin.x"), compressor.parameter("coupler/wrist.x"),
       compressor.parameter("coupler.mass"), compressor.parameter("slider.mass")});
  html::Table elasticities;
  elasticities.columns = {{"Figure"}, {"Value", true}};
  for (const StudyParameter& p : slopes.parameters) elasticities.columns.push_back({p.name, true});
  double worst = 0;
  for (const FigureSlopes& f : slopes.figures) {
    elasticities.rows.push_back({f.figure.name, fmt::format("{:.5g} {}", f.value, f.figure.unit)});
    for (size_t p = 0; p < slopes.parameters.size(); ++p) {
      const StudyParameter& parameter = slopes.parameters[p];
      elasticities.rows.back().push_back(fmt::format("{:+.4f}", f.Elasticity(p, parameter)));
      const double difference = FivePoints(compressor, f.figure, parameter);
      worst =
          std::max(worst, std::abs(difference - f.slopes[p]) * parameter.scale / std::abs(f.value));
    }
  }
  notebook.Show(elasticities);
  notebook.CheckNear("largest distance from differences of whole studies, of the figures", worst, 0,
                     2e-8);

  //%% [markdown]
  // ## A four-bar linkage that does not shake
  //
  // Berkof and Lowen (1969) wrote the centre of mass of a four-bar linkage by its linearly
  // independent vectors, and let their coefficients vanish. For a coupler $m_3$ whose centre lies
  // on its line at $r_3$ of $a_3$ this leaves
  //
  // $$
  // m_2 r_2 = -m_3 \left(1 - \frac{r_3}{a_3}\right) a_2, \quad
  // m_4 r_4 = -m_3 \frac{r_3}{a_3} a_4
  // $$
  //
  // A search by the root mean square of the force on the frame does not know that.

  //%%
  const Case shaking("studies/examples/balanced-four-bar-study.yaml");
  DesignTask balance;
  balance.objective = shaking.figure("ground.force.rms");
  balance.variables = {shaking.variable("crank.center_of_gravity.x", -1000, 500),
                       shaking.variable("rocker.center_of_gravity.x", -1000, 500)};
  const DesignResult balanced = OptimiseDesign(shaking.file, shaking.outcome, balance, {});
  plot::LinePlot forces;
  forces.title = "Force on the frame";
  forces.x = {"crank", "deg"};
  forces.y = {"force", "N"};
  forces.series = {{"bars alone", CrankAngles(shaking), ShakingForces(shaking.file)},
                   {"with counterweights", CrankAngles(shaking), ShakingForces(balanced.best),
                    plot::LineStyle::kDashed}};
  notebook.Show(TableOf(balance, balanced));
  notebook.Show(forces);
  notebook.CheckNear("counterweight of the crank [mm]", balanced.values[0],
                     -1 * (1 - 600. / 1200) * 500 / 0.5, 0.05);
  notebook.CheckNear("counterweight of the rocker [mm]", balanced.values[1],
                     -1 * (600. / 1200) * 750 / 0.75, 0.05);
  notebook.CheckNear("what is left of the force", balanced.after[0] / balanced.before[0], 0, 1e-4);

  //%% [markdown]
  // ## A rocker that is driven well
  //
  // Of all crank-rockers that swing by an angle $\varphi$ and take as long there as back, Brodell
  // and Soni (1970) gave the one of a least transmission angle $\gamma$: with the frame as the
  // unit of length,
  //
  // $$
  // r_3 = \sqrt{\frac{1 - \cos\varphi}{2 \cos^2\gamma}}, \quad
  // r_4 = \sqrt{\frac{1 - r_3^2}{1 - r_3^2 \cos^2\gamma}}, \quad
  // r_2 = \sqrt{r_3^2 + r_4^2 - 1}
  // $$
  //
  // It has the best coupler for its crank and rocker: a longer one would lower the angle at one
  // end, a shorter one at the other. The search is given the crank, a rocker that must swing by no
  // more than 60 degrees, and nothing of the time ratio.

  //%%
  const double r3 = std::sqrt((1 - std::cos(60 * kDegree)) / 2) / std::cos(45 * kDegree);
  const double r4 = std::sqrt((1 - r3 * r3) / (1 - r3 * r3 / 2));
  const Case rocker("studies/examples/crank-rocker-study.yaml");
  DesignTask transmission;
  transmission.objective = rocker.figure("transmission");
  transmission.variables = {rocker.variable("coupler", 0.6, 1.2),
                            rocker.variable("rocker", r4, 1.2)};
  const DesignResult driven = OptimiseDesign(rocker.file, rocker.outcome, transmission, {});
  notebook.Show(TableOf(transmission, driven));
  notebook.CheckNear("farthest from a right angle [deg]", driven.after[0], 45, 0.02);
  notebook.CheckNear("coupler over frame", driven.values[0], r3, 1e-3);
  notebook.CheckNear("rocker over frame", driven.values[1], r4, 1e-6);

  //%% [markdown]
  // Two peaks are equal there, at the two poses in which crank and frame are in line. A search by
  // the largest alone would jump from one to the other; it goes by $(\sum x^p)^{1/p}$ with $p =
  // 32$, then 512 and 8192.
  //
  // ## A path of five points
  //
  // Case 2 of Cabrera, Simon and Prado (2002), which many have tried their methods on: a coupler
  // point is to pass five points as the crank stands at 30, 45, 60, 75 and 90 degrees. Six lengths
  // are to be found, and the points are given with three decimals, so that something is left.

  //%%
  const Case path("studies/examples/path-four-bar-study.yaml");
  DesignTask synthesis;
  synthesis.objective = path.figure("point.path.rms");
  for (const auto& [name, lower, upper] :
       {std::tuple("ground", 1., 10.), std::tuple("crank", 0.5, 5.), std::tuple("coupler", 1., 10.),
        std::tuple("rocker", 1., 10.), std::tuple("along", -5., 5.),
        std::tuple("across", -5., 5.)}) {
    synthesis.variables.push_back(path.variable(name, lower, upper));
  }
  const DesignResult found = OptimiseDesign(path.file, path.outcome, synthesis, {});
  const double rms = 1e3 * found.after[0];  // [mm]
  notebook.Show(TableOf(synthesis, found));
  notebook.Print(
      fmt::format("sum of squares {:.4e} mm^2 after {} designs", 5 * rms * rms, found.evaluations));
  // By Levenberg and Marquardt's method on the closed form, from 300 starts.
  notebook.CheckNear("sum of squares over the least there is", 5 * rms * rms / 7.4158e-7, 1, 1e-3);

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
