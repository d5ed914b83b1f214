#pragma once

#include "vmech/apps/html/markup.h"
#include "vmech/studies/study.h"

namespace vmech {

/// The bearings of every joint that asks for some: the choice at each position, what it must bear,
/// the life, warnings, and why every other bearing of the catalogue was passed over.
html::Markup BearingSections(const StudyFile& file, const StudyOutcome& outcome);

/// "6304 + 6203", "2 × 6304"; "none fits" where a position stays empty.
std::string ChosenBearings(const JointBearings& bearings);

}  // namespace vmech
