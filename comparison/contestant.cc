#include "vmech/comparison/contestant.h"

namespace vmech {

std::vector<Contestant> AllContestants() {
  std::vector<Contestant> all;
  for (const Backend backend : kAllBackends) all.emplace_back(backend);
  return all;
}

std::optional<Contestant> ContestantFromName(std::string_view name) {
  for (const Contestant& contestant : AllContestants()) {
    if (contestant.name() == name) return contestant;
  }
  return {};
}

}  // namespace vmech
