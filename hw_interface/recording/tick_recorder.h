#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "vmech/hw_interface/recording/record_ring.h"
#include "vmech/hw_interface/recording/recording_writer.h"
#include "vmech/hw_interface/recording/tick_listener.h"

namespace vmech {

/// Where a session is written while it runs.
struct RecorderOptions {
  /// Where the session is written while it runs: an open file, which stays the caller's; -1:
  /// nowhere.
  int file = -1;
  std::string name;    ///< of that file: it says in which format, and stands in messages
  double room = 2;     ///< how much of the session may wait to be written [s], in [0.01, 100]
  bool waits = false;  ///< a loop that is ahead of the disk waits: for loops in simulated time
  /// Called from the recorder's thread at once when the file cannot be written, with the reason.
  std::function<void(const std::string&)> on_failure;
  std::vector<TickListener*> listeners;  ///< called from the recorder's thread

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// Hands the ticks of a loop to a thread of its own, which writes them and lets others look at
/// them. The loop never waits, unless it is told to: what there is no room for is counted. Twice a
/// second all that came is written out, so that a killed process loses at most the last second. A
/// file that cannot be written ends with its last whole row and is not written any more.
class TickRecorder {
 public:
  /// @throws std::invalid_argument as Validate.
  TickRecorder(const RecordingHeader& header, RecorderOptions options);
  ~TickRecorder();
  TickRecorder(const TickRecorder&) = delete;
  TickRecorder& operator=(const TickRecorder&) = delete;

  /// Takes a tick from the loop, without waiting unless RecorderOptions::waits.
  void Take(const TickRecord& tick) noexcept;
  /// Writes what is left and the end of the file, down to the disk. Nothing can be taken any more.
  void Finish();

  /// Ticks that found no room.
  std::uint64_t lost() const noexcept { return lost_; }
  /// Ticks in the file; after Finish.
  std::uint64_t written() const noexcept { return written_; }
  /// Why the file could not be written; after Finish. Empty: it could.
  const std::string& failure() const noexcept { return failure_; }

 private:
  void Run();
  bool TakeOne();
  void Write();
  void WriteEnd();
  void Fail(int error, std::size_t done);

  RecorderOptions options_;
  RecordRing ring_;
  std::unique_ptr<RecordingWriter> writer_;  // none: nothing is written, or not any more
  std::string bytes_;                        // to be written
  std::uint64_t written_ = 0;
  std::string failure_;
  std::atomic<std::uint64_t> lost_ = 0;
  std::atomic<bool> finishing_ = false;
  std::thread thread_;
};

}  // namespace vmech
