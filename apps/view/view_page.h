#pragma once

#include <string>

#include "vmech/apps/html/markup.h"

namespace vmech {

/// The page that shows a mechanism, with a scene of SceneJson: self-contained, no network.
std::string ViewPage(const std::string& title, const std::string& scene_json);

/// The same as a part of a document: its style, the place where it appears, the scene and the
/// scripts, at the end of the body. Well-formed XML.
html::Markup ViewSection(const std::string& scene_json);

}  // namespace vmech
