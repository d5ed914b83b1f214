#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/dynamics/bearings/bearing.h"

namespace vmech {

/// A catalogue is a CSV file: comments start with #, the first other line names the columns.
///
///   designation, kind, d_mm, D_mm, B_mm, C_kN, C0_kN     required
///   kind            deep_groove_ball or cylindrical_roller: no row is taken for a kind unsaid
///   f0              required for deep_groove_ball
///   n_grease_rpm, n_oil_rpm, axial_limit           may be empty: not checked then
///
/// The bearings are returned in order of size (IsSmaller).

/// @throws std::runtime_error with one line "<name>:<line>: ..." for everything that is wrong.
std::vector<Bearing> ParseCatalogue(std::string_view text, const std::string& name);

/// @throws std::runtime_error as ParseCatalogue, or if the file cannot be read.
std::vector<Bearing> ReadCatalogue(const std::string& path);

/// The catalogue compiled into the library, data/deep_groove_ball.csv: 52 deep groove ball
/// bearings, with the lowest ratings of five makers.
const std::vector<Bearing>& BuiltInCatalogue();

}  // namespace vmech
