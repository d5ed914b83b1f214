#pragma once

#include <compare>
#include <optional>
#include <string_view>
#include <vector>

#include "vmech/comparison/suite.h"
#include "vmech/solvers/backend.h"

namespace vmech {

/// Who takes part in a comparison: the back ends of solvers/, and the fast path
/// (kinematics/hand_tracker.h), which follows paths only.
class SolverEntry {
 public:
  SolverEntry() = default;  ///< the first one
  /// Any but the fast path.
  explicit SolverEntry(Backend backend) : place_(static_cast<int>(backend)) {}
  static SolverEntry FastPath();  ///< the tracker of hands

  std::string_view name() const;  ///< as in tables and on the command line
  /// None for the fast path.
  std::optional<Backend> backend() const;
  /// The fast path takes paths alone.
  bool Takes(const TargetBlock& block) const { return backend() || block.is_path(); }

  /// In the order of tables.
  friend auto operator<=>(const SolverEntry&, const SolverEntry&) = default;  // NOLINT

 private:
  int place_ = 0;  // in the order of tables: that of Backend, then the fast path
};

/// All of them, in the order of tables.
std::vector<SolverEntry> AllContestants();
/// The one of a name; none if there is none.
std::optional<SolverEntry> ContestantFromName(std::string_view name);

}  // namespace vmech
