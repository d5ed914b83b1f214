#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {
namespace {

/// Of an array [all, ..] the rows `poses`.
template <typename T>
std::pmr::vector<T> RowsOf(const std::pmr::vector<T>& array, size_t all,
                           const std::vector<size_t>& poses) {
  const size_t width = array.size() / all;
  std::pmr::vector<T> rows;
  rows.reserve(width * poses.size());
  for (const size_t pose : poses) {
    const auto first = array.begin() + static_cast<ptrdiff_t>(width * pose);
    rows.insert(rows.end(), first, first + static_cast<ptrdiff_t>(width));
  }
  return rows;
}

}  // namespace

Motion PartOf(const Motion& motion, const std::vector<size_t>& poses) {
  const size_t all = motion.size();
  return {RowsOf(motion.times, all, poses),         RowsOf(motion.coordinates, all, poses),
          RowsOf(motion.drives, all, poses),        RowsOf(motion.hand, all, poses),
          RowsOf(motion.cut_positions, all, poses), motion.speed};
}

}  // namespace vmech
