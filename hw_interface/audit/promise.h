#pragma once

#include "vmech/dynamics/in_hand/virtual_coupling.h"
#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// What a session was set up to make a hand feel.
struct SessionPromise {
  bool known = false;     ///< false: the recording does not say
  bool paper = false;     ///< the paper's way, else the virtual coupling
  double scale = 1;       ///< force at the hand over force at the mechanism
  double inertia = 1;     ///< share of the mechanism's inertia
  HandCoupling coupling;  ///< at the mechanism: of the spring, or of the paper's constraint
  double roll_off = 0;    ///< of the acceleration in the paper's way [s]; 0: none
};

/// As notes of a recording; of the hand, counted from 0.
RecordingNotes NotesOf(const SessionPromise& promise, int hand = 0);
/// What a recording's notes say of it.
SessionPromise PromiseOf(const RecordingHeader& header, int hand = 0);

}  // namespace vmech
