#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/files/yaml/document_item.h"

namespace vmech {

/// The nodes of a YAML or JSON text, root first. The only place that sees yaml-cpp.
/// @throws FileErrors as `Document` states; `name` stands for the text in messages.
std::vector<DocumentItem> ParseYaml(std::string_view text, const std::string& name);

}  // namespace vmech
