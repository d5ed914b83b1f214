//%% [markdown]
// # From CAD to joint loads
//
// A designer has solids, not inertia matrices, and places, not joint coordinates. This chapter
// takes the slider-crank of `mechanisms/cad/samples`, a STEP file as any CAD system writes it, and
// follows it to the bearing of its crankshaft. At every step something is known in closed form, and
// the numbers are held against it.

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
#include "vmech/mechanisms/cad/mechanism_from_cad.h"
#include "vmech/mechanisms/cad/step/step_reader.h"

using namespace vmech;

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);
  constexpr double kPi = std::numbers::pi;

  //%% [markdown]
  // ## What the file holds
  //
  // Parts with their solids, groups of parts, and coordinate systems with names. No masses: a STEP
  // file knows volumes. No joints either.

  //%%
  const CadAssembly assembly = ReadStep("mechanisms/cad/samples/slider-crank.step");
  html::Table parts;
  parts.columns = {{"Part"}, {"in"}, {"volume [mm³]"}, {"shafts and bores [mm]"}};
  for (const CadPart& part : assembly.parts) {
    const CadShape& shape = assembly.shapes[part.shape];
    std::string fits;
    for (const CadFeature& feature : shape.features) {
      if (feature.length == 0) continue;
      fits += fmt::format("{} {:.6g}  ", feature.surface == CadSurface::kBore ? "bore" : "shaft",
                          2e3 * feature.radius);
    }
    parts.rows.push_back({part.name, assembly.groups[part.group].name,
                          fmt::format("{:.1f}", 1e9 * shape.volume.volume), fits});
  }
  notebook.Show(parts);

  //%% [markdown]
  // ## Mass properties
  //
  // Mass, centre of gravity and inertia are integrals over the solids, times a density $\rho$:
  //
  // $$
  // m = \rho \int dV, \qquad c = \frac{\rho}{m} \int r \, dV, \qquad
  // I = \rho \int \left( r^T r \, 1 - r r^T \right) dV
  // $$
  //
  // Everything here is steel save the piston, which is aluminium. The crankshaft is a journal of 20
  // mm, a web, and a pin of 17 mm, 50 mm off the axis: two cylinders and a box, so that we know
  // what its moment of inertia about the main axis must be.

  //%%
  CadImportOptions options;
  options.gravity_W = Vector3d(0, -9.81, 0);
  options.densities.fallback = DensityFromText("steel");
  options.densities.by_name = {{"piston-body", DensityFromText("aluminium")}};
  const CadImport import = MechanismFromCad(assembly, options);
  const Mechanism& mechanism = import.mechanism;
  notebook.Print(import.FullReport());

  //%%
  const Link& crank = mechanism.links[FindLink(mechanism, "crank")];
  const Link& piston = mechanism.links[FindLink(mechanism, "piston")];
  const double rho = 7850;
  const double journal = rho * kPi * 0.010 * 0.010 * 0.040;
  const double web = rho * 0.080 * 0.030 * 0.010;
  const double pin = rho * kPi * 0.0085 * 0.0085 * 0.020;
  const double about_axis = journal * 0.010 * 0.010 / 2 +
                            web * ((0.080 * 0.080 + 0.030 * 0.030) / 12 + 0.025 * 0.025) +
                            pin * (0.0085 * 0.0085 / 2 + 0.050 * 0.050);
  const MassProperties& properties = crank.mass_properties;
  const double imported_about_axis =
      properties.I_Lcm(2, 2) +
      properties.mass * properties.p_LoLcm.head<2>().squaredNorm();  // Huygens and Steiner
  notebook.CheckNear("mass of the crank over its closed form",
                     properties.mass / (journal + web + pin), 1, 1e-9);
  notebook.CheckNear("moment of inertia about the main axis over its closed form",
                     imported_about_axis / about_axis, 1, 1e-9);

  //%% [markdown]
  // ## Joints, by name and by geometry
  //
  // Two parts that both carry a frame `anchor_pin` are joined there. Four pairs of frames name the
  // four joints in this way, and the name `anchor_guide__prismatic` says that the piston slides.
  //
  // The solids tell the same story. A shaft that sits in a bore with the axis $a$ keeps some of the
  // relative twist $[v; \omega]$ of the two parts at zero, $v$ being the velocity of a point on
  // that axis,
  //
  // $$
  // v \times a = 0, \qquad \omega \times a = 0,
  // $$
  //
  // and so does a plane with the normal $n$ on another: $v \cdot n = 0$ and $\omega \times n = 0$.
  // What all contacts of two parts leave free is a vector space of twists, and its shape is the
  // joint: a line of rotations a revolute one, a line of translations a prismatic one, and so on.
  // Without a single name:

  //%%
  CadAssembly nameless = assembly;
  nameless.frames.clear();
  CadImportOptions by_geometry = options;
  by_geometry.bodies.rigid = {"frame", "crank", "rod", "piston"};
  by_geometry.propose = true;
  const CadImport found = MechanismFromCad(nameless, by_geometry);
  html::Table joints;
  joints.columns = {{"Joint"}, {"type"}, {"because"}};
  for (const ImportedJoint& joint : found.joints) {
    const Joint& made = found.mechanism.joints[joint.joint];
    joints.rows.push_back({made.name, std::string(NameOf(made.type)), joint.why});
  }
  notebook.Show(joints);
  const auto type_of = [&](const char* name) {
    return found.mechanism.joints[FindJoint(found.mechanism, name)].type;
  };
  notebook.Check("journal, shoulder: the crank turns in the frame",
                 type_of("frame-crank") == JointType::kRevolute);
  notebook.Check("no shoulder holds the piston in the liner: it could turn there, too",
                 type_of("frame-piston") == JointType::kCylindrical);

  //%% [markdown]
  // ## Loads
  //
  // From here on nothing knows of CAD. The crank turns at 1500 rpm, and the only force on the
  // piston along its slide is that of the rod, so that Newton gives it in closed form. With the
  // crank $r$, the rod $l$ and the crank angle $\theta$ from the slide,
  //
  // $$
  // x = r \cos\theta + \sqrt{l^2 - r^2 \sin^2\theta}, \qquad
  // F_x = m_\mathrm{piston} \, \ddot{x}
  // $$

  //%%
  const int main_joint = FindJoint(mechanism, "main"), wrist = FindJoint(mechanism, "wrist");
  const double speed = 50 * kPi, start = mechanism.joints[main_joint].start[0];
  const int poses = 360;
  LoadStudy study;
  study.mechanism = mechanism;
  study.drives = {{main_joint, 0, MotionLaw::Uniform(start, speed)}};
  for (int i = 0; i < poses; ++i) study.times.push_back(2 * kPi / speed * i / poses);
  study.cycle = 2 * kPi / speed;
  const LoadStudyResult loads = RunLoadStudy(study);

  const double r = 0.050, l = 0.150, mass = piston.mass_properties.mass;
  plot::LinePlot force;
  force.title = "Force of the rod on the piston, along its slide";
  force.x = {"crank angle", "°", plot::ScaleType::kDegrees};
  force.y = {"force", "N"};
  force.series = {{"closed form", {}, {}}, {"from the STEP file", {}, {}}};
  force.series[1].line = plot::LineStyle::kDashed;
  double worst = 0, largest = 0;
  for (int i = 0; i < poses; ++i) {
    const double theta = start + speed * study.times[i];
    const double s = std::sin(theta), c = std::cos(theta);
    const double root = std::sqrt(l * l - r * r * s * s);
    // d^2/dt^2 of the root: -(r^2 (c^2 - s^2) + (r^2 s c)^2 / root^2) / root, times speed^2.
    const double acceleration =
        speed * speed *
        (-r * c - (r * r * (c * c - s * s) + std::pow(r * r * s * c / root, 2)) / root);
    const double closed_form = mass * acceleration;
    // The joint's axes are those of the rod, which leans by -asin(r s / l).
    const Vector3d& rod = loads.poses[i].joints[wrist].force;
    const double computed = rod.x() * root / l + rod.y() * r * s / l;
    for (plot::Series& series : force.series) series.x.push_back(360.0 * i / poses);
    force.series[0].y.push_back(closed_form);
    force.series[1].y.push_back(computed);
    worst = std::max(worst, std::abs(computed - closed_form));
    largest = std::max(largest, std::abs(closed_form));
  }
  notebook.Show(force);
  notebook.CheckNear("largest difference, of the largest force", worst / largest, 0, 1e-8);

  //%% [markdown]
  // ## A bearing for the shaft that is drawn
  //
  // The import also knows what sits in the main bearing: a shaft of 20 mm. That is the bore to look
  // for in the catalogue. The crank overhangs, so that one bearing would have to take a tilting
  // moment: there are two, 30 mm apart, in the housing block.

  //%%
  const JointSeat& seat = import.joints[0].seat;
  notebook.CheckNear("diameter of the main shaft [mm]", 1e3 * seat.shaft_diameter, 20, 1e-6);
  BearingRequirements requirements;
  requirements.shaft_min = requirements.shaft_max = std::round(1e6 * seat.shaft_diameter) / 1e6;
  requirements.life_hours = 5000;
  DutyCycle cycle;
  cycle.duration = DurationsFromTimes(study.times);
  for (const PoseLoads& pose : loads.poses) {
    cycle.angle.push_back(pose.drives[0].position);
    cycle.speed.push_back(pose.drives[0].velocity);
    cycle.wrench.push_back(pose.joints[main_joint]);
  }
  const JointBearings chosen =
      SelectJointBearings(cycle, Arrangement{{-0.015, 0.015}, 0}, requirements,
                          LoadCertainty::kDependsOnRule, BuiltInCatalogue());
  notebook.Print(chosen.BriefReport());
  notebook.Check("both positions are filled", chosen.complete());

  //%% [markdown]
  // On the command line all of this is two commands. The first one writes a mechanism and a study,
  //
  // ```
  // vmech import mechanisms/cad/samples/slider-crank.step --study study.yaml --rpm 1500
  // ```
  //
  // and the second one computes the loads and chooses the bearings:
  //
  // ```
  // vmech loads study.yaml
  // ```

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
