#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// All figures of a mechanism in SI, in a fixed order: what two descriptions must share.
inline std::vector<double> Figures(const Mechanism& mechanism) {
  std::vector<double> figures;
  const auto add = [&](const auto& values) {
    for (const double value : values) figures.push_back(value);
  };
  const auto add_pose = [&](const Posed& X) {
    add(X.p);
    add(X.R.reshaped());
  };
  add(mechanism.gravity_W);
  for (const Link& link : mechanism.links) {
    add(Vector3d::Constant(link.mass_properties.mass));
    add(link.mass_properties.p_LoLcm);
    add(link.mass_properties.I_Lcm.reshaped());
    for (const Anchor& anchor : link.anchors) add_pose(anchor.X_LA);
  }
  for (const Joint& joint : mechanism.joints) {
    for (const auto* list : {&joint.start, &joint.lower, &joint.upper}) add(*list);
    for (const Passive& p : joint.passive) {
      add(std::vector{p.stiffness, p.rest, p.viscous, p.coulomb});
    }
    const LoadFriction& friction = joint.load_friction;
    add(std::vector{joint.pitch, friction.coefficient, friction.radius, friction.thrust_radius,
                    friction.length, friction.width});
    if (joint.stiffness) add(*joint.stiffness);
  }
  for (const Grasp& grasp : mechanism.grasps) add_pose(grasp.X_LG);
  return figures;
}

/// Everything else: names, types, and which anchors meet.
inline std::vector<std::string> Words(const Mechanism& mechanism) {
  std::vector<std::string> words{mechanism.name, mechanism.links[mechanism.ground].name};
  for (const Link& link : mechanism.links) {
    words.push_back(link.name);
    for (const Anchor& anchor : link.anchors) words.push_back(link.name + "/" + anchor.name);
  }
  for (const Joint& joint : mechanism.joints) {
    words.push_back(joint.name + " " + std::string(NameOf(joint.type)));
    for (const AnchorId id : {joint.first, joint.second}) {
      words.push_back(mechanism.links[id.link].name + "/" + mechanism.anchor(id).name);
    }
    words.push_back(joint.stiffness ? "stiff" : "no stiffness");
  }
  for (const Grasp& grasp : mechanism.grasps) {
    words.push_back(grasp.name + " on " + mechanism.links[grasp.link].name);
    words.push_back(grasp.kind == GraspKind::kPoint ? "point" : "rigid");
  }
  for (const int cut : mechanism.preferred_cuts) words.push_back(mechanism.joints[cut].name);
  return words;
}

/// `relative` is the largest difference of two figures, of their size; 0 asks for the same bits.
inline void ExpectSame(const Mechanism& a, const Mechanism& b, double relative) {
  EXPECT_EQ(Words(a), Words(b));
  const std::vector<double> of_a = Figures(a), of_b = Figures(b);
  ASSERT_EQ(of_a.size(), of_b.size());
  for (size_t i = 0; i < of_a.size(); ++i) {
    if (of_a[i] == of_b[i]) continue;  // infinities too
    EXPECT_NEAR(of_a[i], of_b[i], relative * std::abs(of_a[i])) << "figure " << i;
  }
}

}  // namespace vmech
