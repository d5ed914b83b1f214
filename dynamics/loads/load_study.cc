#include "vmech/dynamics/loads/load_study.h"

#include <stdexcept>

#include <fmt/format.h>

#include "vmech/base/check_range.h"

namespace vmech {

void LoadStudyOptions::Validate() const {
  if (threads < 1 || threads > 64) {
    throw std::invalid_argument(fmt::format("threads is {}; it must be in 1..64", threads));
  }
  if (!(closure_tolerance > 0 && closure_tolerance <= 1e-6)) {
    throw std::invalid_argument(
        fmt::format("closure_tolerance is {}; it must be in (0, 1e-6]", closure_tolerance));
  }
}

}  // namespace vmech
