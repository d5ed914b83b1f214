#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "vmech/hw_interface/udp_wire.h"

namespace {

std::uint32_t Crc32(const uint8_t* data, size_t size) {
  std::uint32_t c = ~0u;
  for (size_t i = 0; i < size; ++i) {
    c ^= data[i];
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ (0xEDB88320u & (0u - (c & 1)));
  }
  return ~c;
}

/// A packet that is accepted says the same after it has been written again.
void CheckRoundTrip(const vmech::Packet& packet) {
  vmech::PacketBytes once, twice;
  const size_t size = vmech::Encode(packet, &once);
  vmech::Packet again;
  if (!vmech::Decode({once.data(), size}, &again)) std::abort();
  if (vmech::Encode(again, &twice) != size) std::abort();
  if (std::memcmp(once.data(), twice.data(), size) != 0) std::abort();
}

}  // namespace

/// Any bytes, and any bytes with their checksum put right, are refused or make a sound packet.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  vmech::Packet packet;
  if (vmech::Decode({reinterpret_cast<const std::byte*>(data), size}, &packet)) {
    CheckRoundTrip(packet);
  }
  vmech::PacketBytes sealed;
  if (size + 4 > sealed.size()) return 0;
  const std::uint32_t crc = Crc32(data, size);
  std::memcpy(sealed.data(), data, size);
  std::memcpy(sealed.data() + size, &crc, 4);
  if (vmech::Decode({sealed.data(), size + 4}, &packet)) CheckRoundTrip(packet);
  return 0;
}
