#pragma once

#include <cstdint>
#include <string>
#include <vector>

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
  /// A number that is none is the worst of all.
  void Add(double value, std::uint64_t at);
};

/// Where the energy of a recorded mechanism came from and went [J].
///
///   hand = kinetic + weight + joints + taken + withheld + untraced
///
/// Virtual coupling: implicit steps take 1/2 dV' I dV of every link, and what closes its loops and
/// limits its gains of energy acts on it like a force whose work is known from the links' momenta.
/// The paper's way: the inertia goes with velocities that lag behind those of the pose, u' = (v -
/// u) / t, which takes t u'' M u' a second; and where the wrench is kept within bounds, or the
/// nearest pose is not reached yet, the hand gives less or more than the mechanism gets.
struct EnergyBalance {
  double hand = 0;           ///< work of the hand's wrench on the mechanism
  double kinetic = 0;        ///< gained
  double weight = 0;         ///< gained in height
  double joints = 0;         ///< given to springs, friction and limits of joints
  double taken = 0;          ///< by the time steps, or by the lag of the inertia in the paper's way
  double withheld = 0;       ///< given beyond what the mechanism got, where its way is bounded
  double untraced = 0;       ///< the rest
  double untraced_most = 0;  ///< its largest size at any time
  double untraced_bound = 0;  ///< that steps of this size leave at most
  double throughput = 0;      ///< work of the hand without regard to its sign
  double constraint = 0;      ///< work of the constraints along the motions that they leave free
  bool follows = false;       ///< the mechanism follows the hand, in the paper's way

  /// hand - kinetic - weight - joints.
  double lost() const { return hand - kinetic - weight - joints; }
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

}  // namespace vmech
