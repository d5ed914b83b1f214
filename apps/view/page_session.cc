#include "vmech/apps/view/page_session.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "vmech/apps/view/json_text.h"

namespace vmech {

using Json = nlohmann::json;

struct PageSession::Guests {
  Guests(PageSubject* looked_at, int port) : subject(looked_at) {
    server.emplace(
        port, PageEvents{[this] { return subject->Page(); }, [this](int guest) { Join(guest); },
                         [this](int guest, std::string_view text) { Receive(guest, text); },
                         [this](int guest) { Leave(guest); }});
  }

  void Join(int guest) {
    bool writes = false;
    {
      const std::scoped_lock lock(mutex);
      present.insert(guest);
      if (writer == 0) writer = guest;
      writes = writer == guest;
      behind.insert(guest);
    }
    server->Send(guest, JsonText({{"hello", {{"writer", writes}}}}));
  }

  void Leave(int guest) {
    bool wrote = false;
    {
      const std::scoped_lock lock(mutex);
      for (std::set<int>* all : {&present, &waiting, &behind}) all->erase(guest);
      wrote = writer == guest;
      if (wrote) writer = 0;
    }
    if (wrote) subject->LetGo();
  }

  void Receive(int guest, std::string_view text) {
    const Json request = Json::parse(text, nullptr, false);
    if (!request.is_object() || !request.contains("do") || !request["do"].is_string()) {
      server->Send(guest, JsonText({{"refused", "a request is an object with the word 'do'"}}));
      return;
    }
    const std::string what = request["do"];
    if (what == "next") {
      const std::scoped_lock lock(mutex);
      waiting.insert(guest);
    } else if (what == "write") {
      server->Send(guest, JsonText({{"writer", TakesPen(guest)}}));
    } else if (!Writes(guest)) {
      server->Send(guest, JsonText({{"refused",
                                     "another page has this mechanism in hand; this one "
                                     "watches"}}));
    } else {
      Act(guest, request);
    }
  }

  void Act(int guest, const Json& request) {
    try {
      const std::string answer = subject->Do(request);
      if (!answer.empty()) server->Send(guest, answer);
    } catch (const std::exception& error) {
      server->Send(guest, JsonText({{"refused", error.what()}}));
    }
  }

  bool TakesPen(int guest) {
    const std::scoped_lock lock(mutex);
    if (writer == 0) writer = guest;
    return writer == guest;
  }
  bool Writes(int guest) {
    const std::scoped_lock lock(mutex);
    return writer == guest;
  }

  void Publish() {
    const std::string fresh = subject->NewState();
    std::vector<int> to_all, to_behind;
    {
      const std::scoped_lock lock(mutex);
      if (fresh.empty()) {
        std::set_intersection(waiting.begin(), waiting.end(), behind.begin(), behind.end(),
                              std::back_inserter(to_behind));
        for (const int guest : to_behind) waiting.erase(guest), behind.erase(guest);
      } else {
        to_all.assign(waiting.begin(), waiting.end());
        for (const int guest : present) behind.insert(guest);
        for (const int guest : to_all) behind.erase(guest);
        waiting.clear();
      }
    }
    for (const int guest : to_all) server->Send(guest, fresh);
    if (to_behind.empty()) return;
    const std::string last = subject->State();
    for (const int guest : to_behind) server->Send(guest, last);
  }

  PageSubject* subject;
  std::mutex mutex;
  std::set<int> present, waiting;
  std::set<int> behind;  ///< who have not had the newest state
  int writer = 0;        ///< 0: nobody
  std::optional<PageServer> server;
};

PageSession::PageSession(PageSubject* subject, int port)
    : guests_(std::make_unique<Guests>(subject, port)) {}

PageSession::~PageSession() {
  guests_->server.reset();
}

std::string PageSession::url() const {
  return guests_->server->url();
}

void PageSession::Publish() {
  guests_->Publish();
}

}  // namespace vmech
