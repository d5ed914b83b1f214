#pragma once

#include "vmech/base/screw.h"

namespace vmech {

/// The wrench of a spring that nothing holds any more. It falls with a time constant of 20 ms, and
/// its force no faster than a rate [N/s]; where it drives what it acts on, it falls with what that
/// takes out of the spring,
///
///   E = w'K^-1 w / 2,   (1 + c)/2 w.dX <= (1 - c^2) E   by   c = 1 - w.dX/2E.
class FadingWrench {
 public:
  FadingWrench() = default;
  /// For springs of stiffness K [N/m, N m/rad], zero rows included; `rate` [N/s], steps of T [s].
  FadingWrench(const Screw& stiffness, double rate, double step);

  void Add(const Screw& w) noexcept;  ///< one more that fades
  /// A step in which it acts on what moves away from its other end with V.
  void Step(const Screw& V) noexcept;

  bool acts() const noexcept;                     ///< it has not faded yet
  const Screw& w() const noexcept { return w_; }  ///< what is left of it
  double energy() const noexcept;                 ///< [J]

 private:
  Screw w_, compliance_;
  double most_ = 0, share_ = 0, T_ = 0;
};

}  // namespace vmech
