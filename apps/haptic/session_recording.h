#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "vmech/apps/files/path_lock.h"
#include "vmech/hw_interface/audit/felt.h"
#include "vmech/hw_interface/loop/runner.h"

namespace vmech {

struct SessionRecordingOptions {
  std::filesystem::path file;  ///< empty: nothing is written
  bool force = false;          ///< write over an old file
  bool waits = false;          ///< as RecorderOptions
};

/// What is written of a session while it runs, and what the session tells of itself.
class SessionRecording {
 public:
  /// Opens the file and waits for the runner's ticks. A file that cannot be written any more stops
  /// the runner, and is said on stderr at once.
  /// @throws FileErrors if the file is there already, is being written, or cannot be opened.
  SessionRecording(const SessionRecordingOptions& options, const KinematicTree& tree, int grasp,
                   Runner* runner);

  /// After the run; then the others.
  void Finish() { recorder_->Finish(); }
  /// The mechanism was not the same all the time: what was felt is told of no one.
  void ForgetFelt() { tells_felt_ = false; }
  /// What was felt, withheld and recorded, in lines.
  std::string Report() const;
  /// @throws FileErrors if the recording could not be written to its end.
  void RequireWritten() const;

 private:
  std::filesystem::path file_;
  PathLock lock_;
  RecordedTree held_;
  FeltFit felt_;
  bool tells_felt_;  // of a hand whose force alone moves the mechanism
  std::optional<TickRecorder> recorder_;
};

}  // namespace vmech
