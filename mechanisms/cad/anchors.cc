#include "vmech/mechanisms/cad/anchors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr size_t kNumberDigits = 3;  // that FreeCAD puts behind a name

void OverlookNumbers(std::vector<BodyFrame>* frames) {
  std::set<std::string> names;
  for (const BodyFrame& frame : *frames) names.insert(frame.name.name);
  for (BodyFrame& frame : *frames) {
    std::string& name = frame.name.name;
    if (name.size() <= kNumberDigits) continue;
    const auto digits = name.end() - kNumberDigits;
    if (!std::all_of(digits, name.end(), [](unsigned char c) { return std::isdigit(c); })) continue;
    const std::string without = name.substr(0, name.size() - kNumberDigits);
    if (names.count(without) > 0) name = without;
  }
}

}  // namespace

AnchorMatches MatchAnchors(std::vector<BodyFrame> frames) {
  OverlookNumbers(&frames);
  std::vector<std::string> order;
  std::map<std::string, std::vector<BodyFrame>> by_name;
  for (const BodyFrame& frame : frames) {
    std::vector<BodyFrame>& same = by_name[frame.name.name];
    if (same.empty()) order.push_back(frame.name.name);
    same.push_back(frame);
  }
  AnchorMatches matches;
  for (const std::string& name : order) {
    const std::vector<BodyFrame>& same = by_name[name];
    if (same.size() == 1) {
      matches.unmatched.push_back(same[0]);
    } else if (same.size() > 2) {
      matches.errors.push_back(fmt::format(
          "joint {} has {} anchors; a joint has two, one on each of two bodies: give each pair a "
          "name of its own",
          Quoted(name), same.size()));
    } else if (same[0].body == same[1].body) {
      matches.errors.push_back(
          fmt::format("joint {} has both its anchors on one body; one of them belongs to another",
                      Quoted(name)));
    } else {
      matches.pairs.push_back({same[0], same[1]});
    }
  }
  return matches;
}

std::optional<BodyFrame> NearestFrame(const BodyFrame& frame, const std::vector<BodyFrame>& free,
                                      const std::vector<BodyFrame>& all) {
  for (const std::vector<BodyFrame>* candidates : {&free, &all}) {
    std::optional<BodyFrame> nearest;
    const auto distance = [&](const BodyFrame& other) {
      return (other.X_WA.p - frame.X_WA.p).norm();
    };
    for (const BodyFrame& other : *candidates) {
      if (other.body == frame.body) continue;
      if (!nearest || distance(other) < distance(*nearest)) nearest = other;
    }
    if (nearest) return nearest;
  }
  return std::nullopt;
}

}  // namespace vmech
