#pragma once

#include <compare>
#include <optional>
#include <string_view>
#include <vector>

#include "vmech/comparison/suite.h"
#include "vmech/solvers/backend.h"

namespace vmech {

/// Who takes part in a comparison: the back ends of solvers/, and the fast path
/// (kinematics/inverse/hand_tracker.h), which follows paths only.
class SolverEntry {
 public:
  SolverEntry() = default;  ///< the first back end
  /// A back end.
  explicit SolverEntry(Backend backend) : place_(static_cast<int>(backend)) {}
  static SolverEntry FastPath();  ///< HandTracker

  std::string_view name() const;  ///< as in tables and on the command line
  /// The back end; none for the fast path.
  std::optional<Backend> backend() const;
  /// The fast path takes paths alone.
  bool Takes(const TargetBlock& block) const { return backend() || block.is_path(); }

  /// In the order of tables.
  friend auto operator<=>(const SolverEntry&, const SolverEntry&) = default;  // NOLINT

 private:
  int place_ = 0;  // in the order of tables: that of Backend, then the fast path
};

/// All solvers, in the order of tables.
std::vector<SolverEntry> AllContestants();
/// The solver of a name; nothing if there is no such solver.
std::optional<SolverEntry> ContestantFromName(std::string_view name);

}  // namespace vmech
