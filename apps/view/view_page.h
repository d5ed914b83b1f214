#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/apps/html/markup.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The page that shows a mechanism, with a scene of SceneJson: self-contained, no network.
std::string ViewPage(const std::string& title, const std::string& scene_json);

/// The page of a mechanism alone, at its start. `meshes`, `session`, `parameters`: as in Scene.
std::string MechanismPage(const KinematicTree& assembled, std::vector<std::string> meshes,
                          std::string_view version, std::string_view session = "",
                          std::string_view parameters = "");

/// The same as a part of a document, well-formed XML: the place where it appears, with its style,
html::Markup ViewPlace();
/// and the scene with the scripts, for the end of the body.
html::Markup ViewScripts(const std::string& scene_json);

}  // namespace vmech
