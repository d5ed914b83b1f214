#include "vmech/hw_interface/remote/udp_master.h"

#include <fmt/format.h>

#include <chrono>
#include <random>
#include <stdexcept>
#include <thread>

#include "vmech/base/check_range.h"

namespace vmech {

void UdpMasterOptions::Validate() const {
  CheckRange("UdpMasterOptions", "connect_timeout", connect_timeout, 0.01, 60);
  CheckRange("UdpMasterOptions", "link_timeout", link_timeout, 1e-3, 10);
}

UdpMaster::UdpMaster(UdpMasterOptions options)
    : options_(std::move(options)), device_(ToSockaddr(options_.device)) {
  options_.Validate();
}

DeviceInfo UdpMaster::OnConfigure() {
  using Clock = std::chrono::steady_clock;
  socket_ = std::make_unique<UdpSocket>(options_.local);
  std::random_device random;
  out_.header.session = (std::uint64_t{random()} << 32) | random();
  const auto deadline = Clock::now() + std::chrono::duration<double>(options_.connect_timeout);
  constexpr int kTriesPerHello = 20;
  for (int i = 0; Clock::now() < deadline; ++i) {
    if (i % kTriesPerHello == 0) Send(PacketKind::kHello);
    while (Receive()) {
      if (in_.header.kind == PacketKind::kInfo) return in_.info;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  throw std::runtime_error(
      fmt::format("udp master: no answer from {}:{} within {} s; start the device's end there, and "
                  "see whether another host holds it",
                  options_.device.host, options_.device.port, options_.connect_timeout));
}

void UdpMaster::OnShutdown() noexcept {
  Send(PacketKind::kBye);
}

bool UdpMaster::Send(PacketKind kind) noexcept {
  out_.header.kind = kind;
  ++out_.header.sequence;
  out_.header.sent_ns = now_ns_;
  return socket_->Send(out_, device_);
}

/// The next packet of this session from the device, into in_; false if none waits.
bool UdpMaster::Receive() noexcept {
  sockaddr_in from{};
  while (const auto bytes = socket_->Receive(&from)) {
    const bool ours = from.sin_addr.s_addr == device_.sin_addr.s_addr &&
                      from.sin_port == device_.sin_port && Decode(*bytes, &in_) &&
                      in_.header.session == out_.header.session;
    if (ours) return true;
    ++statistics_.malformed;
  }
  return false;
}

/// Whether in_ is newer than all before it.
bool UdpMaster::TakeState(std::int64_t now_ns) noexcept {
  if (in_.header.kind != PacketKind::kState) return false;
  if (in_.header.sequence <= last_sequence_) {
    ++statistics_.stale;
    return false;
  }
  ++statistics_.received;
  if (last_sequence_ > 0) statistics_.missing += in_.header.sequence - last_sequence_ - 1;
  last_sequence_ = in_.header.sequence;
  newest_ = in_.state;
  fault_ = in_.fault;
  heard_ns_ = now_ns;
  out_.header.reflected_sent_ns = in_.header.sent_ns;
  statistics_.round_trip_ns = now_ns - in_.header.reflected_sent_ns;
  return true;
}

IoStatus UdpMaster::OnRead(std::int64_t now_ns, MasterState* state) noexcept {
  now_ns_ = now_ns;
  if (heard_ns_ < 0) heard_ns_ = now_ns;
  bool fresh = false;
  while (Receive()) fresh |= TakeState(now_ns);
  *state = newest_;
  if (fresh) return fault_ ? IoStatus::kDeviceFault : IoStatus::kOk;
  const auto silence = static_cast<double>(now_ns - heard_ns_) * 1e-9;
  return silence > options_.link_timeout ? IoStatus::kLinkLost : IoStatus::kNoNewData;
}

IoStatus UdpMaster::OnWrite(const MasterCommand& command) noexcept {
  out_.command.active = lifecycle() == Lifecycle::kActive;
  out_.command.lifetime_ns = std::max<std::int64_t>(0, command.valid_until_ns - now_ns_);
  out_.command.command = command;
  return Send(PacketKind::kCommand) ? IoStatus::kOk : IoStatus::kLinkLost;
}

}  // namespace vmech
