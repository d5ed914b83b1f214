#pragma once

#include "vmech/hw_interface/masters/master.h"
#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// How much of a recorded session is repeated.
enum class ReplayKind {
  kHand,     ///< the hand only: no wrench is at work, whatever was
  kSession,  ///< the device with its physics, the wrenches at work, the samples that were missing,
             ///< and what the hand's observer made of them
};

/// A recording as a master: sample after sample, one per read, whatever is commanded.
class ReplayMaster : public Master {
 public:
  /// `hand`: of several, counted from 0. @throws std::invalid_argument if the recording is empty or
  /// does not have that hand.
  explicit ReplayMaster(Recording recording, ReplayKind kind = ReplayKind::kHand, int hand = 0);
  ~ReplayMaster() override { Shutdown(); }

  const MovingFrame* ObservedHand() const noexcept override;
  WrenchLimit Room() const noexcept override { return room_; }
  bool finished() const noexcept { return next_ == recording_.ticks.size(); }  ///< no tick is left

 private:
  DeviceInfo OnConfigure() override;
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand&) noexcept override { return IoStatus::kOk; }

  Recording recording_;
  ReplayKind kind_;
  int index_;  // of the hand
  std::size_t next_ = 0;
  bool observed_ = false;
  MovingFrame hand_;
  WrenchLimit room_;
};

}  // namespace vmech
