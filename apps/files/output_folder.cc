#include "vmech/apps/files/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "vmech/apps/files/write_whole.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

[[noreturn]] void ThrowUnwritable(const std::filesystem::path& file, const std::error_code& why) {
  throw FileErrors(file.string(),
                   fmt::format("cannot be written: {}; give another place with --out, or make room",
                               why.message()));
}

}  // namespace

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  made_ = std::filesystem::create_directories(folder_, error);
  if (error || !std::filesystem::is_directory(folder_)) {
    throw FileErrors(folder_.string(),
                     fmt::format("cannot make this folder: {}; give another with --out",
                                 error ? error.message() : "a file is in the way"));
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (const Pending& file : pending_) std::filesystem::remove(Temporary(file.name), ignored);
  // Takes away an empty folder only.
  if (made_) std::filesystem::remove(folder_, ignored);
}

std::filesystem::path OutputFolder::Temporary(const std::string& name) const {
  return folder_ / (name + kUnfinished);
}

void OutputFolder::Write(const std::string& name, const std::string& text) {
  try {
    if (std::filesystem::is_directory(folder_ / name)) {
      throw std::system_error(std::make_error_code(std::errc::is_a_directory));
    }
    pending_.push_back({name, PathLock(Temporary(name), O_WRONLY | O_CREAT, folder_ / name)});
    const int file = pending_.back().lock.file();
    if (ftruncate(file, 0) != 0) throw std::system_error(errno, std::generic_category());
    WriteWhole(file, text);
  } catch (const std::system_error& error) {
    ThrowUnwritable(folder_ / name, error.code());
  }
}

void OutputFolder::Commit() {
  for (const Pending& file : pending_) {
    std::error_code error;
    std::filesystem::rename(Temporary(file.name), folder_ / file.name, error);
    if (error) ThrowUnwritable(folder_ / file.name, error);
  }
  pending_.clear();
}

}  // namespace vmech
