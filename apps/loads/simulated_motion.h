#pragma once

#include <filesystem>

#include "vmech/studies/study.h"

namespace vmech {

/// Puts the motion in a result folder of `vmech simulate` or `vmech loads` in place of what a study
/// says of its motion: coordinates, rates and accelerations as they stand in its joints.csv. Poses
/// at which loops are singular, whose rows have no numbers, are passed over.
/// Returns what the folder's simulation did not finish, a sentence; empty if it did.
/// @throws FileErrors if it is no such folder, of another mechanism (by the digest in its
/// summary.json), if columns, rows or numbers are missing,
/// if times do not increase, or if the study is moved by a hand.
std::string TakeMotionOf(const std::filesystem::path& folder, StudyFile* file);

}  // namespace vmech
