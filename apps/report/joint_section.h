#pragma once

#include <string>

#include "vmech/apps/html/markup.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// The largest loads of one joint and where they occur.
struct JointPeaks {
  double radial = 0, axial = 0, tilting = 0;  ///< [N], [N], [N m]
  size_t radial_pose = 0, axial_pose = 0, tilting_pose = 0;
};

/// Radial: across z of the joint's first anchor; axial: along z; tilting: moment across z.
JointPeaks PeaksOf(const LoadStudyResult& result, size_t joint);

/// Forces [N], and moments [N m], up to this are rounding beside what the mechanism carries.
double Negligible(const LoadStudyResult& result);

/// A force or moment as it is shown on a page and on a terminal: four digits, thousands apart; "0"
/// where it is negligible.
std::string FormatLoad(double value, double negligible);

/// One line per joint: its peaks, where they occur, and the verdict.
html::Markup JointOverview(const LoadStudy& study, const LoadStudyResult& result,
                           const Cycle& cycle);

/// Plots and a table of the components of every joint.
html::Markup JointSections(const LoadStudy& study, const LoadStudyResult& result,
                           const Cycle& cycle);

}  // namespace vmech
