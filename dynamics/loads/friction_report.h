#pragma once

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Adds to the warnings of a study what its dry friction has to say: where friction locks the
/// mechanism and at which joint, screws that lock themselves, poses at rest that friction alone
/// holds, and every load of a joint with friction for which its keys have no formula, with its
/// largest size.
void AddFrictionWarnings(const Mechanism& mechanism, LoadStudyResult* result);

}  // namespace vmech
