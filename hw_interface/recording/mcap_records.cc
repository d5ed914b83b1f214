#include "vmech/hw_interface/recording/mcap_records.h"

#include <array>
#include <stdexcept>

namespace vmech {
namespace {

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    table[i] = crc;
  }
  return table;
}();

}  // namespace

std::uint32_t Crc32(std::uint32_t crc, std::string_view bytes) noexcept {
  crc = ~crc;
  for (const char c : bytes) {
    crc = crc >> 8 ^ kCrcTable[(crc ^ static_cast<std::uint8_t>(c)) & 0xFF];
  }
  return ~crc;
}

std::string McapRecord(McapOpcode opcode, std::string_view content) {
  return McapFields().U8(static_cast<std::uint8_t>(opcode)).Bytes(content).bytes();
}

std::string_view McapCursor::Take(std::uint64_t size) {
  if (size > rest_.size()) throw std::runtime_error("a record ends too early");
  const std::string_view taken = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return taken;
}

std::uint64_t McapCursor::Number(int size) {
  std::uint64_t value = 0;
  const std::string_view bytes = Take(static_cast<std::uint64_t>(size));
  for (int i = 0; i < size; ++i) {
    value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
  }
  return value;
}

}  // namespace vmech
