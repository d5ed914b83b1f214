#include "vmech/apps/output_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "vmech/mechanisms/document.h"

namespace vmech {

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
  for (const std::string& name : pending_) std::filesystem::remove(Temporary(name), ignored);
  // Takes away an empty folder only.
  if (made_ && !pending_.empty()) std::filesystem::remove(folder_, ignored);
}

std::filesystem::path OutputFolder::Temporary(const std::string& name) const {
  return folder_ / ("." + name + ".part");
}

void OutputFolder::ThrowUnwritable(const std::string& name) const {
  throw FileErrors((folder_ / name).string(),
                   "cannot be written; is there room, the right to, and no folder of this name? "
                   "Give another place with --out");
}

void OutputFolder::Write(const std::string& name, const std::string& text) {
  pending_.push_back(name);
  std::ofstream file(Temporary(name), std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file || std::filesystem::is_directory(folder_ / name)) ThrowUnwritable(name);
}

void OutputFolder::Commit() {
  for (const std::string& name : pending_) {
    std::error_code error;
    std::filesystem::rename(Temporary(name), folder_ / name, error);
    if (error) ThrowUnwritable(name);
  }
  pending_.clear();
}

}  // namespace vmech
