#include "vmech/hw_interface/recording/tick_recorder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "vmech/base/check_range.h"
#include "vmech/hw_interface/recording/recording_file.h"

namespace vmech {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kBetweenFlushes(500), kPause(5);
constexpr std::size_t kEnough = 1 << 18;  // bytes for a write

std::size_t RoomFor(const RecorderOptions& options, double period) {
  options.Validate();
  return static_cast<std::size_t>(std::ceil(options.room / period)) + 64;
}

}  // namespace

void RecorderOptions::Validate() const {
  CheckRange("RecorderOptions", "room", room, 0.01, 100);
}

TickRecorder::TickRecorder(const RecordingHeader& header, RecorderOptions options)
    : options_(std::move(options)),
      ring_(RoomFor(options_, header.period), header.EmptyTick()),
      writer_(options_.file >= 0 ? MakeRecordingWriter(options_.name, header) : nullptr) {
  if (writer_) writer_->Begin(&bytes_);
  thread_ = std::thread([this] { Run(); });
}

TickRecorder::~TickRecorder() {
  Finish();
}

void TickRecorder::Take(const TickRecord& tick) noexcept {
  while (!ring_.Put(tick)) {
    if (!options_.waits) {
      ++lost_;
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

void TickRecorder::Finish() {
  if (!thread_.joinable()) return;
  finishing_ = true;
  thread_.join();
}

void TickRecorder::Run() {
  Write();
  Clock::time_point flushed = Clock::now();
  while (true) {
    const bool last = finishing_;
    while (TakeOne()) {
      if (bytes_.size() >= kEnough) Write();
    }
    if (last) break;
    if (Clock::now() - flushed > kBetweenFlushes) {
      if (writer_) writer_->Flush(&bytes_);
      Write();
      flushed = Clock::now();
    }
    std::this_thread::sleep_for(kPause);
  }
  WriteEnd();
}

bool TickRecorder::TakeOne() {
  const TickRecord* tick = ring_.Oldest();
  if (tick == nullptr) return false;
  if (writer_) writer_->Add(*tick, &bytes_);
  for (TickListener* listener : options_.listeners) listener->Take(*tick);
  ring_.Drop();
  return true;
}

void TickRecorder::Write() {
  std::size_t done = 0;
  while (writer_ && done < bytes_.size()) {
    const ssize_t count = write(options_.file, bytes_.data() + done, bytes_.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      return Fail(errno, done);
    }
  }
  if (writer_) written_ = writer_->whole();
  bytes_.clear();
}

/// Of the bytes `done` are in the file, which is to end where these began.
void TickRecorder::Fail(int error, std::size_t done) {
  const off_t end = lseek(options_.file, 0, SEEK_CUR);
  const bool is_cut = end >= 0 && ftruncate(options_.file, end - static_cast<off_t>(done)) == 0;
  failure_ = fmt::format("{}: {}", options_.name, std::strerror(error));
  if (!is_cut) failure_ += "; it may end within a row";
  writer_.reset();
  bytes_.clear();
  if (options_.on_failure) options_.on_failure(failure_);
}

void TickRecorder::WriteEnd() {
  if (!writer_) return;
  writer_->End(lost_, &bytes_);
  Write();
  if (!writer_) return;
  const bool whole = fsync(options_.file) == 0 || errno == EINVAL || errno == EROFS;
  if (!whole) Fail(errno, 0);
}

}  // namespace vmech
