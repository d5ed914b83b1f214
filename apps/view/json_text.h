#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vmech {

/// In one line of ASCII; bytes that are no UTF-8 become U+FFFD, numbers that are not finite null.
template <typename Json = nlohmann::json>
std::string JsonText(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

}  // namespace vmech
