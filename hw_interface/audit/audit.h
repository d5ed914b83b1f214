#pragma once

#include <memory>

#include "vmech/hw_interface/audit/audit_report.h"
#include "vmech/hw_interface/recording/tick_listener.h"

namespace vmech {

/// Computes anew, from a recording alone, what it says of the mechanism: energy, closure of the
/// loops, pose of the grasp, the hand in the world, the way from the mechanism's wrench to what was
/// sent, the balance of forces and moments of every link, and that constraints do no work along the
/// motions that they leave free. A number that does not belong there shows in one of these.
class RecordingAudit : public TickListener {
 public:
  /// @throws std::invalid_argument if the recording does not hold its mechanism or names no grasp
  /// of it; FileErrors if that mechanism cannot be read.
  explicit RecordingAudit(const RecordingHeader& header);
  ~RecordingAudit() override;

  void Take(const TickRecord& tick) override;  ///< the next tick of the recording
  AuditReport Report() const;                  ///< on all ticks so far

  // After a tick.
  bool started() const;                 ///< a hand has had the mechanism
  const EnergyBalance& energy() const;  ///< until now
  double closure() const;               ///< of the loops, lengths over the mechanism's

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vmech
