#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/examples.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"

namespace vmech {

/// A figure as a file states it with so many significant digits.
inline double Rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  return std::atof(text);
}

inline Vector3d Rounded(const Vector3d& v, int digits) {
  return {Rounded(v.x(), digits), Rounded(v.y(), digits), Rounded(v.z(), digits)};
}

/// The same mechanism with every link drawn in a frame of its own, turned at random, so that no
/// figure is simple, and then with the figures of its anchors and start values rounded.
inline Mechanism DrawnWithDigits(Mechanism mechanism, int digits, unsigned seed) {
  Random random(seed);
  for (Link& link : mechanism.links) {
    const VectorXd wxyz = random.Vector(4).normalized();
    const Posed X(Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).toRotationMatrix(),
                  Vector3d::Zero());
    MassProperties& body = link.mass_properties;
    body.p_LoLcm = X * body.p_LoLcm;
    body.I_Lcm = X.R * body.I_Lcm * X.R.transpose();
    for (Anchor& anchor : link.anchors) {
      const Posed drawn = X * anchor.X_LA;
      anchor.X_LA = {AxesFromZX(Rounded(drawn.R.col(2), digits), Rounded(drawn.R.col(0), digits)),
                     Rounded(drawn.p, digits)};
    }
    if (&link == &mechanism.links[mechanism.ground]) {
      mechanism.gravity_W = X.R * mechanism.gravity_W;
    }
  }
  for (Joint& joint : mechanism.joints) {
    for (double& start : joint.start) start = Rounded(start, digits);
  }
  return mechanism;
}

/// Planar six-bars with revolute joints in a plane that is tilted against gravity. A crank on the
/// ground, a four-bar with it, and a dyad: on the coupler and the ground (Stephenson III), or on
/// the rocker and the coupler (Watt I).
inline Mechanism SixBar(bool watt) {
  const std::string dyad = watt ? R"(
  arm:    {mass: 0.4, center_of_gravity: [0.2, 0, 0], inertia: {xx: 0.001, yy: 0.006, zz: 0.006},
      anchors: {e: {origin: [0, 0, 0]}, f: {origin: [0.45, 0, 0]}}}
  link6:  {mass: 0.3, center_of_gravity: [0.2, 0.01, 0],
      inertia: {xx: 0.001, yy: 0.005, zz: 0.005}, anchors: {f: {origin: [0, 0, 0]},
      g: {origin: [0.4, 0, 0]}}}
)"
                                : R"(
  arm:    {mass: 0.4, center_of_gravity: [0.2, 0, 0], inertia: {xx: 0.001, yy: 0.006, zz: 0.006},
      anchors: {e: {origin: [0, 0, 0]}, f: {origin: [0.5, 0, 0]}}}
  link6:  {mass: 0.3, center_of_gravity: [0.2, 0.01, 0],
      inertia: {xx: 0.001, yy: 0.005, zz: 0.005}, anchors: {f: {origin: [0, 0, 0]},
      g: {origin: [0.45, 0, 0]}}}
)";
  const std::string text = R"(vmech: "1.0"
gravity: [0, -6, -7.7]
ground: frame
links:
  frame:  {anchors: {a: {origin: [0, 0, 0]}, d: {origin: [0.5, 0, 0]}, g: {origin: [0.9, 0.05, 0]}}}
  crank:  {mass: 0.5, center_of_gravity: [0.07, 0.01, 0.02],
      inertia: {xx: 0.001, yy: 0.002, zz: 0.002}, anchors: {a: {origin: [0, 0, 0]},
      b: {origin: [0.15, 0, 0]}}}
  coupler: {mass: 0.6, center_of_gravity: [0.2, 0.05, 0.03],
      inertia: {xx: 0.002, yy: 0.008, zz: 0.008}, anchors: {b: {origin: [0, 0, 0]},
      c: {origin: [0.45, 0, 0]}, e: {origin: [0.3, 0.2, 0]}}}
  rocker: {mass: 0.5, center_of_gravity: [0.15, 0, 0], inertia: {xx: 0.001, yy: 0.005, zz: 0.005},
      anchors: {d: {origin: [0, 0, 0]}, c: {origin: [0.35, 0, 0]}, g: {origin: [0.3, -0.2, 0]}}}
)" + dyad + R"(joints:
  a: {type: revolute, connects: [frame/a, crank/a], start: 1.1}
  b: {type: revolute, connects: [crank/b, coupler/b], start: -0.7}
  d: {type: revolute, connects: [frame/d, rocker/d], start: 1.7}
  c: {type: revolute, connects: [coupler/c, rocker/c]}
  e: {type: revolute, connects: [coupler/e, arm/e], start: -0.5}
  f: {type: revolute, connects: [arm/f, link6/f], start: -1.2}
  g: {type: revolute, connects: [link6/g, )" +
                           (watt ? std::string("rocker/g") : std::string("frame/g")) + "]}\n";
  return ParseMechanism(text, watt ? "watt" : "stephenson");
}

}  // namespace vmech
