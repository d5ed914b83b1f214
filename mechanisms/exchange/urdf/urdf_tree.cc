#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "vmech/mechanisms/exchange/urdf/urdf_robot.h"
#include "vmech/mechanisms/exchange/xml/xml_document.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

using Index = std::unordered_map<std::string, int>;

Index LinkIndex(const UrdfRobot& robot) {
  Index index;
  for (const UrdfLink& link : robot.links) index.emplace(link.name, index.size());
  return index;
}

/// Joints between links that there are, each with another link, and no link carried by two.
void RequireEnds(const UrdfRobot& robot, const Index& index, XmlErrors* errors) {
  std::vector<std::string> names;
  for (const UrdfLink& link : robot.links) names.push_back(link.name);
  std::unordered_map<std::string, const UrdfJoint*> carriers;
  for (const UrdfJoint& joint : robot.joints) {
    if (errors->full()) return;
    for (const std::string& end : {joint.parent, joint.child}) {
      if (index.contains(end)) continue;
      errors->Add(joint.line, fmt::format("joint {}: there is no link {}{}", Quoted(joint.name),
                                          Quoted(end), DidYouMean(end, names)));
    }
    if (joint.parent == joint.child) {
      errors->Add(joint.line, fmt::format("joint {} joins link {} with itself", Quoted(joint.name),
                                          Quoted(joint.child)));
    }
    const auto [entry, first] = carriers.emplace(joint.child, &joint);
    if (first) continue;
    errors->Add(joint.line,
                fmt::format("link {} is the child of two joints, {} and {} (line {}), and URDF is "
                            "a tree: take one out and close the loop in a side file (--loops)",
                            Quoted(joint.child), Quoted(joint.name), Quoted(entry->second->name),
                            entry->second->line));
  }
}

/// The way up from a link until one comes again: "a -> b -> a (joints 'j', 'k')".
std::string CycleText(const UrdfRobot& robot, const Index& index, const std::vector<int>& parents,
                      int link) {
  constexpr size_t kMostNames = 8;
  std::vector<std::string> links, joints;
  int at = link;
  do {
    const UrdfJoint& joint = robot.joints[parents[at]];
    links.push_back(robot.links[at].name);
    joints.push_back(Quoted(joint.name));
    at = index.at(joint.parent);
  } while (at != link);
  links.push_back(robot.links[link].name);
  std::reverse(links.begin(), links.end());  // from parents to children
  std::reverse(joints.begin(), joints.end());
  if (joints.size() > kMostNames) {
    links.resize(kMostNames);
    joints.resize(kMostNames);
    links.push_back("...");
    joints.push_back("...");
  }
  return fmt::format("{} (joints {})", fmt::join(links, " -> "), fmt::join(joints, ", "));
}

/// Every link leads up to a root. `state`: 0 not seen, 1 on the way up at hand, 2 leads to a root.
void RequireNoCycle(const UrdfRobot& robot, const Index& index, const std::vector<int>& parents,
                    XmlErrors* errors) {
  std::vector<int> state(robot.links.size(), 0);
  for (size_t start = 0; start < state.size(); ++start) {
    std::vector<int> way;
    int at = static_cast<int>(start);
    while (at >= 0 && state[at] == 0) {
      state[at] = 1;
      way.push_back(at);
      at = parents[at] < 0 ? -1 : index.at(robot.joints[parents[at]].parent);
    }
    if (at >= 0 && state[at] == 1) {
      errors->Add(robot.joints[parents[at]].line,
                  fmt::format("the links go round in a circle, {}, and URDF is a tree: take one "
                              "joint out and close the loop in a side file (--loops)",
                              CycleText(robot, index, parents, at)));
    }
    for (const int link : way) state[link] = 2;
  }
}

void RequireOneRoot(const UrdfRobot& robot, const std::vector<int>& parents, XmlErrors* errors) {
  int root = -1;
  for (size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] >= 0) continue;
    if (root >= 0) {
      errors->Add(robot.links[i].line,
                  fmt::format("no joint leads to link {}, nor to {}: there must be one root only; "
                              "join them",
                              Quoted(robot.links[i].name), Quoted(robot.links[root].name)));
    }
    root = root < 0 ? static_cast<int>(i) : root;
  }
}

}  // namespace

std::vector<int> ParentJoints(const UrdfRobot& robot) {
  const Index index = LinkIndex(robot);
  std::vector<int> parents(robot.links.size(), -1);
  for (size_t j = 0; j < robot.joints.size(); ++j) {
    parents[index.at(robot.joints[j].child)] = static_cast<int>(j);
  }
  return parents;
}

std::vector<int> LinksFromRoot(const UrdfRobot& robot, const std::string& file) {
  const Index index = LinkIndex(robot);
  XmlErrors errors(file);
  RequireEnds(robot, index, &errors);
  errors.Throw();  // what follows takes indices for granted
  const std::vector<int> parents = ParentJoints(robot);
  RequireNoCycle(robot, index, parents, &errors);
  RequireOneRoot(robot, parents, &errors);
  errors.Throw();

  std::vector<std::vector<int>> children(robot.links.size());
  for (const UrdfJoint& joint : robot.joints) {
    children[index.at(joint.parent)].push_back(index.at(joint.child));
  }
  std::vector<int> order, waiting;
  waiting.push_back(
      static_cast<int>(std::find(parents.begin(), parents.end(), -1) - parents.begin()));
  while (!waiting.empty()) {
    const int link = waiting.back();
    waiting.pop_back();
    order.push_back(link);
    waiting.insert(waiting.end(), children[link].rbegin(), children[link].rend());
  }
  return order;
}

}  // namespace vmech
