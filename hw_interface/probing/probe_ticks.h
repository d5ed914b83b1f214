#pragma once

#include <functional>

#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

/// Ticks that move the handle itself, without a mechanism. Forces are in the device's axes: a
/// runner of theirs has R_WD = 1. Each keeps the handle near where it was with a soft spring, holds
/// still in rotation, and never asks for more than its largest force. No allocation after
/// construction.

/// Safety for such a run: no more than `force` [N], trips at twice the wanted speed, and at a fifth
/// of a joule beyond a watt.
SafetyOptions ProbeSafety(double force, double speed);

/// A spring and a damper from the handle to a point.
class HandleSpring {
 public:
  /// `stiffness` [N/m], `damping` [N s/m], `period` of the samples [s].
  HandleSpring(double stiffness, double damping, double period)
      : stiffness_(stiffness), damping_(damping), period_(period) {}

  void Reset() noexcept { has_pose_ = false; }  ///< the next sample is the first
  /// Takes a sample, `elapsed` [s] after the last.
  void Update(const Vector3d& p, double elapsed) noexcept;
  /// Pull towards `target` [m].
  Vector3d Pull(const Vector3d& target) const noexcept {
    return stiffness_ * (target - p_) - damping_ * v_;
  }
  const Vector3d& p() const noexcept { return p_; }  ///< of the last sample [m]
  const Vector3d& v() const noexcept { return v_; }  ///< smoothed over 5 ms

 private:
  double stiffness_, damping_, period_;
  bool has_pose_ = false;
  Vector3d p_ = Vector3d::Zero(), v_ = Vector3d::Zero();
};

/// How a handle is shaken to be identified.
struct ShakeOptions {
  double force = 1;      ///< largest [N], in [0.01, 100]
  double reach = 0.015;  ///< the force grows until the handle moves so far [m], in [1e-4, 0.2]
  double speed = 0.1;    ///< or so fast [m/s], in [1e-3, 1]
  double seconds = 8;    ///< for each of the three axes, in [1, 100]
  /// Blows along each axis that rise to this force [N]; 0: none, in [0, 1e3].
  double blows_to = 0;
  double mass = 0;  ///< of the handle [kg], in [0, 1e3]; with blows in [1e-4, 1e3]

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
  double total_seconds() const noexcept;  ///< of a run along all three axes, rests included [s]
};

/// Shakes the handle along x, y and z, one after the other, by five sines from 0.9 to 8.9 Hz whose
/// force grows until there is motion enough. With `blows_to`, gives pairs of short opposite blows
/// instead, which leave the handle at rest where it was. The channel tells what is being done: the
/// axis, and the force of the blow.
class ShakeTick : public Tick {
 public:
  /// @throws std::invalid_argument as Validate.
  ShakeTick(const ShakeOptions& options, double period);

  std::vector<std::string> ChannelNames() const override { return {"axis", "blow"}; }
  Posed GraspFrame() const noexcept override { return {}; }
  void Reset() noexcept override;
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;

 private:
  double Shaken(double time) noexcept;
  double Struck(double time, double* blow) const noexcept;

  ShakeOptions options_;
  double period_;
  HandleSpring spring_;
  long ticks_ = 0;
  int axis_ = -1;
  double gain_ = 0;
  Vector3d start_ = Vector3d::Zero();
};

/// Draws the handle to a point: a target moves there at a tenth of a metre per second, and a spring
/// of at most `force` draws the handle along.
class GuideTick : public Tick {
 public:
  /// `arrived` is called once the handle has stayed within 3 mm of `home` for a third of a second.
  GuideTick(const Vector3d& home, double force, double period, std::function<void()> arrived);

  std::vector<std::string> ChannelNames() const override { return {}; }
  Posed GraspFrame() const noexcept override { return {}; }
  void Reset() noexcept override;
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;

  /// Distance of the handle from its home [m].
  double distance() const noexcept { return (home_ - spring_.p()).norm(); }

 private:
  Vector3d home_, target_ = Vector3d::Zero();
  double force_, period_;
  HandleSpring spring_;
  std::function<void()> arrived_;
  bool started_ = false;
  double there_for_ = 0;  // [s]
};

}  // namespace vmech
