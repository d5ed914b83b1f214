#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

#include "vmech/mechanisms/files/document.h"

namespace vmech {

/// What a path leads to, as far as commands are concerned.
enum class FileKind {
  kUnknown,
  kMechanism,
  kStudy,
  kSuite,
  kLoops,      ///< of `vmech import --loops`
  kRecording,  ///< of `vmech haptic --record`
  kTable,      ///< CSV
  kDrawing,    ///< STEP, SDFormat, URDF: for `vmech import`
  kResults,    ///< a folder with a report
  kFolder,
};

/// By what it begins with, its keys or its ending; kUnknown also for what cannot be read.
FileKind KindOfFile(const std::filesystem::path& path);

/// What a command takes.
struct Taken {
  std::string_view command;
  std::initializer_list<FileKind> kinds;
};

/// @throws FileErrors if the file is of another known kind: which, what runs it, and what the
/// command takes instead.
void RefuseOtherKinds(const Taken& taken, const std::filesystem::path& path);

/// Reads a file; what is wrong with a file of another kind is its kind.
template <typename Read>
auto ReadAs(const Taken& taken, const std::filesystem::path& path, Read read) {
  try {
    return read(path);
  } catch (const FileErrors&) {
    RefuseOtherKinds(taken, path);
    throw;
  }
}

}  // namespace vmech
