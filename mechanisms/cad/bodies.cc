#include "vmech/mechanisms/cad/bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "vmech/mechanisms/cad/step/frame_name.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr int kNoBody = -1, kLeftOut = -2;

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void RequireKnown(const CadAssembly& assembly, const BodyOptions& options) {
  std::vector<std::string> all;
  for (const CadGroup& group : assembly.groups) all.push_back(group.name);
  for (const CadPart& part : assembly.parts) all.push_back(part.name);
  std::vector<FileError> errors;
  const auto check = [&](const std::vector<std::string>& asked) {
    for (const std::string& name : asked) {
      if (Contains(all, name)) continue;
      errors.push_back({assembly.file, 0, 0, "",
                        fmt::format("there is no part or subassembly {}{}", Quoted(name),
                                    DidYouMean(name, all))});
    }
  };
  check(options.rigid);
  check(options.ignore);
  check(options.moving);
  for (const auto& welded : options.weld) check(welded);
  if (!errors.empty()) throw FileErrors(errors);
}

/// For each group the group that stands for its body: itself, one above it, or none.
std::vector<int> OwnersOf(const CadAssembly& assembly, const BodyOptions& options) {
  std::set<int> with_frames;
  for (const CadFrame& frame : assembly.frames) {
    if (ParseFrameName(frame.name).role != FrameName::Role::kNone) with_frames.insert(frame.group);
  }
  std::vector<int> owners(assembly.groups.size(), kNoBody);
  std::vector<bool> closed(assembly.groups.size(), false);  // below a rigid one
  for (size_t g = 1; g < assembly.groups.size(); ++g) {
    const CadGroup& group = assembly.groups[g];
    owners[g] = owners[group.parent];
    closed[g] = closed[group.parent];
    if (Contains(options.ignore, group.name)) {
      owners[g] = kLeftOut;
      closed[g] = true;
    }
    if (closed[g]) continue;
    closed[g] = Contains(options.rigid, group.name);
    if (closed[g] || with_frames.count(static_cast<int>(g)) > 0) owners[g] = static_cast<int>(g);
  }
  return owners;
}

}  // namespace

std::vector<CadBody> FindBodies(const CadAssembly& assembly, const BodyOptions& options,
                                std::vector<int>* loose) {
  RequireKnown(assembly, options);
  const std::vector<int> owners = OwnersOf(assembly, options);
  std::vector<CadBody> bodies;
  std::map<int, size_t> body_of_group;
  const auto group_body = [&](int group) -> CadBody& {
    const auto [it, is_new] = body_of_group.try_emplace(group, bodies.size());
    if (is_new) {
      bodies.push_back({assembly.groups[group].name, assembly.groups[group].X_WG, {}, {}});
    }
    return bodies[it->second];
  };
  for (int p = 0; p < static_cast<int>(assembly.parts.size()); ++p) {
    const CadPart& part = assembly.parts[p];
    const int owner = owners[part.group];
    if (owner == kLeftOut || Contains(options.ignore, part.name)) continue;
    if (owner == kNoBody) {
      bodies.push_back({part.name, part.X_WP, {p}, {}});
    } else {
      group_body(owner).parts.push_back(p);
    }
  }
  for (int f = 0; f < static_cast<int>(assembly.frames.size()); ++f) {
    const CadFrame& frame = assembly.frames[f];
    if (ParseFrameName(frame.name).role == FrameName::Role::kNone) continue;
    const int owner = owners[frame.group];
    if (owner == kNoBody) loose->push_back(f);
    if (owner >= 0) group_body(owner).frames.push_back(f);
  }
  return bodies;
}

bool IsUsualGround(const std::string& name) {
  std::string lower = name;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  static const std::set<std::string> usual{"ground", "frame", "base", "housing", "stand"};
  return usual.count(lower) > 0;
}

WorldFeatures FeaturesOf(const CadAssembly& assembly, const CadBody& body) {
  WorldFeatures features;
  for (const int p : body.parts) {
    const CadPart& part = assembly.parts[p];
    const bool is_fastener =
        std::find(body.fasteners.begin(), body.fasteners.end(), p) != body.fasteners.end();
    for (CadFeature feature : assembly.shapes[part.shape].features) {
      feature.X_PF = part.X_WP * feature.X_PF;
      feature.fastens = is_fastener;
      features.push_back(feature);
    }
  }
  return features;
}

}  // namespace vmech
