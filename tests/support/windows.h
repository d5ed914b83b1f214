#pragma once

#include <string>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The N-window four-bar linkage, benchmark A02 of the IFToMM library of multibody problems.

inline std::string Numbered(std::string name, int i) {
  name += std::to_string(i);
  return name;
}

inline Link UprightBar(const std::string& name, double x) {
  return {
      name,
      {1, {x, 0.5, 0}, Vector3d(1. / 12, 1e-3, 1. / 12).asDiagonal()},
      {{"foot", {Matrix3d::Identity(), {x, 0, 0}}}, {"head", {Matrix3d::Identity(), {x, 1, 0}}}}};
}

inline Link LevelBar(const std::string& name, double x) {
  return {name,
          {1, {x + 0.5, 1, 0}, Vector3d(1e-3, 1. / 12, 1. / 12).asDiagonal()},
          {{"left", {Matrix3d::Identity(), {x, 1, 0}}},
           {"right", {Matrix3d::Identity(), {x + 1, 1, 0}}}}};
}

/// Links: frame, then the posts 0..N, then the beams 1..N; posts lean by `lean` from the upright.
inline Mechanism Windows(int count, double lean) {
  Mechanism m;
  m.name = "windows";
  m.gravity_W = {0, -9.81, 0};
  m.links.push_back({"frame", {}, {}});
  for (int i = 0; i <= count; ++i) {
    m.links[0].anchors.push_back({Numbered("a", i), {Matrix3d::Identity(), {1. * i, 0, 0}}});
    m.links.push_back(UprightBar(Numbered("post", i), i));
  }
  for (int i = 0; i < count; ++i) m.links.push_back(LevelBar(Numbered("beam", i + 1), i));
  const auto hinge = [&](const std::string& name, AnchorId first, AnchorId second, double angle) {
    m.joints.push_back(MakeJoint(name, JointType::kRevolute, first, second));
    m.joints.back().start = {angle};
  };
  for (int i = 0; i <= count; ++i) hinge(Numbered("a", i), {0, i}, {1 + i, 0}, lean);
  for (int i = 0; i < count; ++i) {
    const int beam = count + 2 + i;
    hinge(Numbered("right", i), {1 + i, 1}, {beam, 0}, -lean);
    hinge(Numbered("left", i), {beam, 1}, {2 + i, 1}, lean);
  }
  return m;
}

}  // namespace vmech
