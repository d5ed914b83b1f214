#include <fmt/format.h>

#include "vmech/mechanisms/exchange/urdf/urdf.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/read_joint.h"
#include "vmech/mechanisms/files/read_link.h"
#include "vmech/mechanisms/files/units.h"

namespace vmech {
namespace {

constexpr const char* kLoopsFormat = "1.0";

void AddAnchors(const Node& entry, const Units& units, Mechanism* mechanism) {
  const int link = FindLink(*mechanism, entry.key());
  if (link < 0) {
    std::vector<std::string> names;
    for (const Link& each : mechanism->links) names.push_back(each.name);
    entry.KeyError(
        fmt::format("link {} not found{}", Quoted(entry.key()), DidYouMean(entry.key(), names)));
    return;
  }
  if (!entry.CheckKeys({"anchors"})) return;
  for (const Node& anchor : entry["anchors"].Map()) {
    anchor.CheckName();
    std::vector<Anchor>& anchors = mechanism->links[link].anchors;
    for (const Anchor& there : anchors) {
      if (there.name == anchor.key()) anchor.KeyError("the link has an anchor of this name");
    }
    Posed X_LA;
    if (anchor.CheckKeys({}, {"origin", "z", "x", "y", "dh"})) X_LA = ReadFrame(anchor, units);
    anchors.push_back({anchor.key(), X_LA});
  }
}

}  // namespace

void AddLoops(const std::filesystem::path& path, Mechanism* mechanism) {
  Document document(ReadTextFile(path), path.string());
  const Node root = document.root();
  if (root.CheckKeys({"vmech_loops", "loops"}, {"links", "units", "description"})) {
    if (root["vmech_loops"].Text() != kLoopsFormat) {
      root["vmech_loops"].Error(fmt::format("only format \"{}\" can be read", kLoopsFormat));
    }
    const Units units = ReadUnits(root["units"]);
    for (const Node& entry : root["links"].Map()) AddAnchors(entry, units, mechanism);
    const AnchorNames anchors(mechanism->links);
    for (const Node& entry : root["loops"].Map()) {
      if (FindJoint(*mechanism, entry.key()) >= 0) entry.KeyError("there is a joint of this name");
      mechanism->joints.push_back(ReadJoint(entry, anchors, units));
    }
  }
  document.ThrowErrors();
}

}  // namespace vmech
