#include "vmech/mechanisms/exchange/mechanism_builder.h"

#include <fmt/format.h>

#include <stdexcept>

#include "vmech/mechanisms/document.h"
#include "vmech/mechanisms/reader.h"
#include "vmech/mechanisms/writer.h"

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

/// Reads the mechanism back as from a file of its own.
void RequireReadable(const Mechanism& mechanism, const std::string& file) {
  std::vector<FileError> errors;
  try {
    ParseMechanism(WriteMechanism(mechanism), file);
    return;
  } catch (const FileErrors& found) {
    errors = found.errors();
  } catch (const std::invalid_argument& found) {
    throw FileErrors(file, found.what());
  }
  for (FileError& error : errors) error.line = 0;  // of a text that nobody has seen
  throw FileErrors(errors);
}

}  // namespace

Matrix3d AxesAlong(const Vector3d& z, const Matrix3d& near) {
  constexpr double kAlong = 0.9;  // cosine beyond which x says little
  const double cosine = std::abs(z.normalized().dot(near.col(0)));
  return AxesFromZX(z, cosine < kAlong ? near.col(0) : near.col(1));
}

MechanismBuilder::MechanismBuilder(std::string name) {
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
                              const Posed& X_WL) {
  imported_.mechanism.links.push_back({FitName(name, &links_), properties, {}});
  poses_.push_back(X_WL);
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

int MechanismBuilder::ChooseGround(const ImportOptions& options, std::optional<int> fixed,
                                   const std::string& file) {
  const Mechanism& mechanism = imported_.mechanism;
  if (mechanism.links.empty()) throw FileErrors(file, "there is no link in it");
  if (!options.ground.empty()) {
    const int link = FindLink(mechanism, options.ground);
    if (link >= 0) return link;
    std::vector<std::string> names;
    for (const Link& each : mechanism.links) names.push_back(each.name);
    throw FileErrors(file, fmt::format("the ground {} is not a link of it{}",
                                       Quoted(options.ground), DidYouMean(options.ground, names)));
  }
  if (!fixed) {
    Note(
        fmt::format("nothing is fixed to the world: taken for the ground is '{}' (--ground names "
                    "another)",
                    mechanism.links[0].name));
  }
  return fixed.value_or(0);
}

ImportedMechanism MechanismBuilder::Finish(const ImportOptions& options,
                                           std::optional<int> fixed_to_world,
                                           const Vector3d& gravity_W, const std::string& file) {
  Mechanism& mechanism = imported_.mechanism;
  mechanism.ground = ChooseGround(options, fixed_to_world, file);
  mechanism.gravity_W =
      poses_[mechanism.ground].R.transpose() * options.gravity_W.value_or(gravity_W);
  RequireReadable(mechanism, file);
  return std::move(imported_);
}

}  // namespace vmech
