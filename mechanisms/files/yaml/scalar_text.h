#pragma once

#include <string>
#include <string_view>

#include "vmech/mechanisms/files/yaml/document_item.h"

namespace vmech {

/// What a scalar reads as.

/// True for a decimal number as in JSON or YAML 1.2: sign, digits, point, exponent. A leading
/// zero, which some readers take for octal, is not accepted.
bool LooksLikeNumber(std::string_view text);
/// true, false and their spellings.
bool IsBoolean(std::string_view text);
/// The words for what is not finite: .inf, nan and their spellings.
bool IsNotFinite(std::string_view text);

/// "a map", "text 'abc'": what a node is, for messages.
std::string Describe(const DocumentItem& item);

}  // namespace vmech
