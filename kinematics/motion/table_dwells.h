#pragma once

#include <vector>

namespace vmech {

/// Where a table stands still: for each interval between two rows, whether it is (part of) a dwell.
/// `columns` are the coordinates that move together; rows are equal where all of them are, to the
/// last bit. Equal rows are a dwell
///
///   - three or more in a row,
///   - two at an end of the table,
///   - two with the motion going on in the same sense,
///   - two at a turning point, if the curve there is not one smooth arc: the second differences of
///     the rows outside, over those at the two rows, are on either side below 0.1 (straight up to
///     the dwell) or above 1.5 (coming to rest). A parabola has 1, a sine with n rows a turn
///     cos(3 pi/n) / cos(pi/n), such as 0.41 for eight.
std::vector<bool> FindDwells(const std::vector<double>& times,
                             const std::vector<std::vector<double>>& columns);

}  // namespace vmech
