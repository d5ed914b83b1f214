#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vmech/apps/view/page_server.h"

namespace vmech {

/// What a page looks at and, for one guest at a time, acts on. Calls come from several threads.
class PageSubject {
 public:
  virtual ~PageSubject() = default;
  /// The document as it is to be opened now.
  virtual std::string Page() = 0;
  /// Does what the writer asks and returns an answer for it, in JSON; empty: none.
  /// @throws std::exception saying what is wrong with the request.
  virtual std::string Do(const nlohmann::json& request) = 0;
  /// The writer has left.
  virtual void LetGo() {}
  /// The newest state in JSON; empty if it is that of the last call. `echo`: of the newest request
  /// that has led to it, and not yet to another.
  virtual std::string NewState() = 0;
  /// The last state again, for who has just come.
  virtual std::string State() = 0;
};

/// A subject on a page: one guest writes, any number watch. States are sent to whom has asked for
/// the next one, so that a slow guest gets fewer and holds nobody up.
class PageSession {
 public:
  /// Keeps a reference to the subject. @throws as PageServer.
  PageSession(PageSubject* subject, int port);
  ~PageSession();

  std::string url() const;
  /// Sends the newest state to those who wait for one. To be called at least 60 times a second.
  void Publish();

 private:
  struct Guests;
  std::unique_ptr<Guests> guests_;
};

}  // namespace vmech
