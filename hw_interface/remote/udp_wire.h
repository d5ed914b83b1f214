#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vmech/hw_interface/masters/master.h"

namespace vmech {

// The datagrams between a host and a remote master: fixed layouts, little-endian, no padding, each
// with a checksum (CRC-32) at its end; well below an Ethernet frame, so never fragmented.
//
//   header | payload of its kind | crc32
//
// Clocks of the two machines are never compared: time stamps are reflected, deadlines relative.

/// What a packet is for.
enum class PacketKind : std::uint16_t {
  kHello = 1,    ///< host -> device: who are you? No payload
  kInfo = 2,     ///< device -> host: DeviceInfo, without its arm
  kState = 3,    ///< device -> host: a sample
  kCommand = 4,  ///< host -> device
  kBye = 5,      ///< host -> device: motors off. No payload
};

/// What every packet between a host and a remote device begins with.
struct PacketHeader {
  PacketKind kind = PacketKind::kHello;  ///< decides what follows
  std::uint64_t session = 0;             ///< chosen by the host; a packet of another is not for us
  std::uint64_t sequence = 0;            ///< of the sender, grows with each packet
  std::int64_t sent_ns = 0;              ///< the sender's clock, never before its zero
  std::int64_t reflected_sent_ns = 0;    ///< `sent_ns` of the newest packet from the other side
};

/// A command to a remote device.
struct RemoteCommand {
  bool active = false;           ///< the host's master is active
  std::int64_t lifetime_ns = 0;  ///< of the command, from its arrival
  MasterCommand command;         ///< without joint torques and `valid_until_ns`
};

/// Any packet; only the member of its kind is set.
struct UdpPacket {
  PacketHeader header;    ///< of every packet
  DeviceInfo info;        ///< with kInfo
  MasterState state;      ///< with kState
  bool fault = false;     ///< with kState: the device has switched its motors off
  RemoteCommand command;  ///< with kCommand
};

/// The size of the largest packet [bytes].
inline constexpr std::size_t kLargestPacket = 512;
/// Room for any packet.
using PacketBytes = std::array<std::byte, kLargestPacket>;

/// Writes a packet and returns its size. No allocation except for reading the name of kInfo.
std::size_t Encode(const UdpPacket& packet, PacketBytes* bytes) noexcept;

/// Reads a packet; false, and `packet` undefined, unless the bytes are exactly one well-formed
/// packet: known kind, its length, checksum, no negative times (their differences could overflow),
/// finite numbers, rotations that are rotations, words within their enumerations. No allocation
/// except for the name of kInfo.
[[nodiscard]] bool Decode(std::span<const std::byte> bytes, UdpPacket* packet);

}  // namespace vmech
