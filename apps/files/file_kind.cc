#include "vmech/apps/files/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

namespace vmech {
namespace {

namespace fs = std::filesystem;

struct Words {
  FileKind kind;
  std::string_view noun, use;
};

/// What each kind is called, and what is to be done with it.
constexpr std::array kWords = {
    Words{FileKind::kMechanism, "a mechanism", "which `vmech check` reads"},
    Words{FileKind::kStudy, "a study", "which `vmech loads` runs"},
    Words{FileKind::kSuite, "a suite", "which `vmech compare` runs"},
    Words{FileKind::kLoops, "a list of loops", "for `vmech import FILE --loops`"},
    Words{FileKind::kRecording, "a recording", "which `vmech replay` runs"},
    Words{FileKind::kTable, "a table (CSV)", "which a study names"},
    Words{FileKind::kDrawing, "a file of another program",
          "of which `vmech import` makes a mechanism"},
    Words{FileKind::kResults, "a folder of results", "whose report.html a browser shows"},
    Words{FileKind::kFolder, "a folder", "not a file"},
};

const Words& WordsOf(FileKind kind) {
  return *std::find_if(kWords.begin(), kWords.end(),
                       [kind](const Words& words) { return words.kind == kind; });
}

std::string Beginning(const fs::path& path) {
  constexpr size_t kEnough = 200;
  std::string text(kEnough, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), kEnough);
  text.resize(static_cast<size_t>(file.gcount()));
  return text;
}

FileKind KindOfFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path / "report.html", ignored) ? FileKind::kResults : FileKind::kFolder;
}

FileKind KindByKeys(const fs::path& path) {
  constexpr std::pair<std::string_view, FileKind> kKeys[] = {
      {"vmech", FileKind::kMechanism},
      {"vmech_study", FileKind::kStudy},
      {"vmech_suite", FileKind::kSuite},
      {"vmech_loops", FileKind::kLoops},
  };
  Document document(ReadTextFile(path), path.string());
  for (const auto& [key, kind] : kKeys) {
    if (document.root()[key]) return kind;
  }
  return FileKind::kUnknown;
}

std::string Ending(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return ending;
}

/// The mechanism that a study names, for a hint; empty if there is none.
std::string MechanismOf(const fs::path& study) {
  Document document(ReadTextFile(study), study.string());
  const Node mechanism = document.root()["mechanism"];
  if (mechanism.kind() != Node::Kind::kScalar) return "";
  return (study.parent_path() / mechanism.Text()).string();
}

bool Takes(const Taken& taken, FileKind kind) {
  return std::find(taken.kinds.begin(), taken.kinds.end(), kind) != taken.kinds.end();
}

std::string NounsOf(const Taken& taken) {
  std::string nouns;
  for (const FileKind kind : taken.kinds) {
    nouns += (nouns.empty() ? "" : " or ") + std::string(WordsOf(kind).noun);
  }
  return nouns;
}

}  // namespace

FileKind KindOfFile(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return FileKind::kUnknown;
  if (fs::is_directory(path, ignored)) return KindOfFolder(path);
  const std::string beginning = Beginning(path), ending = Ending(path);
  const bool is_mcap = beginning.starts_with("\x89MCAP");
  if (is_mcap || beginning.starts_with("# vmech recording")) return FileKind::kRecording;
  if (beginning.starts_with("ISO-10303-21") || beginning.starts_with("<")) {
    return FileKind::kDrawing;
  }
  if (ending == ".csv") return FileKind::kTable;
  try {
    return KindByKeys(path);
  } catch (const FileErrors&) {
    return FileKind::kUnknown;
  }
}

void RefuseOtherKinds(const Taken& taken, const fs::path& path) {
  const FileKind kind = KindOfFile(path);
  if (kind == FileKind::kUnknown || Takes(taken, kind)) return;
  const Words& words = WordsOf(kind);
  std::string message = fmt::format("is {}, {}; `vmech {}` takes {}", words.noun, words.use,
                                    taken.command, NounsOf(taken));
  if (kind == FileKind::kStudy && Takes(taken, FileKind::kMechanism)) {
    const std::string mechanism = MechanismOf(path);
    if (!mechanism.empty()) message += fmt::format(", such as {}, which it names", mechanism);
  }
  throw FileErrors(path.string(), message);
}

}  // namespace vmech
