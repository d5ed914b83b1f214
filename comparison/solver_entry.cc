#include "vmech/comparison/solver_entry.h"

namespace vmech {
namespace {

constexpr int kBackends = static_cast<int>(kAllBackends.size());

}  // namespace

SolverEntry SolverEntry::FastPath() {
  SolverEntry solver_entry;
  solver_entry.place_ = kBackends;
  return solver_entry;
}

std::string_view SolverEntry::name() const {
  return place_ == kBackends ? "hand_tracker" : NameOf(kAllBackends[place_]);
}

std::optional<Backend> SolverEntry::backend() const {
  if (place_ == kBackends) return {};
  return kAllBackends[place_];
}

std::vector<SolverEntry> AllContestants() {
  std::vector<SolverEntry> all;
  for (const Backend backend : kAllBackends) all.emplace_back(backend);
  all.push_back(SolverEntry::FastPath());
  return all;
}

std::optional<SolverEntry> ContestantFromName(std::string_view name) {
  for (const SolverEntry& solver_entry : AllContestants()) {
    if (solver_entry.name() == name) return solver_entry;
  }
  return {};
}

}  // namespace vmech
