#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "vmech/hw_interface/remote/udp_wire.h"

namespace {

using Bytes = std::vector<std::byte>;  // on the heap, so that a read past the end is seen

void Require(bool fact) {
  if (!fact) std::abort();
}

/// With the checksum that belongs to it, by another way than that of the decoder.
Bytes Sealed(Bytes bytes) {
  std::uint32_t crc = ~0u;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1)));
  }
  crc = ~crc;
  bytes.resize(bytes.size() + sizeof crc);
  std::memcpy(bytes.data() + bytes.size() - sizeof crc, &crc, sizeof crc);
  return bytes;
}

/// A sound packet, its kind by the first byte of the data, with some of its bytes replaced. The
/// rest of the data is a list of edits: where (two bytes, the highest bit for a whole word), what.
Bytes Edited(const Bytes& data) {
  vmech::UdpPacket packet;
  packet.header.kind = static_cast<vmech::PacketKind>(1 + std::to_integer<int>(data[0]) % 5);
  packet.info.name.assign(64, 'n');  // as long as the packet can hold, so ended by its last byte
  vmech::PacketBytes written;
  const std::size_t size = vmech::Encode(packet, &written) - sizeof(std::uint32_t);
  Bytes bytes(written.begin(), written.begin() + size);
  for (std::size_t i = 1; i + 2 < data.size();) {
    const auto where = std::to_integer<std::size_t>(data[i] & std::byte{0x7F}) << 8 |
                       std::to_integer<std::size_t>(data[i + 1]);
    const std::size_t at = where % size, length = data[i] > std::byte{0x7F} ? 8 : 1;
    i += 2;
    const std::size_t copied = std::min({length, data.size() - i, size - at});
    std::copy_n(data.begin() + i, copied, bytes.begin() + at);
    i += length;
  }
  return bytes;
}

bool AreFinite(const vmech::HandlePhysics& handle) {
  const auto values = {handle.mass,       handle.damping, handle.coulomb,
                       handle.resolution, handle.peak,    handle.max_speed};
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// What the users of a packet take for granted.
bool IsSound(const vmech::UdpPacket& packet) {
  if (packet.header.sent_ns < 0 || packet.header.reflected_sent_ns < 0) return false;
  const vmech::MasterState& state = packet.state;
  const vmech::RemoteCommand& command = packet.command;
  const vmech::DeviceInfo& info = packet.info;
  switch (packet.header.kind) {
    case vmech::PacketKind::kHello:
    case vmech::PacketKind::kBye:
      return true;
    case vmech::PacketKind::kInfo:
      return info.period > 0 && std::isfinite(info.period) && info.delay >= 0 &&
             std::isfinite(info.delay) && AreFinite(info.linear) && AreFinite(info.angular);
    case vmech::PacketKind::kState:
      return state.X_DH.R.allFinite() && std::abs(state.X_DH.R.determinant() - 1) < 1e-5 &&
             state.X_DH.p.allFinite() && state.V_DH.allFinite() &&
             state.applied_F_Ho_D.allFinite() && std::isfinite(state.gripper_opening) &&
             std::all_of(state.q.begin(), state.q.end(), [](double q) { return std::isfinite(q); });
    case vmech::PacketKind::kCommand:
      return command.lifetime_ns >= 0 && command.command.F_Ho_D.allFinite() &&
             std::isfinite(command.command.gripper_torque);
  }
  return false;
}

/// Bytes are refused or make a sound packet, which when written again gives the same bytes. (A name
/// may be followed by anything, which is not kept.)
void CheckDecode(const Bytes& bytes) {
  vmech::UdpPacket packet, again;
  if (!vmech::Decode(bytes, &packet)) return;
  Require(IsSound(packet));
  vmech::PacketBytes once, twice;
  const std::size_t size = vmech::Encode(packet, &once);
  Require(size == bytes.size());
  Require(packet.header.kind == vmech::PacketKind::kInfo ||
          std::equal(bytes.begin(), bytes.end(), once.begin()));
  Require(vmech::Decode({once.data(), size}, &again) && vmech::Encode(again, &twice) == size);
  Require(std::equal(once.begin(), once.begin() + size, twice.begin()));
}

}  // namespace

/// Any bytes as they come, with their checksum put right, and as errors in a sound packet.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto* begin = reinterpret_cast<const std::byte*>(data);
  const Bytes bytes(begin, begin + size);
  CheckDecode(bytes);
  if (bytes.empty() || size > vmech::kLargestPacket) return 0;
  CheckDecode(Sealed(bytes));
  CheckDecode(Sealed(Edited(bytes)));
  return 0;
}
