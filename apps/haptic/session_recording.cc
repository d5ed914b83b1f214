#include "vmech/apps/haptic/session_recording.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {
namespace {

/// A file to write into, empty and ours alone. Devices and pipes are no old files.
PathLock OpenFor(const SessionRecordingOptions& options) {
  if (options.file.empty()) return {};
  const std::string shown = options.file.string();
  try {
    PathLock lock(options.file, O_WRONLY | O_CREAT, options.file);
    struct stat status;
    const bool regular = fstat(lock.file(), &status) == 0 && S_ISREG(status.st_mode);
    if (regular && status.st_size > 0 && !options.force) {
      throw FileErrors(shown,
                       "is there already and is not written over; give --record another "
                       "name, or --force");
    }
    if (regular && ftruncate(lock.file(), 0) != 0) {
      throw std::system_error(errno, std::generic_category());
    }
    return lock;
  } catch (const std::system_error& error) {
    throw FileErrors(shown, fmt::format("cannot be written: {}; give --record another place",
                                        error.code().message()));
  }
}

}  // namespace

SessionRecording::SessionRecording(const SessionRecordingOptions& options,
                                   const KinematicTree& tree, int grasp, Runner* runner)
    : file_(options.file),
      lock_(OpenFor(options)),
      held_(tree, grasp, runner->Header().Number("gripper", 0) != 0),
      felt_(runner->Header(), held_),
      tells_felt_(runner->Header().hands() == 1) {
  RecorderOptions recorder;
  recorder.file = lock_.file();
  recorder.name = file_.string();
  recorder.waits = options.waits;
  if (tells_felt_) recorder.listeners = {&felt_};
  recorder.on_failure = [runner](const std::string& reason) {
    fmt::print(stderr, "\n{}: the recording ends here, and so does the session\n", reason);
    runner->Stop();
  };
  recorder_.emplace(runner->Header(), std::move(recorder));
  runner->SetRecorder(&*recorder_);
}

void SessionRecording::RequireWritten() const {
  if (recorder_->failure().empty()) return;
  throw FileErrors(
      file_.string(),
      fmt::format("cannot be written ({}); the first {} ticks are in it. Make room, or "
                  "give --record another place",
                  recorder_->failure(), recorder_->written()));
}

std::string SessionRecording::Report() const {
  const FeltReport felt = felt_.Report();
  std::string text = tells_felt_ ? felt.Text() + "  verdict: " + felt.Verdict() + "\n" : "";
  if (!file_.empty()) {
    text += fmt::format("  recorded {} ticks, lost {}{}\n", recorder_->written(), recorder_->lost(),
                        recorder_->lost() > 0 ? ": the disk was too slow for the session" : "");
  }
  return text;
}

}  // namespace vmech
