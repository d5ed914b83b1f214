#pragma once

#include <string>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/studies/study.h"

namespace vmech {

/// The tables that `vmech loads` writes, as the text of CSV files. SI units, radians, numbers in
/// the shortest form that reads back to the same double; a fixed order of columns, so that the same
/// study gives the same bytes whatever the number of threads.

/// t; drive coordinates; <joint>.fx .. <joint>.mz of every joint; drive or hand forces;
/// power_error. With one drive its columns are drive.position and drive.force, with several
/// drive.<joint>.position and so on; a hand has <grasp>.fx .. <grasp>.mz (about Go, world axes) and
/// <grasp>.distance.
std::string LoadsTable(const StudyFile& file, const LoadStudyResult& result, int threads);

/// t; <link>.x .. of every moving link's drawing frame: position, quaternion, velocity, angular
/// velocity, acceleration, angular acceleration; world axes.
std::string MotionTable(const StudyFile& file, const LoadStudyResult& result, int threads);

/// t; <freedom>.position, .rate, .acceleration of every freedom of every joint, named as
/// NameOfFreedom names it. Of a spherical joint the position is the rotation vector of its second
/// anchor in the first, rate and acceleration those of its angular velocity, axes of the second.
std::string JointsTable(const StudyFile& file, const LoadStudyResult& result, int threads);

/// joint, component, verdict.
std::string CertaintyTable(const StudyFile& file, const LoadStudyResult& result);

/// One line per bearing position.
std::string BearingsTable(const StudyFile& file, const StudyOutcome& outcome);

/// The SHA-256 of the mechanism file as it was read.
std::string DigestOfMechanism(const StudyFile& file);

/// Everything that a program would ask of a study, except the tables: summary.json.
std::string SummaryJson(const StudyFile& file, const StudyOutcome& outcome);

}  // namespace vmech
