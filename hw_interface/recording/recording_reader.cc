#include "vmech/hw_interface/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "vmech/hw_interface/recording/header_items.h"
#include "vmech/hw_interface/recording/mcap_records.h"

namespace vmech {

class RecordingReader::Source {
 public:
  virtual ~Source() = default;
  virtual void ReadHeader(RecordingHeader* header) = 0;
  /// Reads the next row into the tick. False: there are no more.
  virtual bool Next(const RecordingHeader& header, const std::vector<Column>& columns,
                    TickRecord* tick) = 0;
  virtual std::string Place() const = 0;

  bool complete = false;
  std::uint64_t lost = 0;
};

namespace {

using Source = RecordingReader::Source;

constexpr std::string_view kFirstLine = "# vmech recording ";

std::string NameLine(const RecordingHeader& header) {
  std::string line;
  for (const Column& column : ColumnsOf(header)) line += (line.empty() ? "" : ",") + column.name;
  return line;
}

/// Of format 1, whose channels are the columns after those that every recording has.
std::vector<std::string> ChannelsAfter(const std::string& fixed, std::string_view names) {
  std::vector<std::string> channels;
  names.remove_prefix(fixed.size());
  while (!names.empty()) {
    names.remove_prefix(1);
    channels.emplace_back(names.substr(0, names.find(',')));
    names.remove_prefix(channels.back().size());
  }
  return channels;
}

class CsvSource : public Source {
 public:
  explicit CsvSource(const std::filesystem::path& file) : file_(file.string()), in_(file) {}

  void ReadHeader(RecordingHeader* header) override {
    NextLine();
    const bool first = line_.rfind(kFirstLine, 0) == 0;
    const std::string version = first ? line_.substr(kFirstLine.size()) : "";
    if (version != "1" && version != "2") {
      throw std::runtime_error("'# vmech recording 2' (or 1) expected");
    }
    header->format = version[0] - '0';
    bool has_period = false;
    while (NextLine() && line_.rfind('#', 0) == 0) {
      has_period |= line_.rfind("# period ", 0) == 0;
      TakeComment(header);
    }
    if (!has_period) throw std::runtime_error("'# period SECONDS' is missing above");
    TakeNames(header);
  }

  bool Next(const RecordingHeader& header, const std::vector<Column>& columns,
            TickRecord* tick) override {
    if (!NextLine()) return false;
    if (line_.rfind("# end ", 0) == 0) return TakeEnd(header);
    const bool cut = in_.eof();  // within the line
    if (cut && header.format > 1) return false;
    ReadRow(header, columns, line_, tick);
    return true;
  }

  std::string Place() const override { return fmt::format("{}:{}", file_, number_); }

 private:
  bool NextLine() {
    ++number_;
    return static_cast<bool>(std::getline(in_, line_));
  }
  void TakeComment(RecordingHeader* header) {
    if (line_.rfind("#:", 0) == 0) {
      header->mechanism.text += line_.substr(std::min<size_t>(line_.size(), 3)) + '\n';
    } else {
      TakeItem(std::string_view(line_).substr(2), header);
    }
  }
  void TakeNames(RecordingHeader* header) {
    const std::string fixed = NameLine(*header);
    if (header->format == 1 && line_.rfind(fixed + ',', 0) == 0) {
      header->channels = ChannelsAfter(fixed, line_);
    } else if (line_ != fixed) {
      throw std::runtime_error("these are not the columns of a recording");
    }
    complete = header->format == 1;  // which has no last line
  }
  bool TakeEnd(const RecordingHeader& header) {
    complete = true;
    const size_t comma = line_.find(", ");
    const std::string_view text =
        std::string_view(line_).substr(comma == std::string::npos ? line_.size() : comma + 2);
    if (header.format > 1) std::from_chars(text.data(), text.data() + text.size(), lost);
    return false;
  }

  std::string file_;
  std::ifstream in_;
  std::string line_;
  int number_ = 0;
};

class McapSource : public Source {
 public:
  explicit McapSource(const std::filesystem::path& file)
      : file_(file.string()), in_(file, std::ios::binary) {
    in_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(in_.tellg());
    in_.seekg(kMcapMagic.size());
  }

  void ReadHeader(RecordingHeader* header) override {
    while (NextRecord() && opcode_ != McapOpcode::kMetadata) {
    }
    McapCursor content(content_);
    if (opcode_ != McapOpcode::kMetadata || content.Text() != "vmech recording") {
      throw std::runtime_error("the metadata 'vmech recording' is expected first");
    }
    McapCursor map(content.Text());
    while (!map.done()) {
      const std::string_view key = map.Text(), text = map.Text();
      if (key == "format" && text != "2") {
        throw std::runtime_error(fmt::format("format {}: 2 expected", text));
      }
      if (key != "format") TakeItem(fmt::format("{} {}", key, text), header);
    }
    if (NextRecord() && opcode_ == McapOpcode::kAttachment) TakeAttachment(header);
  }

  bool Next(const RecordingHeader& header, const std::vector<Column>& columns,
            TickRecord* tick) override {
    while (true) {
      McapCursor chunk(std::string_view(chunk_).substr(in_chunk_));
      while (!chunk.done()) {
        const auto opcode = static_cast<McapOpcode>(chunk.U8());
        const std::string_view content = chunk.Bytes();
        in_chunk_ = chunk_.size() - chunk.rest().size();
        if (opcode == McapOpcode::kMessage && TakeMessage(content, header, columns, tick)) {
          return true;
        }
      }
      if (!NextChunk()) return false;
    }
  }

  std::string Place() const override { return fmt::format("{}: byte {}", file_, at_); }

 private:
  /// False at the end, in order or not.
  bool NextRecord() {
    at_ = static_cast<std::uint64_t>(in_.tellg());
    char head[9];
    if (!in_.read(head, sizeof(head))) return false;
    McapCursor cursor(std::string_view(head, sizeof(head)));
    opcode_ = static_cast<McapOpcode>(cursor.U8());
    const std::uint64_t length = cursor.U64();
    if (opcode_ == McapOpcode::kDataEnd || length > size_ - at_ - sizeof(head)) return false;
    content_.resize(length);
    return static_cast<bool>(in_.read(content_.data(), static_cast<std::streamsize>(length)));
  }

  bool NextChunk() {
    while (NextRecord()) {
      if (opcode_ == McapOpcode::kMetadata) TakeEnd();
      if (opcode_ != McapOpcode::kChunk) continue;
      McapCursor content(content_);
      content.Take(24);
      const std::uint32_t crc = content.U32();
      if (!content.Text().empty()) throw std::runtime_error("a compressed chunk; none is expected");
      chunk_ = content.Bytes();
      in_chunk_ = 0;
      if (Crc32(0, chunk_) != crc) throw std::runtime_error("a chunk with a wrong CRC: damaged");
      return true;
    }
    return false;
  }

  bool TakeMessage(std::string_view content, const RecordingHeader& header,
                   const std::vector<Column>& columns, TickRecord* tick) {
    McapCursor message(content);
    if (message.U16() != 1) return false;
    message.Take(20);
    const std::string_view json = message.rest();
    if (json.size() < 2 || json.front() != '{' || json.back() != '}') {
      throw std::runtime_error("a tick that is no JSON object");
    }
    ReadMembers(header, columns, json.substr(1, json.size() - 2), tick);
    return true;
  }

  void TakeAttachment(RecordingHeader* header) {
    McapCursor content(content_);
    content.Take(16);
    if (content.Text() != "mechanism.yaml") return;
    content.Text();
    header->mechanism.text = content.Bytes();
  }

  void TakeEnd() {
    McapCursor content(content_);
    if (content.Text() != "vmech end") return;
    complete = true;
    McapCursor map(content.Text());
    while (!map.done()) {
      const std::string_view key = map.Text(), text = map.Text();
      if (key == "lost") std::from_chars(text.data(), text.data() + text.size(), lost);
    }
  }

  std::string file_;
  std::ifstream in_;
  std::uint64_t size_ = 0, at_ = 0;
  McapOpcode opcode_{};
  std::string content_, chunk_;
  size_t in_chunk_ = 0;
};

std::unique_ptr<Source> Open(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
  char begin[8] = {};
  in.read(begin, sizeof(begin));
  if (std::string_view(begin, sizeof(begin)) == kMcapMagic) {
    return std::make_unique<McapSource>(file);
  }
  return std::make_unique<CsvSource>(file);
}

}  // namespace

RecordingReader::RecordingReader(const std::filesystem::path& file) : source_(Open(file)) {
  try {
    source_->ReadHeader(&header_);
    columns_ = ColumnsOf(header_);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", source_->Place(), error.what()));
  }
}

RecordingReader::~RecordingReader() = default;

bool RecordingReader::Next(TickRecord* tick) {
  try {
    return source_->Next(header_, columns_, tick);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", source_->Place(), error.what()));
  }
}

bool RecordingReader::complete() const {
  return source_->complete;
}

std::uint64_t RecordingReader::lost() const {
  return source_->lost;
}

}  // namespace vmech
