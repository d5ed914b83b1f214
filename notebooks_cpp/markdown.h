#pragma once

#include <string_view>

#include "vmech/apps/html/markup.h"

namespace vmech {

/// The part of Markdown that chapters use: headings, paragraphs, lists with `-` or `1.`, tables
/// with
/// `|`, fenced code, and within a line **strong**, *emphasis*, `code`, [links](to), $formulas$
/// (formula.h); `$$` on lines of their own enclose a displayed formula.
/// @throws std::invalid_argument for a formula that cannot be read.
html::Markup RenderMarkdown(std::string_view text);

}  // namespace vmech
