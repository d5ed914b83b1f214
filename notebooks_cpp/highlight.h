#pragma once

#include <string_view>

#include "vmech/apps/html/markup.h"

namespace vmech {

/// C++ source with keywords, types (UpperCamel), numbers, texts, comments and preprocessor lines in
/// <span> of the classes k, t, n, s, c, p.
html::Markup HighlightCpp(std::string_view source);

}  // namespace vmech
