#pragma once

#include <netinet/in.h>

#include <optional>
#include <span>
#include <string>

#include "vmech/hw_interface/remote/udp_wire.h"

namespace vmech {

/// An IPv4 address and port of UDP.
struct UdpAddress {
  std::string host = "127.0.0.1";  ///< numeric
  int port = 0;                    ///< 0: any free one
};

/// A non-blocking UDP socket that speaks packets.
class UdpSocket {
 public:
  /// @throws std::invalid_argument if the address is not numeric;
  ///         std::runtime_error if it cannot be bound.
  explicit UdpSocket(const UdpAddress& local);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int port() const noexcept { return port_; }  ///< its own, as the system gave it

  /// False if the system does not take it.
  bool Send(const UdpPacket& packet, const sockaddr_in& to) noexcept;
  /// The next datagram and its sender; nullopt if none waits. An empty span is one that was longer
  /// than any packet.
  std::optional<std::span<const std::byte>> Receive(sockaddr_in* from) noexcept;

 private:
  int fd_;
  int port_;
  PacketBytes out_, in_;
};

/// @throws std::invalid_argument if the host is not a numeric IPv4 address.
sockaddr_in ToSockaddr(const UdpAddress& address);

}  // namespace vmech
