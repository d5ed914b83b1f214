#include "vmech/apps/view/page_server.h"

#include <civetweb.h>
#include <fmt/format.h>

#include <array>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

namespace vmech {
namespace {

constexpr size_t kLongestMessage = 65536;  // [bytes]

std::string RandomToken() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

/// Equal, in a time that does not tell where they differ.
bool Equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned>(a[i]) ^ static_cast<unsigned>(b[i]);
  }
  return difference == 0;
}

std::string_view Header(const mg_connection* connection, const char* name) {
  const char* value = mg_get_header(connection, name);
  return value == nullptr ? std::string_view() : value;
}

bool HasToken(const mg_connection* connection, std::string_view token) {
  const char* query = mg_get_request_info(connection)->query_string;
  if (query == nullptr) return false;
  std::array<char, 128> given{};
  const int length =
      mg_get_var(query, std::char_traits<char>::length(query), "token", given.data(), given.size());
  return length > 0 && Equal({given.data(), static_cast<size_t>(length)}, token);
}

/// The page runs its own scripts, talks to its own server and to nobody else.
constexpr std::string_view kHeaders =
    "Content-Type: text/html; charset=utf-8\r\n"
    "Cache-Control: no-store\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "X-Frame-Options: DENY\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data: blob:; media-src blob:; "
    "connect-src 'self' ws: data: blob:; base-uri 'none'; form-action 'none'\r\n"
    "Connection: close\r\n\r\n";

}  // namespace

/// What civetweb calls.
struct PageServer::Calls {
  static PageServer& Of(void* data) { return *static_cast<PageServer*>(data); }
  static int GuestOf(const mg_connection* connection) {
    return static_cast<int>(
        reinterpret_cast<std::intptr_t>(mg_get_user_connection_data(connection)));
  }

  static int Page(mg_connection* connection, void* data) {
    const PageServer& server = Of(data);
    const mg_request_info* request = mg_get_request_info(connection);
    if (std::string_view(request->local_uri) != "/") {
      mg_send_http_error(connection, 404, "%s", "there is nothing here");
      return 404;
    }
    if (!server.Admits(connection, false)) {
      mg_send_http_error(connection, 403, "%s", "open the address that vmech has printed");
      return 403;
    }
    const std::string page = server.events_.page();
    const std::string head =
        fmt::format("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n{}", page.size(), kHeaders);
    mg_write(connection, head.data(), head.size());
    mg_write(connection, page.data(), page.size());
    return 200;
  }

  /// 0 lets a socket in.
  static int Connect(const mg_connection* connection, void* data) {
    return Of(data).Admits(const_cast<mg_connection*>(connection), true) ? 0 : 1;
  }

  static void Ready(mg_connection* connection, void* data) {
    PageServer& server = Of(data);
    int guest = 0;
    {
      const std::scoped_lock lock(server.mutex_);
      guest = ++server.last_guest_;
      server.guests_[guest] = connection;
    }
    mg_set_user_connection_data(connection, reinterpret_cast<void*>(std::intptr_t{guest}));
    server.events_.join(guest);
  }

  /// 0 closes the socket.
  static int Receive(mg_connection* connection, int bits, char* text, size_t length, void* data) {
    const int operation = bits & 0xf;
    if (operation == MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE) return 0;
    const bool whole = (bits & 0x80) != 0;
    if (operation != MG_WEBSOCKET_OPCODE_TEXT) return 1;
    if (!whole || length > kLongestMessage) return 0;
    Of(data).events_.receive(GuestOf(connection), {text, length});
    return 1;
  }

  static void Leave(const mg_connection* connection, void* data) {
    PageServer& server = Of(data);
    const int guest = GuestOf(connection);
    {
      const std::scoped_lock lock(server.mutex_);
      if (server.guests_.erase(guest) == 0) return;
    }
    server.events_.leave(guest);
  }

  static int Silent(const mg_connection* /*connection*/, const char* /*message*/) { return 1; }
};

PageServer::PageServer(int port, PageEvents events)
    : events_(std::move(events)), token_(RandomToken()) {
  const std::string address = fmt::format("127.0.0.1:{}", port);
  // A socket takes a thread of the server as long as it is open.
  const char* options[] = {"listening_ports",
                           address.c_str(),
                           "num_threads",
                           "32",
                           "request_timeout_ms",
                           "10000",
                           "websocket_timeout_ms",
                           "3600000",
                           "enable_directory_listing",
                           "no",
                           nullptr};
  mg_callbacks callbacks{};
  callbacks.log_message = Calls::Silent;
  mg_init_library(0);
  context_ = mg_start(&callbacks, this, options);
  mg_server_port listening{};
  if (context_ == nullptr || mg_get_server_ports(context_, 1, &listening) < 1) {
    if (context_ != nullptr) mg_stop(context_);
    throw std::runtime_error(fmt::format(
        "127.0.0.1:{} cannot be listened to: it is in use or not allowed; choose another --port",
        port));
  }
  port_ = listening.port;
  mg_set_request_handler(context_, "/", Calls::Page, this);
  mg_set_websocket_handler(context_, "/socket", Calls::Connect, Calls::Ready, Calls::Receive,
                           Calls::Leave, this);
}

PageServer::~PageServer() {
  mg_stop(context_);
  mg_exit_library();
}

std::string PageServer::url() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port_, token_);
}

bool PageServer::Admits(mg_connection* connection, bool socket) const {
  const std::string own = fmt::format("127.0.0.1:{}", port_);
  const std::string_view origin = Header(connection, "Origin");
  const bool from_here = origin.empty() ? !socket : origin == "http://" + own;
  return from_here && Header(connection, "Host") == own && HasToken(connection, token_);
}

void PageServer::Send(int guest, std::string_view text) {
  const std::scoped_lock lock(mutex_);
  const auto found = guests_.find(guest);
  if (found == guests_.end()) return;
  mg_websocket_write(found->second, MG_WEBSOCKET_OPCODE_TEXT, text.data(), text.size());
}

}  // namespace vmech
