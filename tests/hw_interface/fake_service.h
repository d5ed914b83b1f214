#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "vmech/hw_interface/haply/web_socket_frames.h"

namespace vmech {

/// A frame as a server sends it.
inline std::string ServerFrame(int opcode, const std::string& payload, bool last = true) {
  std::string frame(1, static_cast<char>((last ? 0x80 : 0) | opcode));
  const std::size_t size = payload.size();
  const int more = size < 126 ? 0 : size < 65536 ? 2 : 8;
  frame += static_cast<char>(more == 0 ? size : more == 2 ? 126 : 127);
  for (int i = more - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i));
  return frame + payload;
}

/// A WebSocket server of one client, whose bytes are the test's.
class FakeService {
 public:
  static inline const std::string kHangUp = "hang up";
  /// The bytes that answer the k-th message; kHangUp ends the connection.
  using Answer = std::function<std::string(int k, const std::string& text)>;

  /// `first`: the text that a client is greeted with; none if it is empty.
  FakeService(std::string first, Answer answer)
      : first_(std::move(first)), answer_(std::move(answer)) {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(listener_, reinterpret_cast<sockaddr*>(&address), size);
    ::listen(listener_, 4);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Serve(); });
  }
  ~FakeService() {
    over_ = true;
    ::shutdown(listener_, SHUT_RDWR);
    if (client_ >= 0) ::shutdown(client_, SHUT_RDWR);
    thread_.join();
    ::close(listener_);
  }

  int port() const { return port_; }
  int connections() const { return connections_; }
  int pongs() const { return pongs_; }
  /// The last message of the client.
  std::string last() const {
    const std::scoped_lock lock(mutex_);
    return last_;
  }

 private:
  void Serve() {
    while (!over_) {
      client_ = ::accept(listener_, nullptr, nullptr);
      if (client_ < 0) return;
      ++connections_;
      Greet();
      int k = 0;
      std::string text;
      for (int opcode = 0; (opcode = TakeFrame(&text)) >= 0;) {
        if (opcode == 10) ++pongs_;
        if (opcode == 1 && !Reply(k++, text)) break;
      }
      ::close(client_.exchange(-1));
    }
  }
  bool Reply(int k, const std::string& text) {
    {
      const std::scoped_lock lock(mutex_);
      last_ = text;
    }
    const std::string bytes = answer_(k, text);
    if (bytes == kHangUp) return false;
    Send(bytes);
    return true;
  }
  void Greet() {
    std::string head;
    char c = 0;
    while (head.find("\r\n\r\n") == std::string::npos && ::recv(client_, &c, 1, 0) == 1) head += c;
    const std::string field = "Sec-WebSocket-Key: ";
    const std::size_t at = head.find(field) + field.size();
    const std::string key = head.substr(at, head.find("\r\n", at) - at);
    Send(
        "HTTP/1.1 101 Switching Protocols\r\nupgrade: WebSocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Accept: " +
        WebSocketAcceptKey(key) + "\r\n\r\n" + (first_.empty() ? "" : ServerFrame(1, first_)));
  }
  void Send(const std::string& bytes) {
    if (!bytes.empty()) ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  bool Take(std::size_t count, std::string* bytes) {
    bytes->resize(count);
    return count == 0 ||
           ::recv(client_, bytes->data(), count, MSG_WAITALL) == static_cast<ssize_t>(count);
  }
  /// The opcode of a masked frame of less than 64 KiB; -1 at the end.
  int TakeFrame(std::string* text) {
    std::string head, length, mask;
    if (!Take(2, &head) || (head[1] & 0x80) == 0) return -1;
    std::size_t size = head[1] & 0x7f;
    if (size == 126) {
      if (!Take(2, &length)) return -1;
      size = static_cast<unsigned char>(length[0]) * 256u + static_cast<unsigned char>(length[1]);
    }
    if (!Take(4, &mask) || !Take(size, text)) return -1;
    for (std::size_t i = 0; i < size; ++i) (*text)[i] = static_cast<char>((*text)[i] ^ mask[i % 4]);
    return head[0] & 0x0f;
  }

  std::string first_;
  Answer answer_;
  int listener_ = -1, port_ = 0;
  std::atomic<int> client_ = -1, connections_ = 0, pongs_ = 0;
  std::atomic<bool> over_ = false;
  mutable std::mutex mutex_;
  std::string last_;
  std::thread thread_;
};

}  // namespace vmech
