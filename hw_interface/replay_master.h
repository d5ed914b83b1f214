#pragma once

#include "vmech/hw_interface/recording.h"

namespace vmech {

/// A recorded hand as a master: sample after sample of a recording, one per read, whatever is
/// commanded. What was valid in the recording is valid again, but for the wrench that was at work:
/// nothing is.
class ReplayMaster : public Master {
 public:
  /// @throws std::invalid_argument if the recording is empty.
  explicit ReplayMaster(Recording recording);
  ~ReplayMaster() override { Shutdown(); }

  bool finished() const noexcept { return next_ == recording_.ticks.size(); }

 private:
  DeviceInfo OnConfigure() override;
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand&) noexcept override { return IoStatus::kOk; }

  Recording recording_;
  std::size_t next_ = 0;
};

}  // namespace vmech
