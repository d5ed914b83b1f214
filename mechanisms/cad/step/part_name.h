#pragma once

#include <string>
#include <string_view>

namespace vmech {

/// A name that files of vmech can hold: valid UTF-8 of at most 80 bytes, whole characters; control
/// characters, bytes that are no UTF-8, and / , " \ become '_'; no blank at an end. `fallback` if
/// nothing is left.
std::string CleanName(const std::string& name, const std::string& fallback);

/// True if every byte of a text belongs to a character of UTF-8 [RFC 3629].
bool IsUtf8(std::string_view text);

}  // namespace vmech
