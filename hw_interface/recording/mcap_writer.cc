#include "vmech/hw_interface/recording/mcap_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vmech/hw_interface/recording/header_items.h"
#include "vmech/hw_interface/recording/mcap_records.h"

namespace vmech {
namespace {

constexpr size_t kLargestChunk = 1 << 20;
constexpr std::uint64_t kBetweenTransforms = 20'000'000;  // [ns]
constexpr std::array<const char*, 2> kTopics{"vmech/tick", "tf"};
constexpr std::array<const char*, 2> kSchemas{"vmech.Tick", "foxglove.FrameTransforms"};

/// One transform of foxglove.FrameTransforms, as its public schema has it.
constexpr const char* kTransformsSchema = R"({"title":"foxglove.FrameTransforms","type":"object",
"properties":{"transforms":{"type":"array","items":{"type":"object","properties":{
"timestamp":{"type":"object","title":"time","properties":{
"sec":{"type":"integer","minimum":0},"nsec":{"type":"integer","minimum":0,"maximum":999999999}}},
"parent_frame_id":{"type":"string"},"child_frame_id":{"type":"string"},
"translation":{"title":"foxglove.Vector3","type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},
"rotation":{"title":"foxglove.Quaternion","type":"object","properties":{
"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}}})";

const char* TypeOf(CellKind kind) {
  switch (kind) {
    case CellKind::kNumber:
      return R"(["number","null"])";
    case CellKind::kInteger:
      return R"("integer")";
    case CellKind::kFlag:
      return R"("boolean")";
    case CellKind::kName:
      return R"(["string","integer"])";
  }
  return "";
}

std::string TickSchema(const std::vector<Column>& columns) {
  std::string properties;
  for (const Column& column : columns) {
    if (!properties.empty()) properties += ",\n";
    properties += fmt::format(R"("{}":{{"type":{}}})", column.name, TypeOf(column.kind));
  }
  return fmt::format("{{\"title\":\"vmech.Tick\",\"type\":\"object\",\"properties\":{{\n{}}}}}",
                     properties);
}

std::string TransformJson(const Posed& X, const std::string& frame, std::uint64_t time) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const Eigen::Quaterniond turn(X.R);
  return fmt::format(
      R"({{"timestamp":{{"sec":{},"nsec":{}}},"parent_frame_id":"world","child_frame_id":"{}",)"
      R"("translation":{{"x":{},"y":{},"z":{}}},"rotation":{{"x":{},"y":{},"z":{},"w":{}}}}})",
      time / kSecond, time % kSecond, frame, X.p.x(), X.p.y(), X.p.z(), turn.x(), turn.y(),
      turn.z(), turn.w());
}

/// Frames hand and grasp, of a second hand "hand 2" and "grasp 2".
std::string TransformsJson(const TickPicture& picture, std::uint64_t time) {
  std::string text;
  for (int i = 0; i <= static_cast<int>(picture.others.size()); ++i) {
    const std::string number = i == 0 ? "" : fmt::format(" {}", i + 1);
    const HandPicture& hand = picture.hand(i);
    if (i > 0) text += ',';
    text += TransformJson(hand.X_WH, "hand" + number, time) + ',' +
            TransformJson(hand.X_WG, "grasp" + number, time);
  }
  return fmt::format(R"({{"transforms":[{}]}})", text);
}

std::string MapOf(const HeaderItems& items) {
  McapFields map;
  for (const auto& [key, text] : items) map.Text(key).Text(text);
  return map.bytes();
}

/// The summary at the end of a file, group after group of equal records.
class Summary {
 public:
  explicit Summary(std::uint64_t start) : start_(start) {}

  void Add(McapOpcode opcode, std::string_view records) {
    if (records.empty()) return;
    McapFields offset;
    offset.U8(static_cast<std::uint8_t>(opcode)).U64(start_ + text_.size()).U64(records.size());
    offsets_ += McapRecord(McapOpcode::kSummaryOffset, offset.bytes());
    text_ += records;
  }
  /// With the places of the groups and the footer, to the end of the file.
  std::string Close() const {
    constexpr std::uint64_t kFooterSize = 20;
    const std::string summary = text_ + offsets_;
    McapFields footer;
    footer.U8(static_cast<std::uint8_t>(McapOpcode::kFooter)).U64(kFooterSize);
    footer.U64(start_).U64(start_ + text_.size());
    footer.U32(Crc32(Crc32(0, summary), footer.bytes()));
    return summary + footer.bytes() + std::string(kMcapMagic);
  }

 private:
  std::uint64_t start_;
  std::string text_, offsets_;
};

}  // namespace

McapWriter::McapWriter(RecordingHeader header)
    : header_(std::move(header)), columns_(ColumnsOf(header_)) {
  for (int c = 0; c < kChannels; ++c) {
    const auto id = static_cast<std::uint16_t>(c + 1);
    const std::string schema = c == 0 ? TickSchema(columns_) : kTransformsSchema;
    schemas_[c] =
        McapRecord(McapOpcode::kSchema,
                   McapFields().U16(id).Text(kSchemas[c]).Text("jsonschema").Text(schema).bytes());
    channels_[c] =
        McapRecord(McapOpcode::kChannel,
                   McapFields().U16(id).U16(id).Text(kTopics[c]).Text("json").Text("").bytes());
  }
}

void McapWriter::Emit(std::string_view data, std::string* bytes) {
  *bytes += data;
  written_ += data.size();
  data_crc_ = Crc32(data_crc_, data);
}

void McapWriter::Begin(std::string* bytes) {
  Emit(kMcapMagic, bytes);
  Emit(McapRecord(McapOpcode::kHeader, McapFields().Text("").Text("vmech").bytes()), bytes);
  HeaderItems items = ItemsOf(header_);
  items.emplace(items.begin(), "format", fmt::to_string(kRecordingFormat));
  AddMetadata("vmech recording", MapOf(items), bytes);
  if (!header_.mechanism.text.empty()) AttachMechanism(bytes);
}

void McapWriter::AttachMechanism(std::string* bytes) {
  const std::string& text = header_.mechanism.text;
  constexpr const char *kName = "mechanism.yaml", *kType = "application/yaml";
  McapFields attachment, index;
  attachment.U64(0).U64(0).Text(kName).Text(kType).Bytes(text);
  attachment.U32(Crc32(0, attachment.bytes()));
  const std::string record = McapRecord(McapOpcode::kAttachment, attachment.bytes());
  index.U64(written_).U64(record.size()).U64(0).U64(0).U64(text.size()).Text(kName).Text(kType);
  attachment_index_ = McapRecord(McapOpcode::kAttachmentIndex, index.bytes());
  Emit(record, bytes);
}

void McapWriter::AddMetadata(const char* name, const std::string& map, std::string* bytes) {
  const std::string record =
      McapRecord(McapOpcode::kMetadata, McapFields().Text(name).Text(map).bytes());
  metadata_index_ += McapRecord(McapOpcode::kMetadataIndex,
                                McapFields().U64(written_).U64(record.size()).Text(name).bytes());
  ++metadata_;
  Emit(record, bytes);
}

void McapWriter::AddMessage(int channel, std::uint64_t time, std::string_view json) {
  if (messages_[channel] == 0) chunk_ += schemas_[channel] + channels_[channel];
  chunk_entries_[channel] += McapFields().U64(time).U64(chunk_.size()).bytes();
  McapFields message;
  message.U16(static_cast<std::uint16_t>(channel + 1))
      .U32(static_cast<std::uint32_t>(messages_[channel]))
      .U64(time)
      .U64(time)
      .Raw(json);
  chunk_ += McapRecord(McapOpcode::kMessage, message.bytes());
  ++messages_[channel];
}

void McapWriter::Add(const TickRecord& tick, std::string* bytes) {
  const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(tick.state.host_time_ns, 0));
  const bool first_of_chunk = chunk_.empty();
  const bool first = first_of_chunk && chunks_ == 0;
  chunk_start_ = first_of_chunk ? time : std::min(chunk_start_, time);
  chunk_end_ = first_of_chunk ? time : std::max(chunk_end_, time);
  start_ = first ? time : std::min(start_, time);
  end_ = first ? time : std::max(end_, time);
  json_ = '{';
  AppendMembers(header_, columns_, tick, &json_);
  json_ += '}';
  AddMessage(0, time, json_);
  if (first || time >= next_transforms_) {
    AddMessage(1, time, TransformsJson(tick.picture, time));
    next_transforms_ = time + kBetweenTransforms;
  }
  if (chunk_.size() >= kLargestChunk) Flush(bytes);
}

void McapWriter::Flush(std::string* bytes) {
  if (chunk_.empty()) return;
  McapFields chunk;
  chunk.U64(chunk_start_).U64(chunk_end_).U64(chunk_.size()).U32(Crc32(0, chunk_));
  chunk.Text("").Bytes(chunk_);
  const std::string record = McapRecord(McapOpcode::kChunk, chunk.bytes());
  const std::uint64_t chunk_offset = written_;
  Emit(record, bytes);
  McapFields offsets;
  const std::uint64_t indexes = written_;
  for (int c = 0; c < kChannels; ++c) {
    if (chunk_entries_[c].empty()) continue;
    const auto id = static_cast<std::uint16_t>(c + 1);
    offsets.U16(id).U64(written_);
    Emit(
        McapRecord(McapOpcode::kMessageIndex, McapFields().U16(id).Text(chunk_entries_[c]).bytes()),
        bytes);
    chunk_entries_[c].clear();
  }
  McapFields index;
  index.U64(chunk_start_).U64(chunk_end_).U64(chunk_offset).U64(record.size());
  index.Text(offsets.bytes()).U64(written_ - indexes);
  index.Text("").U64(chunk_.size()).U64(chunk_.size());
  chunk_indexes_ += McapRecord(McapOpcode::kChunkIndex, index.bytes());
  ++chunks_;
  whole_ = messages_[0];
  chunk_.clear();
}

std::string McapWriter::Statistics() const {
  McapFields counts;
  std::uint64_t all = 0;
  std::uint16_t channels = 0;
  for (int c = 0; c < kChannels; ++c) {
    if (messages_[c] == 0) continue;
    counts.U16(static_cast<std::uint16_t>(c + 1)).U64(messages_[c]);
    all += messages_[c];
    ++channels;
  }
  McapFields statistics;
  statistics.U64(all).U16(channels).U32(channels);
  statistics.U32(attachment_index_.empty() ? 0 : 1).U32(metadata_).U32(chunks_);
  statistics.U64(start_).U64(end_).Text(counts.bytes());
  return McapRecord(McapOpcode::kStatistics, statistics.bytes());
}

void McapWriter::End(std::uint64_t lost, std::string* bytes) {
  Flush(bytes);
  const HeaderItems end{{"ticks", fmt::to_string(messages_[0])}, {"lost", fmt::to_string(lost)}};
  AddMetadata("vmech end", MapOf(end), bytes);
  Emit(McapRecord(McapOpcode::kDataEnd, McapFields().U32(data_crc_).bytes()), bytes);
  std::string schemas, channels;
  for (int c = 0; c < kChannels; ++c) {
    if (messages_[c] == 0) continue;
    schemas += schemas_[c];
    channels += channels_[c];
  }
  Summary summary(written_);
  summary.Add(McapOpcode::kSchema, schemas);
  summary.Add(McapOpcode::kChannel, channels);
  summary.Add(McapOpcode::kStatistics, Statistics());
  summary.Add(McapOpcode::kChunkIndex, chunk_indexes_);
  summary.Add(McapOpcode::kMetadataIndex, metadata_index_);
  summary.Add(McapOpcode::kAttachmentIndex, attachment_index_);
  *bytes += summary.Close();
}

}  // namespace vmech
