#include "vmech/comparison/contestant.h"

namespace vmech {
namespace {

constexpr int kBackends = static_cast<int>(kAllBackends.size());

}  // namespace

Contestant Contestant::FastPath() {
  Contestant contestant;
  contestant.place_ = kBackends;
  return contestant;
}

std::string_view Contestant::name() const {
  return place_ == kBackends ? "hand_tracker" : NameOf(kAllBackends[place_]);
}

std::optional<Backend> Contestant::backend() const {
  if (place_ == kBackends) return {};
  return kAllBackends[place_];
}

std::vector<Contestant> AllContestants() {
  std::vector<Contestant> all;
  for (const Backend backend : kAllBackends) all.emplace_back(backend);
  all.push_back(Contestant::FastPath());
  return all;
}

std::optional<Contestant> ContestantFromName(std::string_view name) {
  for (const Contestant& contestant : AllContestants()) {
    if (contestant.name() == name) return contestant;
  }
  return {};
}

}  // namespace vmech
