#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Forces of a mechanism's joints over a run: a channel each, as far as there is room, and the
/// largest. No allocation after construction.
class PeakForces {
 public:
  explicit PeakForces(const Mechanism& mechanism);  ///< for its joints, in their order

  /// "force main", ... behind the names that are there already, as far as kMaxChannels allow.
  void AppendNames(std::vector<std::string>* names) const;
  void Reset() noexcept;  ///< makes all of them zero
  /// The joints' wrenches of a tick; writes their forces [N] into as many channels as there are.
  void Add(const std::vector<Wrenchd>& joints, std::span<double> channels) noexcept;

  const std::vector<double>& forces() const noexcept { return forces_; }  ///< largest [N]
  std::string Report() const;                                             ///< a line per joint

 private:
  std::vector<std::string> names_;
  std::vector<double> forces_;
};

}  // namespace vmech
