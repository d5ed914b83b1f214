#pragma once

#include <memory>

#include "vmech/hw_interface/remote/udp_socket.h"

namespace vmech {

/// Where a remote device is reached, and when it counts as lost.
struct UdpMasterOptions {
  UdpAddress device{"127.0.0.1", 47800};  ///< where the UdpServer listens
  UdpAddress local;                       ///< to bind here
  double connect_timeout = 2;             ///< for the device's first answer [s], in [0.01, 60]
  double link_timeout = 0.02;  ///< silence after which the link is lost [s], in [1e-3, 10]

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// What became of the packets from the other side.
struct LinkStatistics {
  std::uint64_t received = 0;      ///< new and in order
  std::uint64_t missing = 0;       ///< gaps in their sequence
  std::uint64_t stale = 0;         ///< duplicates and late ones, dropped
  std::uint64_t malformed = 0;     ///< not packets of this protocol and session
  std::int64_t round_trip_ns = 0;  ///< of the newest; includes the other side's wait for its tick
};

/// The host's end of a remote master. A command lives as long as `valid_until_ns` says, counted
/// from its arrival, so that the clocks need not agree.
class UdpMaster : public Master {
 public:
  /// @throws std::invalid_argument as Validate.
  explicit UdpMaster(UdpMasterOptions options);
  ~UdpMaster() override { Shutdown(); }

  const LinkStatistics& statistics() const noexcept { return statistics_; }  ///< since Configure

 private:
  DeviceInfo OnConfigure() override;
  void OnRecover() override { heard_ns_ = -1; }
  void OnShutdown() noexcept override;
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand& command) noexcept override;
  bool Send(PacketKind kind) noexcept;
  bool Receive() noexcept;
  bool TakeState(std::int64_t now_ns) noexcept;

  UdpMasterOptions options_;
  sockaddr_in device_;
  std::unique_ptr<UdpSocket> socket_;
  UdpPacket out_, in_;
  MasterState newest_;
  bool fault_ = false;
  std::uint64_t last_sequence_ = 0;
  std::int64_t now_ns_ = 0;
  std::int64_t heard_ns_ = -1;  // -1: not since the start
  LinkStatistics statistics_;
};

}  // namespace vmech
