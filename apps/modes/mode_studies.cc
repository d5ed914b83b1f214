#include "vmech/apps/modes/mode_studies.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/files/writer.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr int kPoses = 60;
constexpr double kAmplitude = 0.1;  // [rad], or characteristic lengths

/// A freedom that a drive moves, with its place in the tree.
struct DrivenFreedom {
  FreedomId at;
  int q = -1, v = -1;
};

/// The independent freedoms; empty if one of them cannot be driven.
std::vector<DrivenFreedom> FreedomsToDrive(const Modes& modes) {
  std::vector<DrivenFreedom> driven;
  for (const std::string& name : modes.freedoms) {
    for (const TreeNode& node : modes.tree.nodes) {
      for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
        if (NameOfVelocity(modes.tree, node.v + k) != name) continue;
        if (node.motion == NodeMotion::kSpherical) return {};
        driven.push_back({{node.joint, node.freedom}, node.q, node.v});
      }
    }
  }
  return driven;
}

double PeriodOf(const Mode& mode) {
  return mode.frequency > 0 ? 1 / mode.frequency : 2;
}

std::string TableText(const Modes& modes, const Mode& mode, const DrivenFreedom& freedom) {
  std::string text = "t,value\n";
  const std::complex<double> entry = kAmplitude * mode.shape[freedom.v];
  for (int i = 0; i <= kPoses; ++i) {
    const double share = static_cast<double>(i) / kPoses;
    const std::complex<double> turned = std::polar(1.0, 2 * std::numbers::pi * share);
    text += fmt::format("{},{}\n", share * PeriodOf(mode),
                        modes.q[freedom.q] + (entry * turned).real());
  }
  return text;
}

std::string DriveEntry(const Mechanism& mechanism, const FreedomId& at) {
  const Joint& joint = mechanism.joints[static_cast<size_t>(at.joint)];
  std::string entry = fmt::format("  - {{joint: \"{}\"", joint.name);
  if (FreedomsOf(joint.type) > 1) {
    entry += fmt::format(", freedom: {}", NameOfFreedom(joint.type, at.freedom));
  }
  return entry;
}

std::vector<NamedText> StudyOf(const Modes& modes, size_t index, const Simulation& simulation,
                               const std::vector<DrivenFreedom>& driven) {
  const std::string name = fmt::format("mode-{}", index + 1);
  std::string study = fmt::format(
      "# The shape of mode {}, {} of a radian or of the characteristic length far.\n"
      "vmech_study: \"1.0\"\nname: {}\nmechanism: equilibrium.yaml\n"
      "units: {{length: m, angle: rad}}\nmotion:\n",
      index + 1, kAmplitude, name);
  std::vector<NamedText> files;
  for (size_t k = 0; k < driven.size(); ++k) {
    const std::string table = fmt::format("{}-{}.csv", name, k + 1);
    files.push_back({table, TableText(modes, modes.modes[index], driven[k])});
    study += DriveEntry(simulation.mechanism, driven[k].at);
    study += fmt::format(", table: {}{}}}\n", table,
                         k == 0 ? fmt::format(", repeats: true, steps: {}", kPoses) : "");
  }
  for (const JointDrive& drive : simulation.drives) {
    study += DriveEntry(simulation.mechanism, {drive.joint, drive.freedom}) + ", speed: 0}\n";
  }
  files.push_back({name + ".yaml", study});
  return files;
}

}  // namespace

std::vector<NamedText> ModeStudies(const Modes& modes, const Simulation& at_equilibrium) {
  WriterOptions options;
  options.comment = "At its static equilibrium.";
  std::vector<NamedText> files = {
      {"equilibrium.yaml", WriteMechanism(at_equilibrium.mechanism, options)}};
  const std::vector<DrivenFreedom> driven = FreedomsToDrive(modes);
  for (size_t i = 0; !driven.empty() && i < modes.modes.size(); ++i) {
    for (NamedText& file : StudyOf(modes, i, at_equilibrium, driven)) files.push_back(file);
  }
  return files;
}

}  // namespace vmech
