#include "vmech/hw_interface/remote/udp_wire.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace vmech::udp_wire_test {
namespace {

UdpPacket StatePacket() {
  UdpPacket packet;
  packet.header = {PacketKind::kState, 7, 8, 9, 10};
  packet.state.sequence = 11;
  packet.state.X_DH.R = Eigen::AngleAxisd(0.3, Vector3d::UnitY()).toRotationMatrix();
  packet.state.X_DH.p = Vector3d(1, 2, 3);
  packet.state.applied_F_Ho_D[4] = -5;
  packet.state.q[kMaxArmJoints - 1] = 6;
  packet.state.emergency_stop = true;
  packet.state.gripper_opening = 0.25;
  return packet;
}

std::span<const std::byte> Bytes(const PacketBytes& bytes, std::size_t size) {
  return {bytes.data(), size};
}

TEST(UdpWire, StateComesBackAsItWas) {
  PacketBytes bytes;
  UdpPacket out;
  ASSERT_TRUE(Decode(Bytes(bytes, Encode(StatePacket(), &bytes)), &out));
  EXPECT_EQ(out.header.session, 7u);
  EXPECT_EQ(out.header.reflected_sent_ns, 10);
  EXPECT_EQ(out.state.sequence, 11u);
  EXPECT_EQ(out.state.X_DH.R, StatePacket().state.X_DH.R);
  EXPECT_EQ(out.state.applied_F_Ho_D[4], -5);
  EXPECT_EQ(out.state.q[kMaxArmJoints - 1], 6);
  EXPECT_TRUE(out.state.emergency_stop);
  EXPECT_FALSE(out.state.dead_man);
  EXPECT_EQ(out.state.gripper_opening, 0.25);
}

TEST(UdpWire, CommandComesBackAsItWas) {
  UdpPacket packet;
  packet.header.kind = PacketKind::kCommand;
  packet.command = {true, 123, {}};
  packet.command.command.mode = CommandMode::kWrench;
  packet.command.command.F_Ho_D[2] = 4;
  PacketBytes bytes;
  UdpPacket out;
  ASSERT_TRUE(Decode(Bytes(bytes, Encode(packet, &bytes)), &out));
  EXPECT_TRUE(out.command.active);
  EXPECT_EQ(out.command.lifetime_ns, 123);
  EXPECT_EQ(out.command.command.mode, CommandMode::kWrench);
  EXPECT_EQ(out.command.command.F_Ho_D[2], 4);
}

TEST(UdpWire, InfoComesBackAndALongNameIsCut) {
  UdpPacket packet;
  packet.header.kind = PacketKind::kInfo;
  packet.info.name = std::string(100, 'n');
  packet.info.delay = 2e-3;
  packet.info.takes_wrench = true;
  packet.info.angular.damping = 0.125;
  PacketBytes bytes;
  UdpPacket out;
  ASSERT_TRUE(Decode(Bytes(bytes, Encode(packet, &bytes)), &out));
  EXPECT_EQ(out.info.name, std::string(47, 'n'));
  EXPECT_EQ(out.info.delay, 2e-3);
  EXPECT_TRUE(out.info.takes_wrench);
  EXPECT_EQ(out.info.angular.damping, 0.125);
  EXPECT_GT(out.info.linear.max_speed, 1e300);
}

TEST(UdpWire, EveryFlippedBitIsNoticed) {
  PacketBytes bytes;
  const std::size_t size = Encode(StatePacket(), &bytes);
  UdpPacket out;
  for (std::size_t bit = 0; bit < 8 * size; ++bit) {
    bytes[bit / 8] ^= std::byte(1 << bit % 8);
    EXPECT_FALSE(Decode(Bytes(bytes, size), &out)) << bit;
    bytes[bit / 8] ^= std::byte(1 << bit % 8);
  }
}

TEST(UdpWire, EveryOtherLengthIsRefused) {
  PacketBytes bytes{};
  const std::size_t size = Encode(StatePacket(), &bytes);
  UdpPacket out;
  for (std::size_t n = 0; n <= bytes.size(); ++n) {
    EXPECT_EQ(Decode(Bytes(bytes, n), &out), n == size) << n;
  }
}

TEST(UdpWire, RefusesWhatIsNotANumberOrNotARotation) {
  PacketBytes bytes;
  UdpPacket out;
  UdpPacket packet = StatePacket();
  packet.state.V_DH[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Decode(Bytes(bytes, Encode(packet, &bytes)), &out));
  packet = StatePacket();
  packet.state.X_DH.R(0, 0) += 0.01;
  EXPECT_FALSE(Decode(Bytes(bytes, Encode(packet, &bytes)), &out));
}

TEST(UdpWire, RefusesTimesWhoseDifferenceCouldOverflow) {
  PacketBytes bytes;
  UdpPacket out;
  UdpPacket packet = StatePacket();
  packet.header.reflected_sent_ns = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(Decode(Bytes(bytes, Encode(packet, &bytes)), &out));
  packet = StatePacket();
  packet.header.sent_ns = -1;
  EXPECT_FALSE(Decode(Bytes(bytes, Encode(packet, &bytes)), &out));
}

TEST(UdpWire, ChecksumIsTheUsualOne) {
  // A header without payload by an independent implementation (Python's zlib.crc32).
  UdpPacket packet;
  packet.header = {PacketKind::kHello, 1, 2, 3, 4};
  PacketBytes bytes;
  const std::size_t size = Encode(packet, &bytes);
  ASSERT_EQ(size, 44u);
  std::uint32_t crc;
  std::memcpy(&crc, bytes.data() + 40, 4);
  EXPECT_EQ(crc, 0xDB40400Cu);
}

}  // namespace
}  // namespace vmech::udp_wire_test
