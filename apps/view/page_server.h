#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

struct mg_connection;
struct mg_context;

namespace vmech {

/// What happens at a PageServer. Guests are numbered from 1 on; the functions are called from
/// threads of the server, those of one guest one after the other.
struct PageEvents {
  std::function<std::string()> page;  ///< the document, for each who opens it
  std::function<void(int guest)> join;
  std::function<void(int guest, std::string_view text)> receive;
  std::function<void(int guest)> leave;
};

/// Serves one page on this machine alone: 127.0.0.1, at an address with a random token. Whoever
/// does not know the token, a page of another origin, or a name for this machine that is not its
/// own (Host), gets nothing. Beside the page there is one WebSocket, /socket.
class PageServer {
 public:
  /// `port` 0: any free one. @throws std::runtime_error if the port cannot be had.
  PageServer(int port, PageEvents events);
  /// Closes all connections; no event comes after it.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Where the page is: http://127.0.0.1:PORT/?token=TOKEN
  std::string url() const;

  /// From any thread. What is sent to a guest who has left is dropped.
  void Send(int guest, std::string_view text);

 private:
  struct Calls;
  bool Admits(mg_connection* connection, bool socket) const;

  PageEvents events_;
  std::string token_;
  int port_ = 0;
  mg_context* context_ = nullptr;
  std::mutex mutex_;
  std::map<int, mg_connection*> guests_;
  int last_guest_ = 0;
};

}  // namespace vmech
