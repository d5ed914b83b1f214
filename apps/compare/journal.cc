#include "vmech/apps/compare/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "vmech/apps/compare/result_text.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxJournalBytes = size_t{4} << 30;
constexpr const char* kRemedy = "remove the folder, or give another with --out";

std::string Hex(uint64_t digest) {
  return fmt::format("{:016x}", digest);
}

std::string HeaderLine(const Journal::Origin& origin) {
  return Json{{"vmech_rows", origin.version},
              {"suite", Hex(origin.suite)},
              {"program", Hex(origin.program)}}
      .dump();
}

bool Belongs(const Result& result, const Suite& suite) {
  const auto [m, b, i] = result.problem;
  return m >= 0 && m < static_cast<int>(suite.mechanisms.size()) && b >= 0 &&
         b < static_cast<int>(suite.blocks.size()) && i >= 0 && i < suite.blocks[b].count;
}

}  // namespace

Journal::Journal(const std::filesystem::path& folder, const Origin& origin, const Suite& suite)
    : path_(folder / kFileName) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw FileErrors(folder.string(),
                     fmt::format("cannot make this folder: {}; give another with --out",
                                 error ? error.message() : "a file is in the way"));
  }
  Open();
  try {
    Read(origin, suite);
  } catch (...) {
    close(file_);
    throw;
  }
}

Journal::~Journal() {
  close(file_);
}

void Journal::Refuse(const std::string& message) const {
  throw FileErrors(path_.string(), message);
}

void Journal::Open() {
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) {
    Refuse(
        fmt::format("cannot be written: {}; give another folder with --out", std::strerror(errno)));
  }
  if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  close(file_);
  Refuse("another vmech is writing here; wait for it, or give another folder with --out");
}

void Journal::Read(const Origin& origin, const Suite& suite) {
  const std::string text = ReadTextFile(path_, kMaxJournalBytes);
  const size_t end = text.rfind('\n');  // behind it there is at most a line cut off
  if (end == text.npos) {
    if (ftruncate(file_, 0) != 0) Refuse("cannot be written; give another folder with --out");
    Write(HeaderLine(origin));
    return;
  }
  std::set<std::pair<ProblemId, SolverEntry>> seen;
  int line_number = 0;
  for (size_t at = 0; at <= end;) {
    const size_t stop = text.find('\n', at);
    const std::string_view line(text.data() + at, stop - at);
    at = stop + 1;
    if (++line_number == 1) {
      CheckOrigin(line, origin);
      continue;
    }
    std::optional<Result> result = ResultFromLine(line);
    if (!result || !Belongs(*result, suite)) {
      Refuse(fmt::format("line {} is damaged; {}", line_number, kRemedy));
    }
    if (seen.insert({result->problem, result->solver}).second) found_.push_back(std::move(*result));
  }
  if (end + 1 < text.size() && ftruncate(file_, static_cast<off_t>(end) + 1) != 0) {
    Refuse("cannot be written; give another folder with --out");
  }
}

void Journal::CheckOrigin(std::string_view line, const Origin& origin) const {
  const Json header = Json::parse(line, nullptr, false);
  if (!header.is_object() || !header.contains("vmech_rows")) {
    Refuse(fmt::format("is not a file of vmech's; {}", kRemedy));
  }
  if (header.value("suite", "") != Hex(origin.suite)) {
    Refuse(
        fmt::format("holds rows of another suite, or of this one before it or a mechanism that "
                    "it names was changed; {}",
                    kRemedy));
  }
  const std::string version = header.value("vmech_rows", "");
  if (version != origin.version || header.value("program", "") != Hex(origin.program)) {
    Refuse(
        fmt::format("holds rows of another build of vmech{}, which cannot stand beside those of "
                    "this one; {}",
                    version == origin.version ? "" : ", version " + version, kRemedy));
  }
}

void Journal::Append(const Result& result) {
  Write(ToLine(result));
}

void Journal::Write(const std::string& line) {
  const std::string text = line + "\n";
  size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = write(file_, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      Refuse(
          fmt::format("cannot be written: {}; what is there is sound, make room and run the "
                      "command again",
                      std::strerror(errno)));
    }
    written += static_cast<size_t>(count);
  }
}

}  // namespace vmech
