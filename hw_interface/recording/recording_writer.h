#pragma once

#include <cstdint>
#include <string>

#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// A session as the bytes of a file, piece by piece: what is appended to `bytes` is to be written
/// behind what was appended before.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  /// Once, first.
  virtual void Begin(std::string* bytes) = 0;
  /// Bytes that are whole are appended.
  virtual void Add(const TickRecord& tick, std::string* bytes) = 0;
  /// Whatever was added is whole in the bytes: of a file that ends here nothing is lost.
  virtual void Flush(std::string* bytes) = 0;
  /// Ticks that are whole in the bytes.
  virtual std::uint64_t whole() const = 0;
  /// Once, last: how many ticks the recording lacks.
  virtual void End(std::uint64_t lost, std::string* bytes) = 0;
};

}  // namespace vmech
