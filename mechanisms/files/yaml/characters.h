#pragma once

#include <string>
#include <string_view>

namespace vmech {

/// Parsers of YAML and XML take control characters for marks of their own, or stop at them, and do
/// not look at the encoding: what they get goes through here first.
/// @throws FileErrors at the first byte that is not UTF-8 (RFC 3629) or a control character other
///         than tab and line break; `file` stands for the text in the message.
void RequireCharacters(std::string_view text, const std::string& file);

}  // namespace vmech
