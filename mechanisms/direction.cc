#include "vmech/mechanisms/direction.h"

#include <cmath>

namespace vmech {

Vector3d NearUnitLength(const Vector3d& direction) {
  const double size = direction.cwiseAbs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) return direction;
  const int power = -std::ilogb(size);
  return direction.unaryExpr([power](double entry) { return std::scalbn(entry, power); });
}

}  // namespace vmech
