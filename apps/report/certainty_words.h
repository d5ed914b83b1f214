#pragma once

#include <string>
#include <vector>

#include "vmech/apps/html/markup.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// The components with the given verdict in words, "the axial force and both tilting moments";
/// empty if there are none. Components along a joint's freedoms keep their plain names.
std::string ComponentsInWords(JointType type, const JointCertainty& certainty, Certainty verdict);

/// A badge that sums up the verdicts of one joint.
html::Markup CertaintyBadge(const JointCertainty& certainty);

/// What statics can and cannot determine, joint by joint; joints of equal verdict in one sentence.
html::Markup CertaintySection(const LoadStudy& study, const LoadStudyResult& result);

/// "a", "a and b", "a, b and c".
std::string Enumerate(const std::vector<std::string>& items);

}  // namespace vmech
