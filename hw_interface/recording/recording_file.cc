#include "vmech/hw_interface/recording/recording_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "vmech/hw_interface/recording/columns.h"
#include "vmech/hw_interface/recording/header_items.h"
#include "vmech/hw_interface/recording/mcap_writer.h"
#include "vmech/hw_interface/recording/recording_reader.h"

namespace vmech {
namespace {

/// A table: comment lines, a line of names, a line per tick, and a last comment.
class CsvWriter : public RecordingWriter {
 public:
  explicit CsvWriter(RecordingHeader header) : header_(std::move(header)) {}

  void Begin(std::string* bytes) override {
    *bytes += fmt::format("# vmech recording {}\n", kRecordingFormat);
    for (const auto& [key, text] : ItemsOf(header_)) *bytes += fmt::format("# {} {}\n", key, text);
    AddMechanism(header_.mechanism.text, bytes);
    for (const Column& column : ColumnsOf(header_)) *bytes += column.name + ',';
    bytes->back() = '\n';
  }
  void Add(const TickRecord& tick, std::string* bytes) override {
    AppendRow(header_, tick, bytes);
    *bytes += '\n';
    ++ticks_;
  }
  void Flush(std::string* /*bytes*/) override {}
  std::uint64_t whole() const override { return ticks_; }
  void End(std::uint64_t lost, std::string* bytes) override {
    *bytes += fmt::format("# end {} ticks, {} lost\n", ticks_, lost);
  }

 private:
  static void AddMechanism(std::string_view text, std::string* bytes) {
    while (!text.empty()) {
      const std::string_view line = text.substr(0, text.find('\n'));
      *bytes += fmt::format("#: {}\n", line);
      text.remove_prefix(std::min(text.size(), line.size() + 1));
    }
  }

  RecordingHeader header_;
  std::uint64_t ticks_ = 0;
};

}  // namespace

std::unique_ptr<RecordingWriter> MakeRecordingWriter(const std::filesystem::path& file,
                                                     const RecordingHeader& header) {
  RecordingHeader plain = WithPlainNames(header);
  plain.format = kRecordingFormat;
  if (file.extension() == ".mcap") return std::make_unique<McapWriter>(std::move(plain));
  return std::make_unique<CsvWriter>(std::move(plain));
}

void WriteRecording(const std::filesystem::path& file, const Recording& recording) {
  std::ofstream out(file, std::ios::binary);
  const std::unique_ptr<RecordingWriter> writer = MakeRecordingWriter(file, recording);
  std::string bytes;
  writer->Begin(&bytes);
  for (const TickRecord& tick : recording.ticks) {
    writer->Add(tick, &bytes);
    out << bytes;
    bytes.clear();
  }
  writer->End(recording.lost, &bytes);
  out << bytes;
  if (!out.flush()) {
    throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
  }
}

Recording ReadRecording(const std::filesystem::path& file, RecordingPart part) {
  RecordingReader reader(file);
  Recording recording{reader.header(), {}};
  TickRecord tick = recording.EmptyTick();
  while (reader.Next(&tick)) {
    TickRecord& kept = recording.ticks.emplace_back(tick);
    if (part == RecordingPart::kWhole) continue;
    kept.picture = {};
    kept.channels = {};
  }
  recording.complete = reader.complete();
  recording.lost = reader.lost();
  return recording;
}

}  // namespace vmech
