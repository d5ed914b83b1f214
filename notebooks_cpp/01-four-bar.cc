//%% [markdown]
// # The four-bar linkage
//
// Four links, four hinges, one loop: the smallest mechanism that shows what a closed chain is.
// This chapter reads it from a file, finds out how it can move, turns its crank once, and asks what
// each hinge must carry. Every number is checked where it stands; the chapter fails if one is
// wrong.

//%%
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "notebook.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/mechanisms/files/reader.h"

using namespace vmech;

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## From parts to a mechanism
  //
  // A mechanism is a list of links with mass and *anchors*, and a list of joints, each the
  // coincidence of two anchors. Nothing says where the loop is: it is found, and cut open at one
  // joint. What is left is a tree, and the cut joint becomes equations that close the loop again,
  // $e_2(q) = 0$.

  //%%
  const Mechanism mechanism = ReadMechanism("mechanisms/examples/four-bar.yaml");
  const KinematicTree tree = BuildKinematicTree(mechanism);
  VectorXd q = StartCoordinates(tree);
  const AssemblySummary assembly = Assemble(tree, {}, &q);

  notebook.Print(fmt::format("{} links, {} joints, cut at '{}'; the loop closes to {:.0e}",
                             mechanism.links.size(), mechanism.joints.size(),
                             mechanism.joints[tree.loops[0].joint].name, assembly.error));
  notebook.Check("the loop is closed", assembly.closed);

  //%% [markdown]
  // ## How can it move?
  //
  // The planar count that every student knows, $3 (n - 1) - 2 j$ with $n = 4$ links and $j = 4$
  // hinges, gives 1 and says that the linkage moves. It is right because it takes for granted that
  // all hinges are parallel. The spatial count takes nothing for granted, and says that the linkage
  // is stuck: the tree has three freedoms and the cut hinge takes five, so that Gruebler's count is
  // $3 - 5 = -2$. Three of the five equations, those that keep the links in their plane, only
  // repeat what the other hinges say already. The rank of the loop Jacobian $C = \partial e_2 /
  // \partial q$ knows better:
  //
  // $$
  // \text{mobility} = n - \operatorname{rank} C = 3 - 2 = 1
  // $$

  //%%
  const Mobility mobility = AnalyseMobility(tree, q);
  notebook.Print(fmt::format("Gruebler's count {}, mobility {}, redundant equations {}",
                             mobility.gruebler, mobility.mobility, mobility.redundant));
  notebook.Check("counting says that the four-bar is stuck", mobility.gruebler == -2);
  notebook.Check("it has one freedom", mobility.mobility == 1);
  notebook.Check("three loop equations are redundant", mobility.redundant == 3);

  //%% [markdown]
  // The three redundant equations will come back in chapter 4, where they turn into three reaction
  // components that statics cannot tell.
  //
  // ## One turn of the crank
  //
  // The lengths of crank, coupler, rocker and frame are $a = 0.5$, $b = 1.2$, $c = 0.75$ and
  // $d = 1.1$ m. Grashof's rule holds for them: shortest and longest link together, $0.5 + 1.2
  // = 1.7$ m, are not longer than the other two, $0.75 + 1.1 = 1.85$ m. The shortest link is then
  // the one that can turn all the way round beside its neighbours, and here it is the crank. It
  // turns once in a second, with 40 N pulling down at the middle of the coupler.

  //%%
  const double a = 0.5, b = 1.2, c = 0.75, d = 1.1;
  notebook.Check("Grashof: shortest and longest together are less than the other two",
                 a + b < c + d);

  const int poses = 360;
  const double speed = 2 * std::numbers::pi;  // [rad/s]
  const double start = mechanism.joints[0].start[0];

  LoadStudy study;
  study.mechanism = mechanism;
  study.drives = {{FindJoint(mechanism, "main"), 0, MotionLaw::Uniform(start, speed)}};
  for (int i = 0; i < poses; ++i) study.times.push_back(double(i) / poses);
  study.cycle = 1;
  ExternalLoad pull;
  pull.link = FindLink(mechanism, "coupler");
  pull.p_L = {b / 2, 0, 0};
  pull.at = {0};
  pull.wrenches = {{{0, -40, 0}, {0, 0, 0}}};
  study.external = {pull};

  const LoadStudyResult result = RunLoadStudy(study);
  notebook.Print(result.BriefReport());

  //%% [markdown]
  // The middle of the coupler draws the coupler curve:

  //%%
  plot::LinePlot curve;
  curve.title = "Path of the middle of the coupler";
  curve.x = {"x", "m"};
  curve.y = {"y", "m"};
  curve.width = 520;
  curve.height = 380;
  curve.series = {{"path", {}, {}}};
  for (int i = 0; i <= poses; ++i) {
    const PoseLoads& pose = result.poses[i % poses];
    const Vector3d point = pose.links[pull.link].X_WL * pull.p_L;
    curve.series[0].x.push_back(point.x());
    curve.series[0].y.push_back(point.y());
  }
  notebook.Show(curve);

  //%% [markdown]
  // Is it right? The four-bar has a closed form. With the crank at $\theta$ and the rocker at
  // $\psi$, Freudenstein's equation must hold at every pose:
  //
  // $$
  // \frac{d}{a} \cos\psi - \frac{d}{c} \cos\theta + \frac{a^2 - b^2 + c^2 + d^2}{2 a c}
  // = \cos(\theta - \psi)
  // $$

  //%%
  const int pivot = FindJoint(mechanism, "rocker_pivot");
  double residual = 0;
  for (const PoseLoads& pose : result.poses) {
    const double theta = pose.drives[0].position, psi = pose.joints[pivot].position[0];
    residual = std::max(
        residual, std::abs(d / a * std::cos(psi) - d / c * std::cos(theta) +
                           (a * a - b * b + c * c + d * d) / (2 * a * c) - std::cos(theta - psi)));
  }
  notebook.CheckNear("largest residual of Freudenstein's equation", residual, 0, 1e-10);

  //%% [markdown]
  // The rocker swings to and fro. How well the coupler drives it is told by the *transmission
  // angle*
  // $\mu$ between the two: the nearer to 90 degrees, the less of the coupler's force is wasted on
  // the rocker's pivot. Its extremes stand where crank and frame are in line,
  // $\cos\mu = (b^2 + c^2 - (d \pm a)^2) / (2 b c)$.

  //%%
  const int rocker_pin = FindJoint(mechanism, "rocker_pin");
  const double degrees = 180 / std::numbers::pi;
  plot::LinePlot angles;
  angles.title = "Rocker and transmission angle";
  angles.x = {"crank angle from its start", "°", plot::ScaleType::kDegrees};
  angles.y = {"angle", "°"};
  angles.series = {{"rocker", {}, {}}, {"transmission", {}, {}, plot::LineStyle::kDashed}};
  for (int i = 0; i < poses; ++i) {
    const PoseLoads& pose = result.poses[i];
    for (plot::Series& series : angles.series) series.x.push_back(360.0 * i / poses);
    angles.series[0].y.push_back(pose.joints[pivot].position[0] * degrees);
    angles.series[1].y.push_back(std::abs(pose.joints[rocker_pin].position[0]) * degrees);
  }
  notebook.Show(angles);

  const auto [least, greatest] =
      std::minmax_element(angles.series[1].y.begin(), angles.series[1].y.end());
  const double least_mu = std::acos((b * b + c * c - (d - a) * (d - a)) / (2 * b * c)) * degrees;
  const double greatest_mu = std::acos((b * b + c * c - (d + a) * (d + a)) / (2 * b * c)) * degrees;
  // The poses are a degree apart and begin at 30 degrees, so that they meet both extremes.
  notebook.CheckNear("least transmission angle [deg]", *least, least_mu, 1e-6);
  notebook.CheckNear("greatest transmission angle [deg]", *greatest, greatest_mu, 1e-6);

  //%% [markdown]
  // A transmission angle of 24 degrees is poor: the forces will show it.
  //
  // ## What the hinges carry

  //%%
  plot::LinePlot forces;
  forces.title = "Radial force at the four hinges";
  forces.x = angles.x;
  forces.y = {"force", "N"};
  plot::LinePlot torque;
  torque.title = "Torque of the motor";
  torque.x = angles.x;
  torque.y = {"torque", "N m"};
  torque.series = {{"torque", {}, {}}};
  torque.series[0].mark_peak = true;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    forces.series.push_back({mechanism.joints[j].name, {}, {}});
    for (int i = 0; i < poses; ++i) {
      const Vector3d& force = result.poses[i].joints[j].force;
      forces.series[j].x.push_back(360.0 * i / poses);
      forces.series[j].y.push_back(std::hypot(force.x(), force.y()));
    }
  }
  for (int i = 0; i < poses; ++i) {
    torque.series[0].x.push_back(360.0 * i / poses);
    torque.series[0].y.push_back(result.poses[i].drives[0].force);
  }
  notebook.Show(forces);
  notebook.Show(torque);

  //%% [markdown]
  // Three laws that these numbers cannot break. **Momentum**: the frame carries all that the links
  // weigh, and what their acceleration takes, whatever happens at the hinges between them,
  //
  // $$
  // F_\mathrm{main} + F_\mathrm{pivot} = \sum_i m_i (a_i - g) - F_\mathrm{pull}
  // $$
  //
  // with $a_i$ the acceleration of the centre of gravity.

  //%%
  const int main_joint = FindJoint(mechanism, "main");
  double worst = 0, largest = 0;
  for (const PoseLoads& pose : result.poses) {
    Vector3d needed = -pull.wrenches[0].force;
    for (size_t i = 0; i < mechanism.links.size(); ++i) {
      if (int(i) == mechanism.ground) continue;
      const MassProperties& body = mechanism.links[i].mass_properties;
      const LinkMotion& motion = pose.links[i];
      const Vector3d r = motion.X_WL.R * body.p_LoLcm;
      const Vector3d a_cm = motion.a + motion.alpha.cross(r) + motion.w.cross(motion.w.cross(r));
      needed += body.mass * (a_cm - mechanism.gravity_W);
    }
    const Vector3d carried = pose.joints[main_joint].force + pose.joints[pivot].force;
    worst = std::max(worst, (carried - needed).norm());
    largest = std::max(largest, needed.norm());
  }
  notebook.CheckNear("frame forces against momentum, relative", worst / largest, 0, 1e-9);

  //%% [markdown]
  // **Energy**: at every pose the power of the motor and of the pull goes into the motion of the
  // links, to the last digits. Nothing rubs, and a constant pull of 40 N is conservative, as weight
  // is: over a closed turn neither takes energy away. So the motor gets back over a turn what it
  // gave, and at constant speed its mean torque is zero.

  //%%
  double sum = 0, peak = 0;
  for (const PoseLoads& pose : result.poses) {
    sum += pose.drives[0].force;
    peak = std::max(peak, std::abs(pose.drives[0].force));
  }
  notebook.Print(fmt::format("peak torque {:.2f} N m", peak));
  notebook.CheckNear("power balance, relative", result.max_power_error, 0, 1e-9);
  notebook.CheckNear("mean torque of peak torque", sum / poses / peak, 0, 1e-9);

  //%% [markdown]
  // **Indifference**: no result may depend on where the loop is cut. The same study, cut at the
  // other hinges:

  //%%
  double change = 0;
  for (const char* cut : {"crank_pin", "rocker_pin", "rocker_pivot"}) {
    LoadStudy other = study;
    other.mechanism.preferred_cuts = {FindJoint(mechanism, cut)};
    const LoadStudyResult again = RunLoadStudy(other);
    notebook.Check(fmt::format("the loop is cut at {}", cut), again.cut_joints[0] == cut);
    for (int i = 0; i < poses; ++i) {
      for (size_t j = 0; j < mechanism.joints.size(); ++j) {
        change = std::max(change,
                          (again.poses[i].joints[j].Stacked() - result.poses[i].joints[j].Stacked())
                              .cwiseAbs()
                              .maxCoeff());
      }
    }
  }
  notebook.CheckNear("largest change of a wrench by another cut, of the largest force",
                     change / largest, 0, 1e-9);

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
