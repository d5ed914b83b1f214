#pragma once

#include <compare>
#include <optional>
#include <string_view>
#include <vector>

#include "vmech/comparison/suite.h"
#include "vmech/solvers/backend.h"

namespace vmech {

/// Who takes part in a comparison: one of the back ends of solvers/.
class Contestant {
 public:
  Contestant() = default;  ///< the first one
  explicit Contestant(Backend backend) : backend_(backend) {}

  Backend backend() const { return backend_; }
  std::string_view name() const { return NameOf(backend_); }

  friend auto operator<=>(const Contestant&, const Contestant&) = default;

 private:
  Backend backend_ = kAllBackends[0];
};

/// All of them, in the order of tables.
std::vector<Contestant> AllContestants();
std::optional<Contestant> ContestantFromName(std::string_view name);

}  // namespace vmech
