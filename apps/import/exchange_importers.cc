#include <fmt/format.h>

#include <algorithm>

#include "vmech/apps/import/importers.h"
#include "vmech/mechanisms/exchange/proposed_grasps.h"
#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/exchange/urdf/urdf.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

std::string LinkLine(const Mechanism& mechanism, int index, size_t width) {
  const Link& link = mechanism.links[index];
  const MassProperties& properties = link.mass_properties;
  if (index == mechanism.ground) return fmt::format("  {:<{}} ground\n", link.name, width);
  const Vector3d p = 1e3 * properties.p_LoLcm;
  const Vector3d moments = 1e6 * PrincipalMoments(properties.I_Lcm);
  return fmt::format(
      "  {:<{}} {:.6g} kg, centre of gravity [{:.4g}, {:.4g}, {:.4g}] mm, principal inertia "
      "[{:.4g}, {:.4g}, {:.4g}] kg mm^2\n",
      link.name, width, properties.mass, p[0], p[1], p[2], moments[0], moments[1], moments[2]);
}

template <typename Parts>
size_t WidestName(const Parts& parts) {
  size_t width = 12;
  for (const auto& part : parts) width = std::max(width, part.name.size());
  return width;
}

/// Bodies with their masses, joints, and the notes.
std::string ImportReport(const std::filesystem::path& file, const ImportedMechanism& imported) {
  const Mechanism& mechanism = imported.mechanism;
  std::string text = fmt::format("{}: {}\n\nlinks       {}\n", file.filename().string(),
                                 mechanism.name, mechanism.links.size());
  const size_t width = WidestName(mechanism.links);
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    text += LinkLine(mechanism, static_cast<int>(i), width);
  }
  text += fmt::format("joints      {}\n", mechanism.joints.size());
  const size_t joint_width = WidestName(mechanism.joints);
  for (const Joint& joint : mechanism.joints) {
    text += fmt::format("  {:<{}} {:<11}  {} - {}\n", joint.name, joint_width, NameOf(joint.type),
                        mechanism.links[joint.first.link].name,
                        mechanism.links[joint.second.link].name);
  }
  for (const Grasp& grasp : mechanism.grasps) {
    text += fmt::format("grasp       {} on {}\n", grasp.name, mechanism.links[grasp.link].name);
  }
  const Vector3d& g = mechanism.gravity_W;
  text += fmt::format("gravity     [{:.6g}, {:.6g}, {:.6g}] m/s^2\n", g[0], g[1], g[2]);
  for (const std::string& note : imported.notes) text += fmt::format("note        {}\n", note);
  return text;
}

ImportOptions OptionsOf(const ImportArguments& arguments) {
  return {arguments.cad.ground, arguments.cad.gravity_W, arguments.model, arguments.strict};
}

void AddGrasps(const ImportArguments& arguments, Mechanism* mechanism) {
  std::vector<std::string> names;
  for (const Link& link : mechanism->links) names.push_back(link.name);
  for (const std::string& name : arguments.grasps) {
    const int link = FindLink(*mechanism, name);
    if (link < 0) {
      throw FileErrors(arguments.file.string(),
                       fmt::format("there is no link {} for a grasp (--grasp){}", Quoted(name),
                                   DidYouMean(name, names)));
    }
    AddGraspAt(link, mechanism);
  }
}

/// At the frames that are at the ends of chains, if neither the file nor the user names any.
void ProposeGrasps(const ImportArguments& arguments, ImportedMechanism* imported) {
  if (!arguments.grasps.empty() || !imported->mechanism.grasps.empty()) return;
  std::vector<std::string> names;
  for (const int link : LeafLinks(imported->mechanism)) {
    AddGraspAt(link, &imported->mechanism);
    names.push_back(imported->mechanism.links[link].name);
  }
  if (names.empty()) return;
  imported->notes.push_back(
      fmt::format("proposed grasps, at the ends of chains: {} (--grasp names "
                  "others)",
                  fmt::join(names, ", ")));
}

ImportedFile Finished(const ImportArguments& arguments, ImportedMechanism imported) {
  ProposeGrasps(arguments, &imported);
  AddGrasps(arguments, &imported.mechanism);
  return {imported.mechanism, ImportReport(arguments.file, imported), {}, {}, {}};
}

}  // namespace

ImportedFile ImportSdf(const ImportArguments& arguments) {
  return Finished(arguments, ReadSdf(arguments.file, OptionsOf(arguments)));
}

ImportedFile ImportUrdf(const ImportArguments& arguments) {
  ImportedMechanism imported = ReadUrdf(arguments.file, OptionsOf(arguments));
  const size_t joints = imported.mechanism.joints.size();
  if (!arguments.loops.empty()) {
    AddLoops(arguments.loops, &imported.mechanism);
    imported.notes.push_back(fmt::format("{} of the joints come from {}",
                                         imported.mechanism.joints.size() - joints,
                                         arguments.loops.string()));
  }
  return Finished(arguments, std::move(imported));
}

}  // namespace vmech
