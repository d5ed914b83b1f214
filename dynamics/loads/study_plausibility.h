#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// What is possible in a study, and yet seldom meant; those of its mechanism (DoubtsOf a mechanism)
/// and: fewer than 16 poses in a cycle; a link that stands still although a drive moves; a table
/// whose accelerations are mostly the scatter of its figures. A mechanism without masses is no
/// doubt where external loads act.
std::vector<std::string> DoubtsOf(const LoadStudy& study, const LoadStudyResult& result);

}  // namespace vmech
