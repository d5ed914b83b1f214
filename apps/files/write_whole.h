#pragma once

#include <string_view>

namespace vmech {

/// Writes a text to an open file, all of it and to the disk, since some file systems only then say
/// that there is no room. @throws std::system_error
void WriteWhole(int file, std::string_view text);

}  // namespace vmech
