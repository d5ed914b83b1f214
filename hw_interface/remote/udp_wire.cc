#include "vmech/hw_interface/remote/udp_wire.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace vmech {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

constexpr std::uint32_t kMagic = 0x31484d56;  // "VMH1"
constexpr std::size_t kNameLength = 48;
constexpr std::size_t kHeaderSize = 4 + 2 + 2 + 4 * 8;
constexpr std::size_t kCrcSize = 4;

/// Table of CRC-32, polynomial 0xEDB88320 (ISO 3309).
constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}();

std::uint32_t Crc32(const std::byte* bytes, std::size_t size) noexcept {
  std::uint32_t c = ~0u;
  for (std::size_t i = 0; i < size; ++i) {
    c = kCrcTable[(c ^ std::to_integer<std::uint32_t>(bytes[i])) & 0xff] ^ (c >> 8);
  }
  return ~c;
}

/// Fields go through one function per payload, whether they are written or read: the layout is
/// stated once.
class Writer {
 public:
  explicit Writer(std::byte* to) : at_(to) {}
  template <typename T>
  void operator()(const T& value) noexcept {
    std::memcpy(at_, &value, sizeof value);
    at_ += sizeof value;
  }
  std::byte* at() const noexcept { return at_; }

 private:
  std::byte* at_;
};

class Reader {
 public:
  explicit Reader(const std::byte* from) : at_(from) {}
  template <typename T>
  void operator()(T& value) noexcept {
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
    if constexpr (std::is_same_v<T, double>) finite_ &= std::isfinite(value);
  }
  bool finite() const noexcept { return finite_; }
  const std::byte* at() const noexcept { return at_; }

 private:
  const std::byte* at_;
  bool finite_ = true;
};

template <typename Visitor, typename Matrix>
void VisitMatrix(Visitor& visit, Matrix& m) {
  for (int i = 0; i < m.size(); ++i) visit(m.data()[i]);
}

template <typename Visitor, typename Header>
void VisitHeader(Visitor& visit, Header& h) {
  visit(h.session);
  visit(h.sequence);
  visit(h.sent_ns);
  visit(h.reflected_sent_ns);
}

template <typename Visitor, typename State>
void VisitState(Visitor& visit, State& s) {
  visit(s.sequence);
  visit(s.device_time_ns);
  visit(s.valid);
  visit(s.buttons);
  visit(s.command_echo);
  VisitMatrix(visit, s.X_DH.R);
  VisitMatrix(visit, s.X_DH.p);
  VisitMatrix(visit, s.V_DH);
  VisitMatrix(visit, s.applied_F_Ho_D);
  for (auto& q : s.q) visit(q);
  visit(s.gripper_opening);
}
constexpr std::size_t kStateSize = 8 + 8 + 4 + 4 + 8 + 8 * (9 + 3 + 6 + 6 + kMaxArmJoints + 1) + 1;

template <typename Visitor, typename Command>
void VisitCommand(Visitor& visit, Command& c) {
  visit(c.lifetime_ns);
  visit(c.command.sequence);
  VisitMatrix(visit, c.command.F_Ho_D);
  visit(c.command.gripper_torque);
}
constexpr std::size_t kCommandSize = 8 + 8 + 8 * 7 + 1;

template <typename Visitor, typename Info>
void VisitInfo(Visitor& visit, Info& info) {
  visit(info.period);
  visit(info.delay);
  visit(info.senses);
  for (auto* handle : {&info.linear, &info.angular}) {
    visit(handle->mass);
    visit(handle->damping);
    visit(handle->coulomb);
    visit(handle->resolution);
    visit(handle->peak);
    visit(handle->max_speed);
  }
}
constexpr std::size_t kInfoSize = 8 + 8 + 4 + 12 * 8 + 1 + kNameLength;

std::size_t PayloadSize(PacketKind kind) noexcept {
  switch (kind) {
    case PacketKind::kHello:
    case PacketKind::kBye:
      return 0;
    case PacketKind::kInfo:
      return kInfoSize;
    case PacketKind::kState:
      return kStateSize;
    case PacketKind::kCommand:
      return kCommandSize;
  }
  return kLargestPacket;
}
static_assert(kHeaderSize + std::max({kInfoSize, kStateSize, kCommandSize}) + kCrcSize <=
              kLargestPacket);

/// Speeds without a limit are sent as the largest number: every number on the wire is finite.
DeviceInfo WithFiniteSpeeds(DeviceInfo info) {
  constexpr double kNoLimit = std::numeric_limits<double>::max();
  info.linear.max_speed = std::min(info.linear.max_speed, kNoLimit);
  info.angular.max_speed = std::min(info.angular.max_speed, kNoLimit);
  return info;
}

void WritePayload(const UdpPacket& packet, Writer* write) {
  switch (packet.header.kind) {
    case PacketKind::kHello:
    case PacketKind::kBye:
      break;
    case PacketKind::kInfo: {
      const DeviceInfo info = WithFiniteSpeeds(packet.info);
      VisitInfo(*write, info);
      (*write)(static_cast<std::uint8_t>(info.takes_wrench | info.has_dead_man << 1));
      std::array<char, kNameLength> name{};
      info.name.copy(name.data(), kNameLength - 1);
      (*write)(name);
      break;
    }
    case PacketKind::kState: {
      const MasterState& state = packet.state;
      VisitState(*write, state);
      (*write)(static_cast<std::uint8_t>(state.dead_man | state.emergency_stop << 1 |
                                         packet.fault << 2));
      break;
    }
    case PacketKind::kCommand: {
      const RemoteCommand& command = packet.command;
      VisitCommand(*write, command);
      const bool pushes = command.command.mode != CommandMode::kZero;
      (*write)(static_cast<std::uint8_t>(command.active | pushes << 1));
      break;
    }
  }
}

bool IsRotation(const Matrix3d& R) {
  constexpr double kRounding = 1e-6;
  return (R * R.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRounding &&
         R.determinant() > 0;
}

bool ReadInfo(Reader* read, DeviceInfo* info) {
  VisitInfo(*read, *info);
  std::uint8_t flags = 0;
  (*read)(flags);
  std::array<char, kNameLength> name;
  (*read)(name);
  if (flags > 3 || name.back() != 0) return false;
  info->takes_wrench = flags & 1;
  info->has_dead_man = flags & 2;
  info->name = name.data();
  return read->finite() && info->period > 0 && info->delay >= 0;
}

bool ReadState(Reader* read, MasterState* state, bool* fault) {
  VisitState(*read, *state);
  std::uint8_t flags = 0;
  (*read)(flags);
  state->dead_man = flags & 1;
  state->emergency_stop = flags & 2;
  *fault = flags & 4;
  return flags <= 7 && read->finite() && IsRotation(state->X_DH.R);
}

bool ReadCommand(Reader* read, RemoteCommand* command) {
  VisitCommand(*read, *command);
  std::uint8_t flags = 0;
  (*read)(flags);
  command->active = flags & 1;
  command->command.mode = flags & 2 ? CommandMode::kWrench : CommandMode::kZero;
  return flags <= 3 && read->finite() && command->lifetime_ns >= 0;
}

}  // namespace

std::size_t Encode(const UdpPacket& packet, PacketBytes* bytes) noexcept {
  Writer write(bytes->data());
  const std::size_t size = kHeaderSize + PayloadSize(packet.header.kind);
  write(kMagic);
  write(static_cast<std::uint16_t>(packet.header.kind));
  write(static_cast<std::uint16_t>(size));
  VisitHeader(write, packet.header);
  WritePayload(packet, &write);
  write(Crc32(bytes->data(), size));
  return size + kCrcSize;
}

bool Decode(std::span<const std::byte> bytes, UdpPacket* packet) {
  if (bytes.size() < kHeaderSize + kCrcSize || bytes.size() > kLargestPacket) return false;
  Reader read(bytes.data());
  std::uint32_t magic, crc;
  std::uint16_t kind, size;
  read(magic);
  read(kind);
  read(size);
  packet->header.kind = static_cast<PacketKind>(kind);
  const std::size_t expected = kHeaderSize + PayloadSize(packet->header.kind);
  if (magic != kMagic || size != expected || bytes.size() != expected + kCrcSize) return false;
  std::memcpy(&crc, bytes.data() + expected, sizeof crc);
  if (crc != Crc32(bytes.data(), expected)) return false;
  VisitHeader(read, packet->header);
  if (packet->header.sent_ns < 0 || packet->header.reflected_sent_ns < 0) return false;
  switch (packet->header.kind) {
    case PacketKind::kHello:
    case PacketKind::kBye:
      return true;
    case PacketKind::kInfo:
      return ReadInfo(&read, &packet->info);
    case PacketKind::kState:
      return ReadState(&read, &packet->state, &packet->fault);
    case PacketKind::kCommand:
      return ReadCommand(&read, &packet->command);
  }
  return false;
}

}  // namespace vmech
