#pragma once

#include <string>

#include "vmech/apps/html/markup.h"

namespace vmech {

/// The page that shows a mechanism, with a scene of SceneJson: self-contained, no network.
std::string ViewPage(const std::string& title, const std::string& scene_json);

/// The same as a part of a document, well-formed XML: the place where it appears, with its style,
html::Markup ViewPlace();
/// and the scene with the scripts, for the end of the body.
html::Markup ViewScripts(const std::string& scene_json);

}  // namespace vmech
