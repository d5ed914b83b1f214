#include "driven_examples.h"

#include <algorithm>
#include <stdexcept>

namespace vmech {
namespace {

constexpr int kPoses = 25;
constexpr double kDuration = 0.5;  // [s]

}  // namespace

const std::vector<DrivenExample>& DrivenExamples() {
  static const std::vector<DrivenExample> examples{
      {"crank", {{"main", 6}}, "crank"},
      {"two-link-arm", {{"shoulder", 2}, {"elbow", -3}}, "forearm"},
      {"slider-crank", {{"main", 6}}, "coupler"},
      {"four-bar", {{"main", 6}}, "coupler"},
      {"rssr", {{"input", 1}}, "rocker"},
      {"rsup", {{"main", 6}}, "rod"},
      {"spherical-four-bar", {{"input", 1}}, "coupler"},
      {"bennett", {{"input", 1.5}}, "coupler"},
      {"bricard", {{"p0", -0.6}}, "bar3"},
      {"stewart-gough",
       {{"leg1", 0.03},
        {"leg2", -0.02},
        {"leg3", 0.01},
        {"leg4", 0.04},
        {"leg5", -0.03},
        {"leg6", 0.02}},
       "platform"},
      {"andrews-squeezer", {{"main", 1}}, "k7"},
      {"n-window-four-bar", {{"a0", 0.7}}, "beam2"},
      {"delta-robot", {{"motor1", 0.3}, {"motor2", -0.2}, {"motor3", 0.25}}, "platform"},
      {"square-four-bar", {{"a", 0.8}}, "top"},
      {"marghitu-slider-crank", {{"main", 0.5}}, "rod"},
      {"modelica-four-bar", {{"revolute1", 0.5}}, "body2"},
      {"modelica-engine1a", {{"main", 6}}, "rod"},
      {"door-on-two-hinges", {{"lower", 1.5}}, "door"},
      {"flyball-governor",
       {{"spin", 6}, {"slide", 0.05}, {"right_hinge", 0.2}, {"left_hinge", -0.15}},
       "right_rod"},
      {"sundials-slider-crank", {{"main", 1}}, "rod"},
      {"dietmaier-platform",
       {{"leg1", 0.01},
        {"leg2", -0.01},
        {"leg3", 0.01},
        {"leg4", 0.02},
        {"leg5", -0.01},
        {"leg6", 0.01}},
       "platform"},
      {"manseur-doty",
       {{"joint1", 1},
        {"joint2", -0.5},
        {"joint3", 0.7},
        {"joint4", 0.6},
        {"joint5", -0.8},
        {"joint6", 1}},
       "link6"}};
  return examples;
}

const DrivenExample& FindDrivenExample(const std::string& name) {
  for (const DrivenExample& example : DrivenExamples()) {
    if (example.name == name) return example;
  }
  throw std::invalid_argument("no drives are listed for " + name);
}

LoadStudy StudyOf(const Mechanism& mechanism, const DrivenExample& example) {
  LoadStudy study;
  study.mechanism = mechanism;
  for (const DrivenExample::Drive& drive : example.drives) {
    const int joint = FindJoint(mechanism, drive.joint);
    study.drives.push_back({joint, 0,
                            MotionLaw::Uniform(mechanism.joints.at(joint).start[0],
                                               1.2 * drive.span, 1.6 * drive.span)});
  }
  for (int i = 0; i < kPoses; ++i) study.times.push_back(kDuration * i / (kPoses - 1));
  ExternalLoad load;
  load.link = FindLink(mechanism, example.loaded_link);
  load.p_L = CharacteristicLength(mechanism) * Vector3d(0.3, -0.2, 0.1);
  load.at = {0};
  load.wrenches = {{Vector3d(3, -7, 5), Vector3d(0.4, 0.9, -0.7)}};
  study.external = {load};
  return study;
}

LoadStudy StudyOf(const std::string& example) {
  return StudyOf(Example(example), FindDrivenExample(example));
}

LoadScale ScaleOf(const Mechanism& mechanism, const PoseLoads& pose) {
  LoadScale scale{0, 0};
  for (const Wrenchd& W : pose.joints) {
    scale.force = std::max(scale.force, W.force.norm());
    scale.moment = std::max(scale.moment, W.moment.norm());
  }
  scale.moment = std::max(scale.moment, CharacteristicLength(mechanism) * scale.force);
  return scale;
}

double RelativeDifference(const Mechanism& mechanism, const PoseLoads& a, const PoseLoads& b) {
  return RelativeDifference(mechanism, a, std::vector<Wrenchd>(b.joints.begin(), b.joints.end()));
}

double RelativeDifference(const Mechanism& mechanism, const PoseLoads& a,
                          const std::vector<Wrenchd>& b) {
  const LoadScale scale = ScaleOf(mechanism, a);
  double largest = 0;
  for (size_t j = 0; j < a.joints.size(); ++j) {
    const Wrenchd difference = a.joints[j] - b[j];
    largest = std::max(
        {largest, difference.force.norm() / scale.force, difference.moment.norm() / scale.moment});
  }
  return largest;
}

double RelativeDifference(const Mechanism& mechanism, const LoadStudyResult& a,
                          const LoadStudyResult& b) {
  double largest = 0;
  for (size_t i = 0; i < a.poses.size(); ++i) {
    largest = std::max(largest, RelativeDifference(mechanism, a.poses[i], b.poses[i]));
  }
  return largest;
}

}  // namespace vmech
