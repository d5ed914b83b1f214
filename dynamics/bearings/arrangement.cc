#include "vmech/dynamics/bearings/arrangement.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace vmech {

void Arrangement::Validate() const {
  const int count = static_cast<int>(positions.size());
  if (count != 1 && count != 2) {
    throw std::invalid_argument(
        fmt::format("arrangement: {} positions are given; a joint has one or two bearings", count));
  }
  for (double z : positions) {
    if (!std::isfinite(z)) {
      throw std::invalid_argument(fmt::format("arrangement: position {} is not finite", z));
    }
  }
  if (count == 2 && positions[0] == positions[1]) {
    throw std::invalid_argument(fmt::format(
        "arrangement: both bearings are at {} m; they cannot take a tilting moment without a "
        "distance between them",
        positions[0]));
  }
  if (locating < 0 || locating >= count) {
    throw std::invalid_argument(
        fmt::format("arrangement: locating is {}, but must be the index of a bearing, 0 .. {}",
                    locating, count - 1));
  }
}

ArrangementLoads DistributeLoads(const Arrangement& arrangement,
                                 std::span<const Wrenchd> wrenches) {
  arrangement.Validate();
  const std::vector<double>& z = arrangement.positions;
  ArrangementLoads loads;
  loads.forces.assign(z.size(), std::vector<BearingForce>(wrenches.size()));
  loads.tilting_moment.assign(wrenches.size(), 0.0);
  for (size_t i = 0; i < wrenches.size(); ++i) {
    const Vector3d& f = wrenches[i].force;
    // m - z_a e_z x f: the moment about the first bearing.
    const Vector3d m_a = wrenches[i].moment - z[0] * Vector3d::UnitZ().cross(f);
    Vector3d R_b = Vector3d::Zero();
    if (z.size() == 2) {
      // (z_b - z_a) e_z x R_b = m_a, x and y.
      R_b = Vector3d(m_a.y(), -m_a.x(), 0) / (z[1] - z[0]);
    } else {
      loads.tilting_moment[i] = std::hypot(m_a.x(), m_a.y());
    }
    Vector3d R_a = f - R_b;
    if (arrangement.locating == 1) std::swap(R_a.z(), R_b.z());
    loads.forces[0][i].force = R_a;
    if (z.size() == 2) loads.forces[1][i].force = R_b;
  }
  return loads;
}

}  // namespace vmech
