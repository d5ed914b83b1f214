#include "vmech/mechanisms/files/read_dh.h"

#include <algorithm>

#include "vmech/mechanisms/dh/dh_parameters.h"

namespace vmech {
namespace {

Posed ReadDhRow(const Node& node, const Units& units) {
  if (!node.CheckKeys({}, {"theta", "d", "a", "alpha", "beta"})) return {};
  return PoseOf({node["theta"].Number(units.angle), node["d"].Number(units.length),
                 node["a"].Number(units.length), node["alpha"].Number(units.angle),
                 node["beta"].Number(units.angle)});
}

/// The link that an end of a joint names; null if it names an anchor, or nothing that there is.
Link* NamedLink(const Node& end, std::vector<Link>* links) {
  if (end.kind() != Node::Kind::kScalar) return nullptr;
  const auto found = std::find_if(links->begin(), links->end(),
                                  [&](const Link& link) { return link.name == end.Text(); });
  return found == links->end() ? nullptr : &*found;
}

void AddAnchor(const Node& joint, const Posed& X_LA, Link* link) {
  for (const Anchor& anchor : link->anchors) {
    if (anchor.name != joint.key()) continue;
    joint.KeyError("link " + Quoted(link->name) + " has an anchor of the joint's name, which " +
                   "'dh' needs; give that anchor another name");
    return;
  }
  link->anchors.push_back({joint.key(), X_LA});
}

}  // namespace

Posed ReadDhRows(const Node& node, const Units& units) {
  if (node.kind() != Node::Kind::kList) return ReadDhRow(node, units);
  Posed X;
  for (const Node& row : node.List()) X = X * ReadDhRow(row, units);
  return X;
}

void AddDhAnchors(const Node& joints, const Units& units, std::vector<Link>* links) {
  if (joints.kind() != Node::Kind::kMap) return;
  for (const Node& joint : joints.Map()) {
    const Node row = joint.kind() == Node::Kind::kMap ? joint["dh"] : Node();
    if (!row) continue;
    const Posed X_ML = ReadDhRows(row, units);
    const Node connects = joint["connects"];
    if (connects.kind() != Node::Kind::kList || connects.List().size() != 2) continue;
    const std::vector<Node> ends = connects.List();
    Link *first = NamedLink(ends[0], links), *second = NamedLink(ends[1], links);
    if (first != nullptr) AddAnchor(joint, {}, first);
    if (second != nullptr && second != first) AddAnchor(joint, X_ML.inverse(), second);
  }
}

}  // namespace vmech
