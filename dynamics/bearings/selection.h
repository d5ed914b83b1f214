#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vmech/dynamics/bearings/rating.h"

namespace vmech {

/// A bearing of the catalogue and what speaks against it.
struct Candidate {
  Bearing bearing;                      ///< of the catalogue
  std::optional<BearingRating> rating;  ///< absent if the dimensions do not fit
  std::vector<Shortfall> shortfalls;    ///< empty if it fits

  bool fits() const { return shortfalls.empty(); }  ///< meets every requirement
};

/// The outcome of a selection.
struct BearingSelection {
  std::vector<Candidate> candidates;  ///< the whole catalogue in order of size
  int chosen = -1;                    ///< index of the smallest that fits; -1 if none does
  int closest = -1;                   ///< if none fits: index of the one that comes closest
  std::vector<std::string> warnings;  ///< about the chosen bearing
  std::string message;                ///< the choice, or what came closest and why

  /// The chosen bearing, or the closest one; null if the catalogue is empty.
  const Candidate* best() const;
  /// Why a candidate was not chosen: its shortfalls, that it is larger than the choice, or that it
  /// is too small for a partner.
  std::string ReasonAgainst(int candidate) const;
  /// Takes a candidate that fits.
  void Choose(int candidate, const RotationSummary& rotation,
              const BearingRequirements& requirements);
};

/// Selects the smallest bearing (IsSmaller: least outer diameter, then least width, then greatest
/// C) that has room, life, static safety, speed and axial capacity, and stays within the validity
/// of ISO 281. More load never selects a smaller bearing. If none fits, the closest is the one
/// whose worst shortfall is the least, among those that have room as far as there are any.
BearingSelection SelectBearing(std::span<const Bearing> catalogue,
                               std::span<const BearingForce> forces,
                               const RotationSummary& rotation,
                               const BearingRequirements& requirements);

}  // namespace vmech
