#include "vmech/mechanisms/exchange/mechanism_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/mechanisms/direction.h"
#include "vmech/mechanisms/exchange/mended_inertia.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech {
namespace {

constexpr size_t kLongestName = 100;  // bytes, as Node::CheckName

std::string WithoutForbidden(std::string_view name) {
  std::string fit;
  for (const char c : name.substr(0, kLongestName)) {
    const bool forbidden = static_cast<unsigned char>(c) < 0x20 || c == 0x7F ||
                           std::string_view("/,\"\\").find(c) != std::string_view::npos;
    fit += forbidden ? '_' : c;
  }
  while (!fit.empty() && fit.back() == ' ') fit.pop_back();
  fit.erase(0, fit.find_first_not_of(' '));
  return fit.empty() ? "unnamed" : fit;
}

}  // namespace

Matrix3d AxesAlong(const Vector3d& z, const Matrix3d& near) {
  constexpr double kAlong = 0.9;  // cosine beyond which x says little
  const double cosine = std::abs(NearUnitLength(z).normalized().dot(near.col(0)));
  return AxesFromZX(z, cosine < kAlong ? near.col(0) : near.col(1));
}

MechanismBuilder::MechanismBuilder(std::string name, ImportOptions options)
    : options_(std::move(options)) {
  imported_.mechanism.name = std::move(name);
}

std::string MechanismBuilder::FitName(std::string_view name, std::set<std::string>* taken) {
  const std::string fit = WithoutForbidden(name);
  std::string unique = fit;
  for (int i = 2; !taken->insert(unique).second; ++i) {
    unique = fmt::format("{}_{}", fit.substr(0, kLongestName - 8), i);
  }
  if (unique != name) Note(fmt::format("{} is called '{}' here", Quoted(name), unique));
  return unique;
}

int MechanismBuilder::AddLink(std::string_view name, const MassProperties& properties,
                              const Posed& X_WL, const Place& place) {
  imported_.mechanism.links.push_back({FitName(name, &links_), properties, {}});
  poses_.push_back(X_WL);
  places_.push_back(place);
  return static_cast<int>(poses_.size()) - 1;
}

Joint& MechanismBuilder::AddJoint(std::string_view name, JointType type, int first, int second,
                                  const Posed& X_WJ) {
  return AddJoint(name, type, first, poses_[first].inverse() * X_WJ, second,
                  poses_[second].inverse() * X_WJ);
}

Joint& MechanismBuilder::AddJoint(std::string_view name, JointType type, int first,
                                  const Posed& X_LF, int second, const Posed& X_LM) {
  const std::string fit = FitName(name, &joints_);
  const auto add = [&](int link, const Posed& X_LA) {
    std::vector<Anchor>& anchors = imported_.mechanism.links[link].anchors;
    anchors.push_back({fit, X_LA});
    return AnchorId{link, static_cast<int>(anchors.size()) - 1};
  };
  const AnchorId F = add(first, X_LF), M = add(second, X_LM);
  imported_.mechanism.joints.push_back(MakeJoint(fit, type, F, M));
  return imported_.mechanism.joints.back();
}

void MechanismBuilder::AddGrasp(std::string_view name, int link, const Posed& X_LG) {
  imported_.mechanism.grasps.push_back({FitName(name, &grasps_), link, X_LG, GraspKind::kRigid});
}

void MechanismBuilder::NoteMended(const Place& place, const std::string& defect,
                                  const std::string& change) {
  if (options_.strict) {
    refusals_.push_back(
        {place.file, place.line, 1, "", fmt::format("{} (without --strict: {})", defect, change)});
  } else {
    Note(fmt::format("{}; {} ({}:{})", defect, change, place.file, place.line));
  }
}

void MechanismBuilder::SetLimits(const Place& place, double lower, double upper, size_t freedom,
                                 Joint* joint) {
  const std::string what = fmt::format("joint '{}'", joint->name);
  if (lower == upper) {
    return NoteMended(place,
                      fmt::format("{}: its limits are both {:.6g} and would hold it", what, lower),
                      "they are left out");
  }
  if (!(lower < upper)) {
    throw FileErrors({{place.file, place.line, 1, "",
                       fmt::format("{}: the lower limit {:.6g} is above the upper one {:.6g}", what,
                                   lower, upper)}});
  }
  joint->lower[freedom] = lower;
  joint->upper[freedom] = upper;
  const double start = std::clamp(0.0, lower, upper);
  if (start == 0) return;
  Note(
      fmt::format("{} may move from {:.6g} to {:.6g}, which leaves out zero, where it is drawn: it "
                  "starts at {:.6g}",
                  what, lower, upper, start));
  joint->start[freedom] = start;
  joint->start_given = true;
}

int MechanismBuilder::ChooseGround(std::optional<int> fixed, const std::string& file) {
  const Mechanism& mechanism = imported_.mechanism;
  if (mechanism.links.empty()) throw FileErrors(file, "there is no link in it");
  if (!options_.ground.empty()) {
    const int link = FindLink(mechanism, options_.ground);
    if (link >= 0) return link;
    std::vector<std::string> names;
    for (const Link& each : mechanism.links) names.push_back(each.name);
    throw FileErrors(file,
                     fmt::format("the ground {} is not a link of it{}", Quoted(options_.ground),
                                 DidYouMean(options_.ground, names)));
  }
  if (!fixed) {
    Note(fmt::format(
        "nothing is fixed to the world: taken for the ground is '{}' (--ground names another)",
        mechanism.links[0].name));
  }
  return fixed.value_or(0);
}

/// What the ground weighs does not matter, and is no reason to refuse a file.
void MechanismBuilder::MendInertias() {
  Mechanism& mechanism = imported_.mechanism;
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    Link& link = mechanism.links[i];
    const Mending mending = MendInertia(&link.mass_properties);
    if (mending.defect.empty()) continue;
    if (static_cast<int>(i) == mechanism.ground) {
      link.mass_properties.I_Lcm = Matrix3d::Zero();
      Note(fmt::format("link '{}' is the ground: its inertia is dropped ({}:{})", link.name,
                       places_[i].file, places_[i].line));
    } else {
      NoteMended(places_[i], fmt::format("link '{}': {}", link.name, mending.defect),
                 mending.change);
    }
  }
  if (!refusals_.empty()) throw FileErrors(refusals_);
}

/// The place of the link that a path, "links.crank.mass", leads to.
Place MechanismBuilder::PlaceOf(const std::string& path) const {
  for (size_t i = 0; i < places_.size(); ++i) {
    const std::string head = "links." + imported_.mechanism.links[i].name;
    if (path == head || path.starts_with(head + ".")) return places_[i];
  }
  return {};
}

/// Reads the mechanism back as from a file of its own. The lines are of a text that nobody has
/// seen; those of the links are told instead.
void MechanismBuilder::RequireReadable(const std::string& file) const {
  std::vector<FileError> errors;
  try {
    ParseMechanism(WriteMechanism(imported_.mechanism), file);
    return;
  } catch (const FileErrors& found) {
    errors = found.errors();
  } catch (const std::invalid_argument& found) {
    throw FileErrors(file, found.what());
  }
  for (FileError& error : errors) {
    const Place place = PlaceOf(error.path);
    error.line = place.line;
    error.column = 1;
    if (place.line > 0) error.file = place.file;
  }
  throw FileErrors(errors);
}

ImportedMechanism MechanismBuilder::Finish(std::optional<int> fixed_to_world,
                                           const Vector3d& gravity_W, const std::string& file) {
  Mechanism& mechanism = imported_.mechanism;
  mechanism.ground = ChooseGround(fixed_to_world, file);
  mechanism.gravity_W =
      poses_[mechanism.ground].R.transpose() * options_.gravity_W.value_or(gravity_W);
  MendInertias();
  RequireReadable(file);
  return std::move(imported_);
}

}  // namespace vmech
