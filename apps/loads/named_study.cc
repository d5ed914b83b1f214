#include "vmech/apps/loads/named_study.h"

#include <fmt/format.h>

#include <stdexcept>

#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {

StudyOutcome RunNamedStudy(const StudyFile& file, const LoadStudyOptions& options) {
  try {
    return RunStudy(file, options);
  } catch (const std::invalid_argument& error) {
    throw FileErrors(file.path.string(), error.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.path.string(), error.what()));
  }
}

}  // namespace vmech
