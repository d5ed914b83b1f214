#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "vmech/apps/files/file_kind.h"
#include "vmech/hw_interface/audit/audit.h"
#include "vmech/hw_interface/recording/recording_reader.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {

/// What is told of a recording from its numbers alone.
struct AuditedRecording {
  AuditReport report;
  std::string felt;          ///< what one hand felt, in lines; empty for several hands
  std::string felt_verdict;  ///< the same in a sentence
  std::string state;         ///< what is missing in it, in lines; may be empty
};

/// Reads a recording for a command. @throws FileErrors: one that cannot be read is bad input.
template <typename Read>
auto ReadRecordingFor(const char* command, const std::filesystem::path& file, const Read& read) {
  return ReadAs({command, {FileKind::kRecording}}, file, [&](const std::filesystem::path& path) {
    try {
      return read(path);
    } catch (const std::runtime_error& error) {
      throw FileErrors({{error.what(), 0, 0, "", "a recording of `vmech haptic` is wanted"}});
    }
  });
}

/// Reads a recording to its end; `see`: told of every tick, after the audit has taken it.
/// @throws std::runtime_error as the reader; std::invalid_argument as RecordedTree.
AuditedRecording AuditRecording(
    RecordingReader* reader,
    const std::function<void(const TickRecord&, const RecordingAudit&)>& see = {});

/// The page of a recording: the motion that was recorded, and in plots beside it what the audit
/// computes anew, energy, closure of the loops and work of the constraints, with its verdict.
/// @throws as AuditRecording.
std::string RecordingPage(const std::filesystem::path& file);

}  // namespace vmech
