#pragma once

#include <string_view>

#include "vmech/apps/html/markup.h"
#include "vmech/studies/study.h"

namespace vmech {

/// Everything that the figures of a report were computed from: files with their digests, masses,
/// joints, gravity, motion, loads from outside, bearings asked for, and the choices of the study.
/// `version` is that of vmech, `date` a day; empty if none is to be shown.
html::Markup InputSection(const StudyFile& file, std::string_view version, std::string_view date);

}  // namespace vmech
