#include "vmech/hw_interface/safety/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

double Stiffness(double damping, double hold) {
  return std::max(0.0, damping) / hold;
}

double AtMost(double wanted, double bound) {
  return wanted > 0 ? std::min(wanted, bound) : 0;
}

std::string Line(const char* motion, const char* force, const char* step,
                 const HandlePhysics& handle, const DeviceInfo& info) {
  const RenderingBounds bounds = BoundsOf(handle, info.period, info.delay);
  const std::string quiet = std::isinf(bounds.quiet_stiffness)
                                ? "no resolution stated"
                                : fmt::format("quiet up to {:.4g}", bounds.quiet_stiffness);
  return fmt::format(
      "{}: passive up to K = {:.4g} {}/{} or B = {:.4g} {} s/{} ({}); own damping {:.4g}, T = {:g} "
      "ms, delay {:g} ms\n",
      motion, bounds.passive_stiffness, force, step, bounds.passive_damping, force, step, quiet,
      handle.damping, 1e3 * info.period, 1e3 * info.delay);
}

}  // namespace

RenderingBounds BoundsOf(const HandlePhysics& handle, double period, double delay, double damping) {
  const double b = handle.damping;
  const double hold = 0.5 * period + delay;
  RenderingBounds bounds;
  bounds.passive_stiffness = Stiffness(b - std::abs(damping), hold);
  bounds.stable_stiffness = Stiffness(b + damping, hold);
  bounds.quiet_stiffness = handle.resolution > 0
                               ? std::min(2 * b / period, 2 * handle.coulomb / handle.resolution)
                               : std::numeric_limits<double>::infinity();
  bounds.passive_damping = b;
  bounds.stable_inertia = handle.mass;
  return bounds;
}

RenderingGains LimitedGains(const DeviceInfo& info, const RenderingGains& wanted) {
  RenderingGains gains;
  for (int i = 0; i < 6; ++i) {
    const HandlePhysics& handle = i < 3 ? info.linear : info.angular;
    const RenderingBounds alone = BoundsOf(handle, info.period, info.delay);
    gains.damping[i] = AtMost(wanted.damping[i], alone.passive_damping);
    const RenderingBounds both = BoundsOf(handle, info.period, info.delay, gains.damping[i]);
    gains.stiffness[i] = AtMost(wanted.stiffness[i], both.passive_stiffness);
  }
  return gains;
}

std::string BoundsReport(const DeviceInfo& info) {
  return Line("translation", "N", "m", info.linear, info) +
         Line("rotation", "N m", "rad", info.angular, info);
}

}  // namespace vmech
