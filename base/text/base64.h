#pragma once

#include <string>
#include <string_view>

namespace vmech {

/// The bytes in the 64 letters of RFC 4648, padded.
std::string Base64(std::string_view bytes);

}  // namespace vmech
