#include "vmech/base/lanes4.h"

#include <bit>
#include <cstdint>

namespace vmech {
namespace {

constexpr double kLargestAngle = 1e5;  // beyond it the reduction below loses digits

Lanes4 WholePart(const Lanes4& x) {
  constexpr double kPushOutFraction = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kPushOutFraction) - kPushOutFraction;
}

/// Out of line, so that the usual case needs no registers of the caller's.
[[gnu::noinline, gnu::cold]] void SinCosLaneByLane(const Lanes4& angle, Lanes4* sine,
                                                   Lanes4* cosine) {
  const Lanes4 a = angle;
  *sine = FromLanes<Lanes4>([&](int k) { return std::sin(a[k]); });
  *cosine = FromLanes<Lanes4>([&](int k) { return std::cos(a[k]); });
}

}  // namespace

// Reduction to |r| <= pi/4 with pi/2 in three parts (the first two of 33 bits, so that their
// multiples are exact), then the polynomials of least error. Constants: fdlibm, Sun Microsystems.
void SinCos(const Lanes4& angle, Lanes4* sine, Lanes4* cosine) {
  if (!AllLanes(abs(angle) <= Lanes4(kLargestAngle))) {
    return SinCosLaneByLane(angle, sine, cosine);
  }
  const Lanes4 quarters = WholePart(angle * 6.36619772367581382433e-01);
  const Lanes4 r =
      ((angle - quarters * 1.57079632673412561417e+00) - quarters * 6.07710050630396597660e-11) -
      quarters * 2.02226624879595063154e-21;
  const Lanes4 z = r * r;
  // In pairs, which need not wait for each other.
  const Lanes4 zz = z * z;
  const Lanes4 s =
      r + r * z *
              ((-1.66666666666666324348e-01 + z * 8.33333333332248946124e-03) +
               zz * ((-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                     zz * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  const Lanes4 c =
      1.0 -
      (0.5 * z - zz * ((4.16666666666666019037e-02 + z * -1.38888888888741095749e-03) +
                       zz * ((2.48015872894767294178e-05 + z * -2.75573143513906633035e-07) +
                             zz * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11))));
  // quarters mod 4 tells which of the two is the sine, and the signs.
  const Lanes4 half = WholePart(quarters * 0.5 - 0.25);  // floor(quarters / 2)
  const Lanes4 odd = quarters - 2.0 * half;              // 0 or 1
  const Lanes4 sign = 1.0 - 2.0 * (half - 2.0 * WholePart(half * 0.5 - 0.25));
  const auto swap = odd > Lanes4(0.5);
  *sine = sign * Select(swap, c, s);
  *cosine = sign * Select(swap, -s, c);
}

// atan(t) for |t| <= 7/16 by fdlibm's polynomial; t = tan(angle - pi/4) brings the rest of the
// first octant there, and symmetry the other octants.
Lanes4 atan2(const Lanes4& y, const Lanes4& x) {
  const Lanes4 ax = abs(x), ay = abs(y);
  const Lanes4 larger = max(ax, ay), smaller = min(ax, ay);
  const auto steep = smaller > 0.4142135623730950488 * larger;  // beyond pi/8
  const Lanes4 over = Select(steep, smaller - larger, smaller);
  const Lanes4 under = Select(steep, smaller + larger, larger);
  const Lanes4 t = over / Select(under > Lanes4(0.0), under, Lanes4(1.0));
  const Lanes4 z = t * t;
  const Lanes4 w = z * z;
  const Lanes4 odd =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const Lanes4 even =
      w * (-1.99999999998764832476e-01 +
           w * (-1.11111104054623557880e-01 +
                w * (-7.69187620504482999495e-02 +
                     w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  Lanes4 angle = t - t * (odd + even);
  angle = Select(steep, 0.78539816339744830962 + angle, angle);
  angle = Select(ay > ax, 1.57079632679489661923 - angle, angle);
  angle = Select(x < Lanes4(0.0), 3.14159265358979323846 - angle, angle);
  return Select(y < Lanes4(0.0), -angle, angle);
}

}  // namespace vmech
