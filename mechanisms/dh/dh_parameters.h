#pragma once

#include <string_view>

#include "vmech/base/pose.h"

namespace vmech {

/// Standard Denavit-Hartenberg parameters: from a frame whose z axis is one joint axis to a frame
/// whose z axis is the next, x along their common normal,
///   X = Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta).
/// [Denavit & Hartenberg 1955]; beta, which is zero but for nearly parallel axes, is Hayati's
/// [Hayati & Mirmirani 1985].
struct DhParameters {
  double theta = 0;  ///< [rad] about z, to the common normal
  double d = 0;      ///< [m] along z, to the foot of the common normal
  double a = 0;      ///< [m] along x, the distance of the axes
  double alpha = 0;  ///< [rad] about x, the angle of the axes
  double beta = 0;   ///< [rad] about y
};

/// The pose X above.
Posed PoseOf(const DhParameters& row);

/// How two axes lie to each other.
enum class AxesRelation {
  kSkew,            ///< one common normal
  kIntersecting,    ///< a = 0, x square to both
  kParallel,        ///< the same or the opposite sense; d = 0
  kCoincident,      ///< one line; d = a = 0, theta = 0
  kNearlyParallel,  ///< below kNearlyParallel: Hayati's form, d = 0
};
/// "skew", "nearly parallel".
std::string_view NameOf(AxesRelation relation);

/// Sine of the angle below which axes are nearly parallel [-]. The foot of their common normal is
/// 1 / sine times as far as the axes are from each other: at 1e-4 a link of 1 m would have a d of
/// up to 10 km, and poses lose four digits.
constexpr double kNearlyParallel = 1e-4;
/// Sine of the angle below which axes are parallel: as far as doubles tell [-].
constexpr double kParallel = 4e-15;

/// A pose by its six parameters, two rows: X_PQ = PoseOf(row) Rz(theta) Tz(d). The row leads from
/// the z axis of P, a line, to the z axis of Q; theta and d along that to Q itself.
struct DhPair {
  AxesRelation relation = AxesRelation::kCoincident;  ///< of both z axes
  DhParameters row;                                   ///< from the line of P's z to that of Q's
  double theta = 0;                                   ///< [rad]
  double d = 0;                                       ///< [m]
};

/// The row between the z axes of P and Q by their common normal. Where the axes leave a choice: x
/// points from P's axis to Q's, and where they meet it is that of +-z_P x z_Q which is nearer to x
/// of P (z_P x z_Q on a tie); for parallel axes the normal goes through P's origin; for nearly
/// parallel ones x points from P's origin to where Q's axis pierces the xy plane of P.
DhPair DeduceDh(const Posed& X_PQ);

}  // namespace vmech
