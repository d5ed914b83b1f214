#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vmech/hw_interface/recording/tick_listener.h"

namespace vmech {

/// One thing that an audit looked at in every tick.
struct AuditFinding {
  std::string what;        ///< a few words for the report
  double worst = 0;        ///< of all ticks
  double bound = 0;        ///< up to which it is sound
  std::string unit;        ///< "-" for shares
  std::uint64_t tick = 0;  ///< of the worst, counted from 0
  /// True if the worst is within the bound.
  bool sound() const { return worst <= bound; }  // not for a number that is none
};

/// Where the energy of a recorded mechanism came from and went [J].
struct EnergyBalance {
  double hand = 0;        ///< work of the hand's wrench on the mechanism
  double kinetic = 0;     ///< gained
  double weight = 0;      ///< gained in height
  double joints = 0;      ///< given to springs, friction and limits of joints
  double lost = 0;        ///< hand - kinetic - weight - joints: what the time steps took
  double gained = 0;      ///< most that the time steps ever had given
  double throughput = 0;  ///< work of the hand without regard to its sign
  double constraint = 0;  ///< work of the constraints along the motions that they leave free

  std::string Text() const;  ///< a line
};

/// What an audit of a recording found.
struct AuditReport {
  std::uint64_t ticks = 0;             ///< that were looked at
  std::vector<AuditFinding> findings;  ///< in the order of the report
  EnergyBalance energy;                ///< since the hand took hold
  std::string left_out;                ///< what could not be judged and why; may be empty

  bool sound() const;           ///< every finding is
  std::string Verdict() const;  ///< a sentence
  std::string Text() const;     ///< lines with figures, and the verdict
};

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
