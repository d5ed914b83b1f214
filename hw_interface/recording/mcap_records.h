#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vmech {

/// Pieces of MCAP files (https://mcap.dev/spec, version 0): numbers little-endian, strings and byte
/// arrays behind their length, every record as opcode, length and content.

inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// The kinds of records, by the first byte of each.
enum class McapOpcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// The cyclic redundancy check of Ethernet and zip (IEEE 802.3, reflected), continued over bytes;
/// 0 to start with.
std::uint32_t Crc32(std::uint32_t crc, std::string_view bytes) noexcept;

/// Content of a record, field by field.
class McapFields {
 public:
  McapFields& U8(std::uint8_t value) { return Number(value, 1); }    ///< little end first
  McapFields& U16(std::uint16_t value) { return Number(value, 2); }  ///< little end first
  McapFields& U32(std::uint32_t value) { return Number(value, 4); }  ///< little end first
  McapFields& U64(std::uint64_t value) { return Number(value, 8); }  ///< little end first
  /// Behind its length as four bytes: strings, maps, arrays, schemas.
  McapFields& Text(std::string_view text) {
    U32(static_cast<std::uint32_t>(text.size()));
    return Raw(text);
  }
  /// Behind its length as eight bytes.
  McapFields& Bytes(std::string_view bytes) {
    U64(bytes.size());
    return Raw(bytes);
  }
  /// Without a length.
  McapFields& Raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }  ///< what was written so far

 private:
  McapFields& Number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xFF);
    return *this;
  }
  std::string bytes_;
};

/// A whole record.
std::string McapRecord(McapOpcode opcode, std::string_view content);

/// Reads content field by field. @throws std::runtime_error where it ends too early.
class McapCursor {
 public:
  explicit McapCursor(std::string_view bytes) : rest_(bytes) {}  ///< a view: they must outlive it

  std::uint8_t U8() { return static_cast<std::uint8_t>(Number(1)); }     ///< little end first
  std::uint16_t U16() { return static_cast<std::uint16_t>(Number(2)); }  ///< little end first
  std::uint32_t U32() { return static_cast<std::uint32_t>(Number(4)); }  ///< little end first
  std::uint64_t U64() { return Number(8); }                              ///< little end first
  std::string_view Text() { return Take(U32()); }   ///< behind a length of four bytes
  std::string_view Bytes() { return Take(U64()); }  ///< behind a length of eight bytes
  std::string_view Take(std::uint64_t size);        ///< that many bytes
  std::string_view rest() const { return rest_; }   ///< not read yet
  bool done() const { return rest_.empty(); }       ///< nothing is left

 private:
  std::uint64_t Number(int size);
  std::string_view rest_;
};

}  // namespace vmech
