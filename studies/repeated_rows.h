#pragma once

#include <cstddef>
#include <vector>

namespace vmech {

/// Rows of a table with their times [s].
template <typename Row>
struct TimedRows {
  std::vector<double> times;  ///< increasing [s]
  std::vector<Row> rows;      ///< one for each time
};

/// The rows of a cycle, whose last one brings the first again, between those of the cycles before
/// and after it: so many that a spline through all of them does not feel where they end. From row
/// to row the curvature that an end adds shrinks to less than half.
/// Precondition: two rows or more.
template <typename Row>
TimedRows<Row> WithCyclesAround(const TimedRows<Row>& cycle) {
  constexpr size_t kFar = 60;  // rows; 2^-60 is below rounding
  const size_t count = cycle.times.size() - 1;
  const auto before = static_cast<int>((kFar + count - 1) / count);
  const double period = cycle.times.back() - cycle.times.front();
  TimedRows<Row> table;
  const auto add = [&](size_t row, int turn) {
    table.times.push_back(cycle.times[row] + turn * period);
    table.rows.push_back(cycle.rows[row]);
  };
  for (int turn = -before; turn <= before; ++turn) {
    for (size_t row = 0; row < count; ++row) add(row, turn);
  }
  add(0, before + 1);
  return table;
}

}  // namespace vmech
