#include "vmech/kinematics/loops/axis_misfit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

constexpr double kExact = 1e-12;  // [rad, m]

/// Two anchors of a link.
struct AnchorPair {
  Posed a, b;
  double Angle() const {
    const Vector3d z_a = a.R.col(2), z_b = b.R.col(2);
    return std::atan2(z_a.cross(z_b).norm(), std::abs(z_a.dot(z_b)));
  }
  double Distance() const { return (b.p - a.p).norm(); }
};

AxisMisfit Compare(const AnchorPair& drawn, const AnchorPair& reconciled) {
  AxisMisfit misfit;
  misfit.parallel = reconciled.Angle() < kExact;
  misfit.angle = std::abs(drawn.Angle() - reconciled.Angle());
  misfit.distance = std::abs(drawn.Distance() - reconciled.Distance());
  return misfit;
}

std::string Small(double value, std::string_view unit) {
  if (value < 1e-8) return fmt::format("{:.3g} n{}", 1e9 * value, unit);
  if (value < 1e-3) return fmt::format("{:.3g} u{}", 1e6 * value, unit);
  return fmt::format("{:.3g} m{}", 1e3 * value, unit);
}

std::string MisfitInWords(const Mechanism& m, const AxisMisfit& misfit) {
  const std::string pair =
      fmt::format("'{}' and '{}' on '{}'", m.joints[misfit.joint].name,
                  m.joints[misfit.other_joint].name, m.links[misfit.link].name);
  if (misfit.angle >= misfit.distance) {
    return fmt::format("the axes of {} are {} off {}", pair, Small(misfit.angle, "rad"),
                       misfit.parallel ? "parallel" : "the angle that closes the loops");
  }
  return fmt::format("the centres of {} are {} off the distance that closes the loops", pair,
                     Small(misfit.distance, "m"));
}

}  // namespace

std::vector<AxisMisfit> FindAxisMisfits(const Mechanism& drawn, const Mechanism& reconciled) {
  std::vector<AxisMisfit> misfits;
  const std::vector<Joint>& joints = drawn.joints;
  for (size_t a = 0; a < joints.size(); ++a) {
    for (size_t b = a + 1; b < joints.size(); ++b) {
      for (const AnchorId& at_a : {joints[a].first, joints[a].second}) {
        for (const AnchorId& at_b : {joints[b].first, joints[b].second}) {
          if (at_a.link != at_b.link) continue;
          AxisMisfit misfit = Compare({drawn.anchor(at_a).X_LA, drawn.anchor(at_b).X_LA},
                                      {reconciled.anchor(at_a).X_LA, reconciled.anchor(at_b).X_LA});
          misfit.link = at_a.link;
          misfit.joint = static_cast<int>(a);
          misfit.other_joint = static_cast<int>(b);
          if (misfit.angle > kExact || misfit.distance > kExact) misfits.push_back(misfit);
        }
      }
    }
  }
  std::sort(misfits.begin(), misfits.end(), [](const AxisMisfit& a, const AxisMisfit& b) {
    return a.angle + a.distance > b.angle + b.distance;
  });
  return misfits;
}

std::string DescribeMisfits(const Mechanism& mechanism, const std::vector<AxisMisfit>& misfits) {
  constexpr size_t kNamed = 3;
  std::string text;
  for (size_t i = 0; i < std::min(kNamed, misfits.size()); ++i) {
    text += (i == 0 ? "" : ", ") + MisfitInWords(mechanism, misfits[i]);
  }
  if (misfits.size() > kNamed) text += fmt::format(", and {} more", misfits.size() - kNamed);
  return text;
}

}  // namespace vmech
