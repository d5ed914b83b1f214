#include "vmech/apps/mechanism/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "vmech/apps/mechanism/dh_text.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/plausibility.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

std::string Count(size_t number, std::string_view what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

std::string JointEnds(const Mechanism& m, const Joint& joint) {
  auto end = [&](AnchorId id) { return m.links[id.link].name + "/" + m.anchor(id).name; };
  return end(joint.first) + " - " + end(joint.second);
}

std::vector<std::string> LoopJoints(const KinematicTree& tree, const Loop& loop) {
  std::vector<std::string> names;
  for (const LoopNode& n : loop.path) {
    const TreeNode& node = tree.nodes[n.node];
    if (tree.placements[node.joint].tree_node == n.node) {
      names.push_back(tree.mechanism.joints[node.joint].name);
    }
  }
  return names;
}

/// The nodes of a joint, which are neighbours; none if it is cut.
std::span<const TreeNode> ChainOf(const KinematicTree& tree, int joint) {
  const int last = tree.placements[joint].tree_node;
  int first = last;
  while (first > 0 && tree.nodes[first - 1].joint == joint) --first;
  return last < 0 ? std::span<const TreeNode>()
                  : std::span(tree.nodes).subspan(first, last - first + 1);
}

/// Coordinates of the tree joints in the assembled pose, in degrees and millimetres.
std::string Position(const KinematicTree& tree, const VectorXd& q, int joint) {
  std::string text;
  for (const TreeNode& node : ChainOf(tree, joint)) {
    if (node.q < 0) continue;
    if (!text.empty()) text += ", ";
    const JointType type = tree.mechanism.joints[joint].type;
    if (FreedomsOf(type) > 1 && node.motion != NodeMotion::kSpherical) {
      text += NameOfFreedom(type, node.freedom) + " ";
    }
    if (node.motion == NodeMotion::kPrismatic) {
      text += fmt::format("{:.6g} mm", 1000 * q[node.q]);
    } else if (node.motion == NodeMotion::kSpherical) {
      text += fmt::format("quaternion {:.4f} {:.4f} {:.4f} {:.4f}", q[node.q], q[node.q + 1],
                          q[node.q + 2], q[node.q + 3]);
    } else {
      text += fmt::format("{:.6g} deg", q[node.q] * 180 / std::numbers::pi);
    }
  }
  return text.empty() ? (tree.placements[joint].tree_node < 0 ? "cut" : "-") : text;
}

constexpr size_t kNameWidth = 17;  // of the column of names, where none is longer

std::string LinkLines(const Mechanism& m) {
  double mass = 0;
  size_t width = kNameWidth;
  for (const Link& link : m.links) {
    mass += link.mass_properties.mass;
    width = std::max(width, link.name.size());
  }
  std::string text = fmt::format("links       {}, {:.6g} kg in all, ground '{}'\n", m.links.size(),
                                 mass, m.links[m.ground].name);
  for (const Link& link : m.links) {
    text += fmt::format("  {:<{}} {:>10.4g} kg   {}\n", link.name, width, link.mass_properties.mass,
                        Count(link.anchors.size(), "anchor"));
  }
  return text;
}

std::string JointLines(const MechanismCheck& check) {
  const Mechanism& m = check.tree.mechanism;
  size_t width = kNameWidth, ends = 0;
  for (const Joint& joint : m.joints) {
    width = std::max(width, joint.name.size());
    ends = std::max(ends, JointEnds(m, joint).size());
  }
  std::string text = fmt::format("joints      {}\n", m.joints.size());
  for (size_t j = 0; j < m.joints.size(); ++j) {
    const Joint& joint = m.joints[j];
    text += fmt::format("  {:<{}} {:<11}  {:<{}}  {}\n", joint.name, width, NameOf(joint.type),
                        JointEnds(m, joint), ends,
                        Position(check.tree, check.mobility.q_general, static_cast<int>(j)));
  }
  return text;
}

std::string LoopLines(const KinematicTree& tree) {
  const std::vector<Joint>& joints = tree.mechanism.joints;
  size_t width = 10;
  for (const Loop& loop : tree.loops) width = std::max(width, joints[loop.joint].name.size());
  std::string text = fmt::format("loops       {}\n", tree.loops.size());
  for (const Loop& loop : tree.loops) {
    text += fmt::format("  cut at {:<{}} {}, through {}\n", joints[loop.joint].name, width,
                        Count(static_cast<size_t>(loop.rows), "equation"),
                        fmt::join(LoopJoints(tree, loop), ", "));
  }
  return text;
}

std::string MobilityWords(const MechanismCheck& check) {
  const Mobility& m = check.mobility;
  const size_t redundant = static_cast<size_t>(m.redundant);
  std::string text =
      fmt::format("mobility    {}   (Gruebler's count {}{})\n", m.mobility, m.gruebler,
                  redundant > 0 ? " + " + Count(redundant, "redundant equation") : "");
  if (!check.tree.loops.empty()) {
    text += fmt::format("equations   {} of the loops, rank {}\n", check.tree.rows, m.rank);
  }
  if (m.singular_here) {
    text += "            the assembled pose is singular (a dead centre); rank judged beside it\n";
  }
  std::vector<std::string> still;
  for (size_t j = 0; j < m.joint_moves.size(); ++j) {
    const Joint& joint = check.tree.mechanism.joints[j];
    if (!m.joint_moves[j] && joint.type != JointType::kWeld) still.push_back(joint.name);
  }
  if (!still.empty()) text += fmt::format("locked      {}\n", fmt::join(still, ", "));
  return text;
}

/// The table as it is: SI, every digit.
Json DhJson(const Mechanism& m, const DhTable& table) {
  constexpr std::string_view kMotions[] = {"fixed", "rotation", "translation", "screw"};
  Json rows = Json::array();
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const DhRow& row = table.rows[i];
    Json entry{{"z_along", row.axis}, {"from", row.from < 0 ? Json() : Json(row.from)}};
    if (row.link >= 0) entry["link"] = m.links[row.link].name;
    entry["link_frame"] = row.link >= 0 && table.row_of_link[row.link] == static_cast<int>(i);
    entry["motion"] = kMotions[static_cast<int>(row.motion)];
    if (row.joint >= 0) entry["joint"] = m.joints[row.joint].name;
    if (row.joint >= 0) {
      entry["freedom"] = NameOfFreedom(m.joints[row.joint].type, row.freedom);
    }
    if (row.motion == DhMotion::kScrew) entry["pitch"] = row.pitch;
    const DhParameters& p = row.parameters;
    entry.update({{"theta", p.theta}, {"d", p.d}, {"a", p.a}, {"alpha", p.alpha}});
    entry.update({{"beta", p.beta}, {"gamma", row.gamma}, {"b", row.b}});
    entry["axes"] = NameOf(row.relation);
    rows.push_back(entry);
  }
  return rows;
}

}  // namespace

MechanismCheck CheckMechanism(const Mechanism& mechanism) {
  MechanismCheck check;
  check.assembled = AssembleMechanism(mechanism);
  check.tree = BuildKinematicTree(check.assembled.mechanism);
  check.doubts = DoubtsOf(mechanism);
  check.dh = DeduceDhTable(check.tree.mechanism, check.tree.spanning);
  const VectorXd q = StartCoordinates(check.tree);
  check.mobility.q_general = q;
  if (!check.closed()) return check;
  check.mobility = AnalyseMobility(check.tree, q);
  check.mobility.q_general = q;
  return check;
}

std::string TextReport(const MechanismCheck& check, bool dh) {
  const Mechanism& m = check.tree.mechanism;
  std::string text = fmt::format("{}\n\n", m.name) + LinkLines(m) + JointLines(check);
  text += LoopLines(check.tree);
  if (!check.closed()) return text + "\nNOT ASSEMBLED: " + check.assembled.summary.message + "\n";
  text += MobilityWords(check);
  if (!check.tree.loops.empty()) {
    text += fmt::format(
        "closure     {:.2g} of the length {:.4g} m, assembled from {:.2g} as the file has it\n",
        check.assembled.summary.error, check.tree.length, check.assembled.summary.start_error);
  }
  for (const std::string& doubt : check.doubts) text += fmt::format("warning     {}\n", doubt);
  for (const std::string& note : check.assembled.Notes()) {
    text += fmt::format("note        {}\n", note);
  }
  for (const Grasp& grasp : m.grasps) {
    text += fmt::format("grasp       {} on {}, {}\n", grasp.name, m.links[grasp.link].name,
                        grasp.kind == GraspKind::kRigid ? "rigid" : "point");
  }
  return dh ? text + "\n" + DhText(m, check.dh) : text;
}

std::string JsonReport(const MechanismCheck& check, bool dh) {
  const Mechanism& m = check.tree.mechanism;
  Json json{{"mechanism", m.name}, {"ground", m.links[m.ground].name}};
  for (const Link& link : m.links) {
    json["links"].push_back({{"name", link.name}, {"mass", link.mass_properties.mass}});
  }
  for (size_t j = 0; j < m.joints.size(); ++j) {
    const Joint& joint = m.joints[j];
    Json entry{{"name", joint.name},
               {"type", NameOf(joint.type)},
               {"cut", check.tree.placements[j].tree_node < 0}};
    if (check.closed()) entry["moves"] = static_cast<bool>(check.mobility.joint_moves[j]);
    json["joints"].push_back(entry);
  }
  json["loops"] = Json::array();
  for (const Loop& loop : check.tree.loops) {
    json["loops"].push_back({{"cut", m.joints[loop.joint].name},
                             {"equations", loop.rows},
                             {"through", LoopJoints(check.tree, loop)}});
  }
  json["assembled"] = check.closed();
  json["closure_error"] = check.assembled.summary.error;
  json["start_error"] = check.assembled.summary.start_error;
  json["rounding"] = check.assembled.correction;
  json["tolerance"] = m.tolerance;
  json["warnings"] = check.doubts;
  json["characteristic_length"] = check.tree.length;
  if (!check.closed()) {
    json["message"] = check.assembled.summary.message;
  } else {
    json["mobility"] = check.mobility.mobility;
    json["gruebler"] = check.mobility.gruebler;
    json["rank"] = check.mobility.rank;
    json["redundant_equations"] = check.mobility.redundant;
    json["singular_start"] = check.mobility.singular_here;
    json["notes"] = check.assembled.Notes();
  }
  if (dh) json["denavit_hartenberg"] = DhJson(m, check.dh);
  return json.dump(2) + "\n";
}

}  // namespace vmech
