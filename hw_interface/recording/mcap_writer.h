#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/hw_interface/recording/columns.h"
#include "vmech/hw_interface/recording/recording_writer.h"

namespace vmech {

/// A recording in MCAP, for Foxglove, Rerun and the libraries of https://mcap.dev: JSON messages
/// with JSON Schema, in uncompressed chunks with CRC and index.
///
///   vmech/tick   every tick, a member per column of the table
///   tf           foxglove.FrameTransforms: hand and grasp in the world, some 50 times a second
///
/// The header is the metadata "vmech recording", the mechanism the attachment "mechanism.yaml".
/// Of every chunk some 100 bytes of index are kept until the end.
class McapWriter : public RecordingWriter {
 public:
  explicit McapWriter(RecordingHeader header);  ///< of the whole recording

  void Begin(std::string* bytes) override;
  void Add(const TickRecord& tick, std::string* bytes) override;  ///< into the chunk that is open
  void Flush(std::string* bytes) override;
  std::uint64_t whole() const override { return whole_; }
  void End(std::uint64_t lost, std::string* bytes) override;

 private:
  static constexpr int kChannels = 2;

  void AttachMechanism(std::string* bytes);
  void AddMessage(int channel, std::uint64_t time, std::string_view json);
  void Emit(std::string_view data, std::string* bytes);
  void AddMetadata(const char* name, const std::string& map, std::string* bytes);
  std::string Statistics() const;

  RecordingHeader header_;
  std::vector<Column> columns_;
  std::array<std::string, kChannels> schemas_, channels_;  // records
  std::string chunk_, json_;
  std::array<std::string, kChannels> chunk_entries_;  // time and offset of every message in it
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;     // [ns]
  std::uint64_t written_ = 0;                         // bytes of the file
  std::uint32_t data_crc_ = 0, chunks_ = 0, metadata_ = 0;
  std::uint64_t start_ = 0, end_ = 0, next_transforms_ = 0;  // [ns]
  std::array<std::uint64_t, kChannels> messages_{};
  std::uint64_t whole_ = 0;
  std::string chunk_indexes_, metadata_index_, attachment_index_;
};

}  // namespace vmech
