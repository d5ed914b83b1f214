#include "vmech/hw_interface/haply/web_socket_client.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <utility>

#include "vmech/base/text/base64.h"

namespace vmech {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kLongestHead = 8192;  // [bytes] of the answer to the handshake

std::string RandomKey() {
  std::random_device random;
  std::string key;
  for (int i = 0; i < 16; ++i) key += static_cast<char>(random());
  return Base64(key);
}

std::string Lowered(std::string_view text) {
  std::string low(text);
  for (char& c : low) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return low;
}

/// The value of a field of an HTTP head; empty if it has none of that name.
std::string_view FieldOf(std::string_view head, std::string_view name) {
  const std::string low = Lowered(head), wanted = "\r\n" + Lowered(name) + ":";
  const std::size_t at = low.find(wanted);
  if (at == std::string::npos) return {};
  const std::size_t from = head.find_first_not_of(" \t", at + wanted.size());
  const std::size_t to = head.find("\r\n", from);
  return head.substr(from, to - from);
}

/// What is wrong with the answer to a handshake of this key; empty if nothing is.
std::string FaultOf(std::string_view head, std::string_view key) {
  const std::string_view line = head.substr(0, head.find("\r\n"));
  if (!line.starts_with("HTTP/1.1 101")) return fmt::format("it answers '{}'", line);
  if (Lowered(FieldOf(head, "Upgrade")) != "websocket" ||
      Lowered(FieldOf(head, "Connection")).find("upgrade") == std::string::npos) {
    return "it does not speak WebSocket";
  }
  const bool ours = FieldOf(head, "Sec-WebSocket-Accept") == WebSocketAcceptKey(key);
  return ours ? "" : "its answer is not to our handshake";
}

int Connect(int port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd >= 0 && ::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    const int at_once = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    return fd;
  }
  const std::string reason = std::strerror(errno);
  if (fd >= 0) ::close(fd);
  throw std::runtime_error(fmt::format("nothing answers at 127.0.0.1:{}: {}", port, reason));
}

/// All of it or nothing: a peer that does not read is as good as gone.
bool SendAll(int fd, std::string_view bytes) {
  const ssize_t sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(bytes.size());
}

}  // namespace

WebSocketClient::WebSocketClient(int port, const std::string& path, double timeout)
    : socket_(Connect(port)) {
  try {
    Shake(port, path, timeout);
  } catch (...) {
    ::close(socket_);
    throw;
  }
}

WebSocketClient::~WebSocketClient() {
  if (problem_.empty()) SendFrame(WebSocketOpcode::kClose, std::string_view("\x03\xe8", 2));
  ::close(socket_);
}

/// The opening handshake [RFC 6455, 4.1]. What comes behind the answer's head is frames.
void WebSocketClient::Shake(int port, const std::string& path, double timeout) {
  const std::string key = RandomKey();
  SendAll(socket_, fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nUpgrade: websocket\r\n"
                               "Connection: Upgrade\r\nSec-WebSocket-Key: {}\r\n"
                               "Sec-WebSocket-Version: 13\r\n\r\n",
                               path, port, key));
  const auto deadline = Clock::now() + std::chrono::duration<double>(timeout);
  std::string answer;
  std::array<char, 2048> bytes{};
  std::size_t end = std::string::npos;
  while ((end = answer.find("\r\n\r\n")) == std::string::npos) {
    const double left = std::chrono::duration<double>(deadline - Clock::now()).count();
    pollfd ready{socket_, POLLIN, 0};
    const bool comes = ::poll(&ready, 1, std::max(0, static_cast<int>(1e3 * left))) > 0;
    const ssize_t n = comes ? ::recv(socket_, bytes.data(), bytes.size(), 0) : 0;
    if (n <= 0 || answer.size() > kLongestHead) {
      throw std::runtime_error(fmt::format("127.0.0.1:{} does not answer as a web server", port));
    }
    answer.append(bytes.data(), static_cast<std::size_t>(n));
  }
  const std::string fault = FaultOf(std::string_view(answer).substr(0, end + 2), key);
  if (!fault.empty()) throw std::runtime_error(fmt::format("127.0.0.1:{}: {}", port, fault));
  reader_.Append(std::string_view(answer).substr(end + 4));
}

bool WebSocketClient::Send(std::string_view text) {
  return SendFrame(WebSocketOpcode::kText, text);
}

bool WebSocketClient::SendFrame(WebSocketOpcode opcode, std::string_view payload) {
  if (!problem_.empty()) return false;
  thread_local std::minstd_rand masks(std::random_device{}());
  if (SendAll(socket_, WebSocketFrame(opcode, payload, static_cast<std::uint32_t>(masks())))) {
    return true;
  }
  problem_ = fmt::format("it takes nothing more: {}", std::strerror(errno));
  return false;
}

/// Takes what comes within `timeout` [s]. The end of the stream is a problem.
void WebSocketClient::ReadMore(double timeout) {
  pollfd ready{socket_, POLLIN, 0};
  timespec wait{};
  wait.tv_sec = static_cast<time_t>(timeout);
  wait.tv_nsec = static_cast<long>(1e9 * (timeout - std::floor(timeout)));
  if (::ppoll(&ready, 1, &wait, nullptr) <= 0) return;
  std::array<char, 16384> bytes{};
  const ssize_t n = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (n > 0) reader_.Append({bytes.data(), static_cast<std::size_t>(n)});
  if (n == 0) problem_ = "it has hung up";
  if (n < 0 && errno != EAGAIN && errno != EINTR) problem_ = std::strerror(errno);
}

WebSocketClient::Arrival WebSocketClient::Receive(double timeout, std::string* text) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(timeout);
  double left = timeout;
  do {
    const WebSocketReader::Event event = reader_.Next(text);
    if (event == WebSocketReader::Event::kText) return Arrival::kText;
    Obey(event, *text);
    left = std::chrono::duration<double>(deadline - Clock::now()).count();
    if (event == WebSocketReader::Event::kNothing) ReadMore(std::max(0.0, left));
  } while (problem_.empty() && left > 0);
  return problem_.empty() ? Arrival::kNothing : Arrival::kClosed;
}

/// What is asked of a client between the messages.
void WebSocketClient::Obey(WebSocketReader::Event event, const std::string& payload) {
  if (event == WebSocketReader::Event::kPing) SendFrame(WebSocketOpcode::kPong, payload);
  if (event == WebSocketReader::Event::kBroken) problem_ = "it has sent " + reader_.problem();
  if (event != WebSocketReader::Event::kClose) return;
  SendFrame(WebSocketOpcode::kClose, payload);
  problem_ = "it has closed the connection";
}

}  // namespace vmech
