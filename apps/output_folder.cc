#include "vmech/apps/output_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "vmech/mechanisms/document.h"

namespace vmech {

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error || !std::filesystem::is_directory(folder_)) {
    throw FileErrors(folder_.string(),
                     fmt::format("cannot make this folder: {}; give another with --out",
                                 error ? error.message() : "a file is in the way"));
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (const std::string& name : pending_) std::filesystem::remove(Temporary(name), ignored);
}

std::filesystem::path OutputFolder::Temporary(const std::string& name) const {
  return folder_ / ("." + name + ".part");
}

void OutputFolder::Write(const std::string& name, const std::string& text) {
  pending_.push_back(name);
  std::ofstream file(Temporary(name), std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) {
    throw FileErrors((folder_ / name).string(),
                     "cannot be written; is there room, and the right to?");
  }
}

void OutputFolder::Commit() {
  for (const std::string& name : pending_) {
    std::filesystem::rename(Temporary(name), folder_ / name);
  }
  pending_.clear();
}

}  // namespace vmech
