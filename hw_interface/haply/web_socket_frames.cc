#include "vmech/hw_interface/haply/web_socket_frames.h"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "vmech/base/text/base64.h"

namespace vmech {
namespace {

std::uint8_t ByteAt(std::string_view bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes[i]);
}

/// The message, a one, zeros, and the length in bits, in whole blocks of 64 bytes [FIPS 180-4].
std::string Padded(std::string_view message) {
  std::string padded(message);
  padded += '\x80';
  while (padded.size() % 64 != 56) padded += '\0';
  const std::uint64_t bits = 8 * std::uint64_t{message.size()};
  for (int shift = 56; shift >= 0; shift -= 8) padded += static_cast<char>(bits >> shift);
  return padded;
}

using Sha1State = std::array<std::uint32_t, 5>;

void AddBlock(std::string_view block, Sha1State* state) {
  constexpr std::array<std::uint32_t, 4> kRound{0x5a827999, 0x6ed9eba1, 0x8f1bbcdc, 0xca62c1d6};
  std::array<std::uint32_t, 80> w{};
  for (std::size_t i = 0; i < 64; ++i) w[i / 4] = w[i / 4] << 8 | ByteAt(block, i);
  for (std::size_t t = 16; t < 80; ++t) {
    w[t] = std::rotl(w[t - 3] ^ w[t - 8] ^ w[t - 14] ^ w[t - 16], 1);
  }
  auto [a, b, c, d, e] = *state;
  for (std::size_t t = 0; t < 80; ++t) {
    const std::size_t round = t / 20;
    const std::uint32_t choose = (b & c) | (~b & d), majority = (b & c) | (b & d) | (c & d);
    const std::uint32_t f = round == 0 ? choose : round == 2 ? majority : b ^ c ^ d;
    const std::uint32_t next = std::rotl(a, 5) + f + e + kRound[round] + w[t];
    e = d;
    d = c;
    c = std::rotl(b, 30);
    b = a;
    a = next;
  }
  const Sha1State end{a, b, c, d, e};
  for (std::size_t i = 0; i < 5; ++i) (*state)[i] += end[i];
}

std::string Sha1(std::string_view message) {
  Sha1State state{0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476, 0xc3d2e1f0};
  const std::string padded = Padded(message);
  for (std::size_t i = 0; i < padded.size(); i += 64) {
    AddBlock(std::string_view(padded).substr(i, 64), &state);
  }
  std::string digest;
  for (const std::uint32_t word : state) {
    for (int shift = 24; shift >= 0; shift -= 8) digest += static_cast<char>(word >> shift);
  }
  return digest;
}

bool IsControl(WebSocketOpcode opcode) {
  return opcode >= WebSocketOpcode::kClose;
}

}  // namespace

std::string WebSocketAcceptKey(std::string_view key) {
  return Base64(Sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
}

std::string WebSocketFrame(WebSocketOpcode opcode, std::string_view payload, std::uint32_t mask) {
  constexpr int kMasked = 0x80;
  std::string frame(1, static_cast<char>(0x80 | static_cast<int>(opcode)));
  const std::size_t size = payload.size();
  const int length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  const int code = length_bytes == 0 ? static_cast<int>(size) : length_bytes == 2 ? 126 : 127;
  frame += static_cast<char>(kMasked | code);
  for (int i = length_bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i));
  for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>(mask >> shift);
  for (std::size_t i = 0; i < size; ++i) {
    frame += static_cast<char>(ByteAt(payload, i) ^ (mask >> (24 - 8 * (i % 4))));
  }
  return frame;
}

WebSocketReader::Event WebSocketReader::Break(std::string problem) {
  problem_ = std::move(problem);
  bytes_.clear();
  return Event::kBroken;
}

/// The frame at the start of what has come; false if it is not complete or breaks the protocol.
bool WebSocketReader::TakeFrame(Frame* frame) {
  if (bytes_.size() < 2) return false;
  const int first = ByteAt(bytes_, 0), second = ByteAt(bytes_, 1);
  frame->opcode = static_cast<WebSocketOpcode>(first & 0x0f);
  frame->last = (first & 0x80) != 0;
  const int code = second & 0x7f;
  const std::size_t length_bytes = code == 126 ? 2 : code == 127 ? 8 : 0;
  if ((first & 0x70) != 0) Break("a frame with reserved bits");
  if ((second & 0x80) != 0) Break("a masked frame from the server");
  if (IsControl(frame->opcode) && (code > 125 || !frame->last)) Break("a long or split control");
  if (!problem_.empty() || bytes_.size() < 2 + length_bytes) return false;
  std::uint64_t size = length_bytes == 0 ? static_cast<std::uint64_t>(code) : 0;
  for (std::size_t i = 0; i < length_bytes; ++i) size = size << 8 | ByteAt(bytes_, 2 + i);
  if (size > kLongestMessage) {
    Break(fmt::format("a frame of {} bytes, more than {}", size, kLongestMessage));
    return false;
  }
  const std::size_t head = 2 + length_bytes;
  if (bytes_.size() < head + size) return false;
  frame->payload = std::string_view(bytes_).substr(head, size);
  frame->size = head + size;
  return true;
}

WebSocketReader::Event WebSocketReader::Next(std::string* payload) {
  Frame frame;
  while (problem_.empty() && TakeFrame(&frame)) {
    const Event event = IsControl(frame.opcode) ? Control(frame, payload) : Add(frame, payload);
    if (event != Event::kBroken) bytes_.erase(0, frame.size);
    if (event != Event::kNothing) return event;
  }
  return problem_.empty() ? Event::kNothing : Event::kBroken;
}

/// A fragment, which is a whole message in most cases.
WebSocketReader::Event WebSocketReader::Add(const Frame& frame, std::string* payload) {
  if (frame.opcode > WebSocketOpcode::kText) return Break("a message that is not text");
  const bool continues = frame.opcode == WebSocketOpcode::kContinuation;
  if (continues != fragmented_) return Break("a fragment out of its place");
  if (message_.size() + frame.payload.size() > kLongestMessage) {
    return Break(fmt::format("a message of more than {} bytes", kLongestMessage));
  }
  message_ += frame.payload;
  fragmented_ = !frame.last;
  if (fragmented_) return Event::kNothing;
  payload->swap(message_);
  message_.clear();
  return Event::kText;
}

WebSocketReader::Event WebSocketReader::Control(const Frame& frame, std::string* payload) {
  if (frame.opcode == WebSocketOpcode::kPong) return Event::kNothing;
  payload->assign(frame.payload);
  if (frame.opcode == WebSocketOpcode::kPing) return Event::kPing;
  return frame.opcode == WebSocketOpcode::kClose ? Event::kClose
                                                 : Break("a frame of an unknown kind");
}

}  // namespace vmech
