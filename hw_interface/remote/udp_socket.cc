#include "vmech/hw_interface/remote/udp_socket.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace vmech {

sockaddr_in ToSockaddr(const UdpAddress& address) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  if (address.port < 0 || address.port > 65535 ||
      inet_pton(AF_INET, address.host.c_str(), &out.sin_addr) != 1) {
    throw std::invalid_argument(
        fmt::format("udp: '{}:{}' is not a numeric IPv4 address and a port in [0, 65535]; this "
                    "machine is 127.0.0.1, another has an address in the network",
                    address.host, address.port));
  }
  out.sin_port = htons(static_cast<std::uint16_t>(address.port));
  return out;
}

UdpSocket::UdpSocket(const UdpAddress& local) : fd_(-1) {
  sockaddr_in address = ToSockaddr(local);
  fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  socklen_t length = sizeof address;
  if (fd_ < 0 || ::bind(fd_, reinterpret_cast<const sockaddr*>(&address), length) != 0 ||
      ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    const std::string reason = std::strerror(errno);
    if (fd_ >= 0) ::close(fd_);
    throw std::runtime_error(
        fmt::format("udp: cannot bind {}:{}: {}", local.host, local.port, reason));
  }
  port_ = ntohs(address.sin_port);
}

UdpSocket::~UdpSocket() {
  ::close(fd_);
}

bool UdpSocket::Send(const UdpPacket& packet, const sockaddr_in& to) noexcept {
  const std::size_t size = Encode(packet, &out_);
  return ::sendto(fd_, out_.data(), size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) ==
         static_cast<ssize_t>(size);
}

std::optional<std::span<const std::byte>> UdpSocket::Receive(sockaddr_in* from) noexcept {
  socklen_t length = sizeof *from;
  const ssize_t size = ::recvfrom(fd_, in_.data(), in_.size(), MSG_TRUNC,
                                  reinterpret_cast<sockaddr*>(from), &length);
  if (size < 0) return std::nullopt;
  if (static_cast<std::size_t>(size) > in_.size()) return std::span<const std::byte>{};
  return std::span<const std::byte>(in_.data(), static_cast<std::size_t>(size));
}

}  // namespace vmech
