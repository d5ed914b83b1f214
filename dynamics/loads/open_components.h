#pragma once

#include <array>
#include <vector>

#include "vmech/dynamics/loads/load_peaks.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/rule_dependence.h"

namespace vmech {

/// True if statics leaves any component of any joint's wrench open.
bool AnyNotDetermined(const LoadStudyResult& result);

/// LoadStudyResult::open: of the components that statics does not determine, those that are not
/// zero at every pose by their `peaks`, or that other stiffnesses change. Without a `dependence`
/// nothing is known of other stiffnesses, and all are open. `length`: the characteristic one of the
/// mechanism [m].
std::vector<std::array<bool, 6>> FindOpenComponents(const LoadStudyResult& result,
                                                    const LoadPeaks& peaks,
                                                    const RuleDependence* dependence,
                                                    double length);

/// The verdicts without those on components that are zero whatever the rule: no load of the study
/// acts on what statics leaves open there.
JointCertainty VerdictsThatMatter(const LoadStudyResult& result, size_t joint);

}  // namespace vmech
