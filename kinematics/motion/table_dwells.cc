#include "vmech/kinematics/motion/table_dwells.h"

#include <cstddef>

namespace vmech {
namespace {

constexpr double kStraight = 0.1, kComingToRest = 1.5;

/// A table whose rows are points.
class Rows {
 public:
  Rows(const std::vector<double>& times, const std::vector<std::vector<double>>& columns)
      : times_(times), columns_(columns) {}

  bool Equal(size_t i, size_t j) const {
    for (const auto& column : columns_) {
      if (column[i] != column[j]) return false;
    }
    return true;
  }

  /// Does the motion before row i go on in the same sense behind row i + 1?
  bool GoesOn(size_t i) const {
    double sense = 0;
    for (const auto& y : columns_) sense += (y[i] - y[i - 1]) * (y[i + 2] - y[i + 1]);
    return sense > 0;
  }

  /// The second difference at `outer` along that at `inner`, over the latter.
  double Ratio(size_t outer, size_t inner) const {
    double along = 0, square = 0;
    for (const auto& y : columns_) {
      along += SecondDifference(y, outer) * SecondDifference(y, inner);
      square += SecondDifference(y, inner) * SecondDifference(y, inner);
    }
    return along / square;
  }

 private:
  double SecondDifference(const std::vector<double>& y, size_t i) const {
    const double before = times_[i] - times_[i - 1], after = times_[i + 1] - times_[i];
    return ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before) / (before + after);
  }

  const std::vector<double>& times_;
  const std::vector<std::vector<double>>& columns_;
};

bool BreaksTheArc(double ratio) {
  return ratio < kStraight || ratio > kComingToRest;
}

/// Is the turning point between the equal rows i and i + 1, which are not at an end, a dwell?
bool RestsAtTurn(const Rows& rows, size_t i, size_t count) {
  const bool has_before = i >= 2, has_after = i + 3 < count;
  if (has_before && !BreaksTheArc(rows.Ratio(i - 1, i))) return false;
  if (has_after && !BreaksTheArc(rows.Ratio(i + 2, i + 1))) return false;
  return has_before || has_after;
}

}  // namespace

std::vector<bool> FindDwells(const std::vector<double>& times,
                             const std::vector<std::vector<double>>& columns) {
  const Rows rows(times, columns);
  const size_t n = times.size();
  std::vector<bool> dwells(n < 2 ? 0 : n - 1, false);
  for (size_t first = 0; first + 1 < n;) {
    size_t last = first;
    while (last + 1 < n && rows.Equal(last, last + 1)) ++last;
    const bool at_end = first == 0 || last + 1 == n;
    const bool dwell =
        last - first > 1 ||
        (last > first && (at_end || rows.GoesOn(first) || RestsAtTurn(rows, first, n)));
    for (size_t i = first; dwell && i < last; ++i) dwells[i] = true;
    first = last > first ? last : first + 1;
  }
  return dwells;
}

}  // namespace vmech
