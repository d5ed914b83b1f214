#pragma once

#include <limits>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/kinematics/motion/table_roughness.h"

namespace vmech {

/// Position, velocity and acceleration of a coordinate at one time.
struct MotionSample {
  double position = 0;      ///< [m] or [rad]
  double velocity = 0;      ///< [m/s] or [rad/s]
  double acceleration = 0;  ///< [m/s^2] or [rad/s^2]
};

/// How a driven coordinate moves in time: at constant acceleration, or through a table by the cubic
/// spline with not-a-knot ends (twice continuously differentiable; a table of one row stands still,
/// of two moves at constant speed, of three on a parabola). Where the table dwells (FindDwells) the
/// coordinate stands exactly still from the first of the equal rows to the last, these included;
/// the splines before and behind end there with velocity zero, so that only the acceleration jumps.
/// SI units and radians.
class MotionLaw {
 public:
  /// position = start + speed t + acceleration t^2 / 2, t in seconds from 0.
  /// @throws std::invalid_argument if one is not finite.
  static MotionLaw Uniform(double start, double speed, double acceleration = 0);
  /// @throws std::invalid_argument if the lengths differ, the table is empty, a value is not finite
  ///         or the times do not increase; the message names the row (counted from 1).
  static MotionLaw Table(const std::vector<double>& times, const std::vector<double>& values);

  /// True for MotionLaw(), a law that was not given: it has no position.
  bool empty() const { return pieces_.empty(); }
  /// At a time [s]; outside a table by its first or last polynomial. Precondition: not empty.
  MotionSample At(double t) const;
  /// The roughness of the table; zero for a uniform motion.
  const TableRoughness& roughness() const { return roughness_; }
  /// The first and the last time of a table of two rows or more, beyond which nothing is known of
  /// the motion [s]. Any other motion has no bounds.
  double begins() const { return begins_; }
  double ends() const { return ends_; }  ///< as begins()

 private:
  friend class HandLaw;
  static MotionLaw TableWithDwells(const std::vector<double>& times,
                                   const std::vector<double>& values,
                                   const std::vector<bool>& dwells);
  void AddSpline(const std::vector<double>& times, const std::vector<double>& values,
                 bool rests_before, bool rests_after);

  struct Piece {
    double from;  ///< the first time that it holds for; just behind t0 where a dwell ends
    double t0;
    double c[4];  ///< position = sum c_k (t - t0)^k
  };
  std::vector<Piece> pieces_;
  TableRoughness roughness_;
  double begins_ = -std::numeric_limits<double>::infinity();
  double ends_ = std::numeric_limits<double>::infinity();
};

/// Pose, velocity and acceleration of a hand-held frame in the world.
struct HandSample {
  Posed X_WH;     ///< pose in the world
  Vector6d V_WH;  ///< [v; w] of Ho and H, world axes [m/s, rad/s]
  Vector6d A_WH;  ///< [a; alpha] of Ho and H, world axes [m/s^2, rad/s^2]
};

/// How the hand moves: a cubic spline through positions, and one through the rotation vectors that
/// lead from the first orientation to each other one, in the axes of the first (smooth, and exact
/// at the rows). Position and orientation dwell each for themselves, as MotionLaw does.
class HandLaw {
 public:
  /// @throws std::invalid_argument as MotionLaw::Table, or for an orientation that is more than 178
  ///         degrees (0.99 pi) away from the first.
  static HandLaw Table(const std::vector<double>& times, const std::vector<Posed>& poses);

  /// True for HandLaw(), a law that was not given: it has no pose.
  bool empty() const { return position_.empty(); }
  /// At a time [s]; outside the table by its first or last polynomials. Precondition: not empty.
  HandSample At(double t) const;
  double begins() const { return position_[0].begins(); }  ///< as of a MotionLaw; not empty [s]
  double ends() const { return position_[0].ends(); }      ///< the same
  /// The roughness of its positions [m/s^2].
  TableRoughness position_roughness() const { return Together(position_); }
  /// The roughness of its rotation vectors [rad/s^2].
  TableRoughness rotation_roughness() const { return Together(rotation_vector_); }

 private:
  /// Root of the sum of squares over three axes.
  static TableRoughness Together(const std::vector<MotionLaw>& axes);

  Matrix3d R_W0_ = Matrix3d::Identity();
  std::vector<MotionLaw> position_;
  std::vector<MotionLaw> rotation_vector_;
};

}  // namespace vmech
