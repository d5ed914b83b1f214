#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "vmech/hw_interface/haply/web_socket_frames.h"

namespace vmech {

/// A client of a WebSocket on this machine: text there and back, by one thread. Frames leave at
/// once (TCP_NODELAY), each in one piece.
class WebSocketClient {
 public:
  enum class Arrival : std::uint8_t { kText, kNothing, kClosed };

  /// Connects to 127.0.0.1. @throws std::runtime_error saying what did not answer within `timeout`
  /// [s], or what it answered instead.
  WebSocketClient(int port, const std::string& path, double timeout);
  /// Says good-bye, and does not wait for an answer.
  ~WebSocketClient();
  WebSocketClient(const WebSocketClient&) = delete;
  WebSocketClient& operator=(const WebSocketClient&) = delete;

  /// False if the connection is gone or takes nothing more.
  bool Send(std::string_view text);
  /// Waits for a message, at most `timeout` [s]. Pings are answered meanwhile.
  Arrival Receive(double timeout, std::string* text);

  /// Why the connection is closed, in words; empty while it is not.
  const std::string& problem() const noexcept { return problem_; }

 private:
  void Shake(int port, const std::string& path, double timeout);
  bool SendFrame(WebSocketOpcode opcode, std::string_view payload);
  void ReadMore(double timeout);
  void Obey(WebSocketReader::Event event, const std::string& payload);

  int socket_ = -1;
  WebSocketReader reader_;
  std::string problem_;
};

}  // namespace vmech
