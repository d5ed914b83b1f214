#pragma once

#include <string>

#include "vmech/hw_interface/masters/master.h"

namespace vmech {

/// Where a 6-axis mouse is read, and what its deflection means.
struct SpacenavOptions {
  /// The daemon's socket; empty: $SPNAV_SOCKET, or where Debian's spacenavd puts it.
  std::string socket;
  double period = 1e-3;  ///< T at which it is read [s], in [1e-4, 0.1]
  double speed = 1e-3;   ///< of the handle per count of deflection [m/s], in [1e-9, 1]; full is 350
  double angular_speed = 5e-3;  ///< [rad/s] per count, in [1e-9, 10]
  Posed X_DH;                   ///< where the handle starts

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// A 6-axis mouse behind spacenavd: its cap's deflection is the handle's twist in D, with x right,
/// y up, z towards the user as the daemon reports them; the first button, held, closes the gripper.
/// It exerts no force. The daemon's socket is spoken to directly, in its first protocol (32-byte
/// events), which every version serves: no library, no state shared by the process, nothing
/// allocated.
class SpacenavMaster : public Master {
 public:
  /// @throws std::invalid_argument as Validate.
  explicit SpacenavMaster(SpacenavOptions options = {});
  ~SpacenavMaster() override { Shutdown(); }

 private:
  DeviceInfo OnConfigure() override;
  void OnShutdown() noexcept override;
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand&) noexcept override { return IoStatus::kOk; }
  bool TakeEvents() noexcept;
  void Move(double seconds) noexcept;

  SpacenavOptions options_;
  int fd_ = -1;
  std::array<std::int32_t, 8> event_;
  std::size_t received_ = 0;  // bytes of event_
  Vector6d V_DH_ = Vector6d::Zero();
  Posed X_DH_;
  std::uint32_t buttons_ = 0;
  std::uint64_t sequence_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace vmech
