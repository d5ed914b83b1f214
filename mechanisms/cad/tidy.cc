#include "vmech/mechanisms/cad/tidy.h"

#include <cmath>
#include <numbers>

namespace vmech {
namespace {

constexpr double kRelative = 1e-12;    // of axes and inertias
constexpr double kLengthStep = 1e-12;  // [m]
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStepsPerDegree = 1e9;

double Rounded(double value, double step) {
  // Division by a whole number, so that 0.15 m comes out as the double nearest to it.
  const double steps_per_unit = std::round(1 / step);
  return std::round(value * steps_per_unit) / steps_per_unit + 0.0;
}

double RoundedAngle(double value) {
  return std::round(value / kDegree * kStepsPerDegree) / kStepsPerDegree * kDegree + 0.0;
}

void TidyLengths(Vector3d* v) {
  for (double& length : *v) length = Rounded(length, kLengthStep);
}

void TidyAxes(Matrix3d* R) {
  for (double& cosine : R->reshaped()) {
    if (std::abs(cosine) < kRelative) cosine = 0;
    if (std::abs(cosine) > 1 - kRelative) cosine = std::copysign(1, cosine);
  }
}

void TidyPose(Posed* X) {
  TidyLengths(&X->p);
  TidyAxes(&X->R);
}

void TidyStart(Joint* joint) {
  if (joint->type == JointType::kSpherical) return;
  for (size_t i = 0; i < joint->start.size(); ++i) {
    const bool is_length = joint->type == JointType::kPrismatic ||
                           (joint->type == JointType::kCylindrical && i == 0) ||
                           (joint->type == JointType::kPlanar && i < 2);
    double& value = joint->start[i];
    value = is_length ? Rounded(value, kLengthStep) : RoundedAngle(value);
  }
}

}  // namespace

void Tidy(Mechanism* mechanism) {
  for (Link& link : mechanism->links) {
    MassProperties& mass = link.mass_properties;
    TidyLengths(&mass.p_LoLcm);
    const double largest = mass.I_Lcm.cwiseAbs().maxCoeff();
    mass.I_Lcm = (mass.I_Lcm.array().abs() < kRelative * largest).select(0, mass.I_Lcm);
    for (Anchor& anchor : link.anchors) TidyPose(&anchor.X_LA);
  }
  for (Joint& joint : mechanism->joints) TidyStart(&joint);
  for (Grasp& grasp : mechanism->grasps) TidyPose(&grasp.X_LG);
}

}  // namespace vmech
