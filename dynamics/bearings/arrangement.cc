#include "vmech/dynamics/bearings/arrangement.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "vmech/base/tape/tape.h"

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

template <typename T>
std::array<Vector3<T>, 2> SharesOf(const std::vector<T>& positions, int locating,
                                   const Wrench<T>& wrench) {
  const std::vector<T>& z = positions;
  const Vector3<T>&f = wrench.force, &m = wrench.moment;
  Vector3<T> R_b = Vector3<T>::Zero();
  if (z.size() == 2) {
    const T per_distance = T(1) / (z[1] - z[0]);
    R_b = {per_distance * (m.y() - z[0] * f.x()), per_distance * (-m.x() - z[0] * f.y()), T(0)};
  }
  Vector3<T> R_a = f - R_b;
  if (locating == 1) std::swap(R_a.z(), R_b.z());
  return {R_a, R_b};
}
template std::array<Vector3d, 2> SharesOf<double>(const std::vector<double>&, int, const Wrenchd&);
template std::array<Vector3<Taped>, 2> SharesOf<Taped>(const std::vector<Taped>&, int,
                                                       const Wrench<Taped>&);

ArrangementLoads DistributeLoads(const Arrangement& arrangement,
                                 std::span<const Wrenchd> wrenches) {
  arrangement.Validate();
  const std::vector<double>& z = arrangement.positions;
  ArrangementLoads loads;
  loads.forces.assign(z.size(), std::vector<BearingForce>(wrenches.size()));
  loads.tilting_moment.assign(wrenches.size(), 0.0);
  for (size_t i = 0; i < wrenches.size(); ++i) {
    const std::array<Vector3d, 2> shares = SharesOf(z, arrangement.locating, wrenches[i]);
    for (size_t k = 0; k < z.size(); ++k) loads.forces[k][i].force = shares[k];
    if (z.size() == 2) continue;
    // m - z_a e_z x f: the moment about the only bearing.
    const Vector3d m_a = wrenches[i].moment - z[0] * Vector3d::UnitZ().cross(wrenches[i].force);
    loads.tilting_moment[i] = std::hypot(m_a.x(), m_a.y());
  }
  return loads;
}

}  // namespace vmech
