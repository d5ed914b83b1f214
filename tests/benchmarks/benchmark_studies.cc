#include "benchmark_studies.h"

#include <string>
#include <utility>

#include "vmech/mechanisms/files/reader.h"

namespace vmech {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLower = 0, kUpper = 1;  // anchors of a post
constexpr int kLeft = 0, kRight = 1;   // anchors of a beam

// A bar of 1 m from the origin along x or y, with a section of 0.1 m.
Link Bar(std::string name, const Vector3d& end) {
  Link link;
  link.name = std::move(name);
  const Matrix3d along = end * end.transpose();
  const double slender = 1.0 / 12 + 0.01 / 12, round = 0.01 / 6;
  link.mass_properties.mass = 1;
  link.mass_properties.p_LoLcm = end / 2;
  link.mass_properties.I_Lcm = slender * (Matrix3d::Identity() - along) + round * along;
  link.anchors = {{"start", {}}, {"end", {Matrix3d::Identity(), end}}};
  return link;
}

// Upright when all joints are at zero; joint 0 is the pivot of the first post.
Mechanism WindowFourBar(int windows) {
  Mechanism mechanism;
  mechanism.name = "window-four-bar";
  mechanism.gravity_W = {0, -9.81, 0};
  mechanism.links.push_back({"frame", {}, {}});
  const auto joint = [&](std::string name, AnchorId first, AnchorId second) {
    mechanism.joints.push_back(MakeJoint(std::move(name), JointType::kRevolute, first, second));
  };
  for (int i = 0; i <= windows; ++i) {
    const std::string number = std::to_string(i);
    mechanism.links[0].anchors.push_back({"a" + number, {Matrix3d::Identity(), Vector3d(i, 0, 0)}});
    const int post = static_cast<int>(mechanism.links.size());
    mechanism.links.push_back(Bar("post" + number, Vector3d::UnitY()));
    joint("a" + number, {0, i}, {post, kLower});
    if (i == 0) continue;
    const int beam = post + 1, previous_post = i == 1 ? 1 : post - 2;
    mechanism.links.push_back(Bar("beam" + number, Vector3d::UnitX()));
    joint("left" + number, {previous_post, kUpper}, {beam, kLeft});
    joint("right" + number, {beam, kRight}, {post, kUpper});
  }
  return mechanism;
}

}  // namespace

LoadStudy SliderCrankStudy(int poses) {
  constexpr double kSpeed = 50 * kPi, kTurn = 0.04;  // [rad/s], time of a turn [s]
  LoadStudy study;
  study.mechanism = ReadMechanism(VMECH_EXAMPLES "/slider-crank.yaml");
  const int main = FindJoint(study.mechanism, "main");
  const double start = study.mechanism.joints[main].start[0];
  study.drives = {{main, 0, MotionLaw::Uniform(start, kSpeed)}};
  for (int i = 0; i < poses; ++i) study.times.push_back(2 * kTurn * i / poses);
  study.rule = ReactionRule::kStiffness;
  return study;
}

LoadStudy WindowStudy(int windows, int poses) {
  constexpr double kSwing = 0.8;  // [s] at 1 rad/s
  LoadStudy study;
  study.mechanism = WindowFourBar(windows);
  study.drives = {{0, 0, MotionLaw::Uniform(0, 1)}};
  for (int i = 0; i < poses; ++i) study.times.push_back(kSwing * i / poses);
  study.rule = ReactionRule::kStiffness;
  return study;
}

}  // namespace vmech
