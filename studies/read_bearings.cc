#include "vmech/studies/read_bearings.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace vmech {
namespace {

Arrangement ReadArrangement(const Node& node, const Units& units) {
  Arrangement arrangement;
  if (const Node positions = node["positions"]) {
    arrangement.positions.clear();
    for (const Node& entry : positions.List()) {
      arrangement.positions.push_back(entry.Number(units.length));
    }
    if (arrangement.positions.empty()) positions.Error("a joint has one or two bearings");
  }
  arrangement.locating = node["locating"].Integer(0, 0, 1);
  return arrangement;
}

BearingRequirements ReadRequirements(const Node& node, const Units& units) {
  BearingRequirements asked;
  if (const std::vector<double> shaft =
          node["shaft"].Numbers(std::array{units.length, units.length});
      !shaft.empty()) {
    asked.shaft_min = shaft[0];
    asked.shaft_max = shaft[1];
  }
  if (const Node housing = node["housing"]) asked.housing_max = housing.Positive(units.length);
  asked.life_hours = node["life_hours"].NonNegative(asked.life_hours);
  if (const Node pair = node["pair_life_hours"]) asked.pair_life_hours = pair.NonNegative();
  asked.reliability = node["reliability"].Positive(asked.reliability);
  asked.static_safety = node["static_safety"].Positive(asked.static_safety);
  asked.lubrication = node["lubrication"].Word<Lubrication>(
      {{"grease", Lubrication::kGrease}, {"oil", Lubrication::kOil}}, asked.lubrication);
  return asked;
}

}  // namespace

BearingRequest ReadBearings(const Node& node, const Units& units, const Mechanism& mechanism) {
  BearingRequest request;
  std::vector<std::string> names;
  for (const Joint& joint : mechanism.joints) names.push_back(joint.name);
  request.joint = FindJoint(mechanism, node.key());
  if (request.joint < 0) {
    node.KeyError("joint " + Quoted(node.key()) + " not found" + DidYouMean(node.key(), names));
    return request;
  }
  const JointType type = mechanism.joints[request.joint].type;
  if (type != JointType::kRevolute && type != JointType::kCylindrical &&
      type != JointType::kScrew) {
    node.KeyError(fmt::format("a {} joint has no axis for rolling bearings", NameOf(type)));
    return request;
  }
  if (!node.CheckKeys({}, {"description", "positions", "locating", "shaft", "housing", "life_hours",
                           "pair_life_hours", "reliability", "static_safety", "lubrication"})) {
    return request;
  }
  node["description"].Text();
  request.arrangement = ReadArrangement(node, units);
  request.requirements = ReadRequirements(node, units);
  if (request.arrangement.positions.size() < 2 && node["pair_life_hours"]) {
    node["pair_life_hours"].KeyError("there is one bearing; give two positions, or leave this out");
  }
  try {
    request.arrangement.Validate();
    request.requirements.Validate();
  } catch (const std::invalid_argument& defect) {
    node.KeyError(defect.what());
  }
  return request;
}

}  // namespace vmech
