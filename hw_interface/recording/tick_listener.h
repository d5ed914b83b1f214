#pragma once

#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// Takes the ticks of a session one after the other, and need not be as fast as they come.
class TickListener {
 public:
  virtual ~TickListener() = default;
  /// The tick is the caller's, valid during the call.
  virtual void Take(const TickRecord& tick) = 0;
};

}  // namespace vmech
