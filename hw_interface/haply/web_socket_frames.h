#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vmech {

/// The bytes of a WebSocket [RFC 6455], without a connection.

/// What a server must answer to the key of a client's handshake: the base64 of the SHA-1 of the key
/// and the protocol's own GUID [RFC 6455, 4.2.2].
std::string WebSocketAcceptKey(std::string_view key);

enum class WebSocketOpcode : std::uint8_t {
  kContinuation = 0,
  kText = 1,
  kBinary = 2,
  kClose = 8,
  kPing = 9,
  kPong = 10,
};

/// A whole frame as a client sends it, masked with `mask` [RFC 6455, 5.3].
std::string WebSocketFrame(WebSocketOpcode opcode, std::string_view payload, std::uint32_t mask);

/// Puts messages together from what a server sends, in pieces of any size.
class WebSocketReader {
 public:
  static constexpr std::size_t kLongestMessage = 1u << 20;  // [bytes]

  enum class Event : std::uint8_t {
    kNothing,  ///< the next frame is not complete
    kText,     ///< a message, from all of its fragments
    kPing,     ///< to be answered with a pong of the same payload
    kClose,    ///< the server hangs up
    kBroken,   ///< against the protocol, or too long: see problem; nothing more can be read
  };

  void Append(std::string_view bytes) { bytes_ += bytes; }
  /// The next of what has come; `payload` is that of a text, a ping or a close.
  Event Next(std::string* payload);

  /// Why the stream is broken, in words.
  const std::string& problem() const noexcept { return problem_; }

 private:
  struct Frame {
    WebSocketOpcode opcode = WebSocketOpcode::kText;
    bool last = true;
    std::string_view payload;
    std::size_t size = 0;  ///< with its head
  };
  bool TakeFrame(Frame* frame);
  Event Break(std::string problem);
  Event Add(const Frame& frame, std::string* payload);
  Event Control(const Frame& frame, std::string* payload);

  std::string bytes_;
  std::string message_;
  bool fragmented_ = false;  // a message has begun and not ended
  std::string problem_;
};

}  // namespace vmech
