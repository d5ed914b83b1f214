#pragma once

#include "vmech/hw_interface/remote/udp_master.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

/// A filter that holds a device's own limits on force, moment and speed, and judges nothing else:
/// ramps and passivity are the host's, who knows the mechanism.
SafetyOptions DeviceLimits();

/// Where a device is offered to a host, and what becomes of it when the host is silent.
struct UdpServerOptions {
  /// Where to listen. There is no authentication: an address other than the machine's own lets
  /// anybody in the network move the device.
  UdpAddress local{"127.0.0.1", 47800};
  double hold = 5e-3;   ///< the last command stays whole for this long [s], in [0, 0.1]
  double ramp = 10e-3;  ///< then falls to zero in this time [s], in [1e-3, 1]
  double release = 1;   ///< silence after which another host may connect [s], in [0.1, 60]
  /// What the device never exceeds; zeros take its own figures.
  SafetyOptions limits = DeviceLimits();

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// The device's end of a remote master: it serves one host at a time, sends a sample per tick, and
/// passes on the newest command only. When commands stop, for whatever reason, the force is zero
/// after hold + ramp and the master inactive.
///
/// It does not trust its host: a wrench beyond the limits is shrunk, a handle that is too fast, an
/// emergency stop or a released dead-man switch takes the force away here, whatever is sent. A trip
/// is told to the host as a fault and holds until the host has taken back its wish for force.
class UdpServer {
 public:
  /// `device` must be configured and outlive the server. @throws as UdpSocket, Validate and
  /// SafetyFilter.
  UdpServer(const UdpServerOptions& options, Master* device);

  /// One tick: takes what has arrived, reads the device, answers, writes the command. Once per
  /// period of the device. Activates the device when the host asks for it and deactivates it
  /// afterwards.
  /// @throws what the device's Activate throws.
  void Step(std::int64_t now_ns);

  int port() const noexcept { return socket_.port(); }    ///< on which it listens
  bool serves() const noexcept { return session_ != 0; }  ///< a host is connected
  const LinkStatistics& statistics() const noexcept { return statistics_; }  ///< since it was made
  /// Why the device's own limits withhold the force for good; none if they do not.
  ForceOff tripped() const noexcept { return limits_.latched(); }

 private:
  void Take(const sockaddr_in& from, std::int64_t now_ns);
  void Answer(PacketKind kind, std::int64_t now_ns) noexcept;
  void ServeDevice(std::int64_t now_ns);
  MasterCommand WithinLimits(MasterCommand command, IoStatus io) noexcept;
  double Share(std::int64_t now_ns) const noexcept;
  void EndSession() noexcept;

  UdpServerOptions options_;
  Master* device_;
  UdpSocket socket_;
  UdpPacket in_, out_;
  sockaddr_in host_{};
  std::uint64_t session_ = 0;  // 0: nobody
  std::uint64_t last_sequence_ = 0;
  std::int64_t heard_ns_ = 0;
  std::int64_t commanded_ns_ = 0;
  RemoteCommand command_;
  SafetyFilter limits_;
  LinkStatistics statistics_;
};

}  // namespace vmech
