#pragma once

#include <span>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// The mechanism with every joint cut: six equations of equilibrium for each moving link, and every
/// component that a joint holds an unknown (maximal coordinates). Written from Newton's and Euler's
/// laws and the poses of the links alone, so that it shares nothing with the code under test.

using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A joint between two posed links; six-vectors [linear; angular] at M in axes of F.
struct FreeJoint {
  Matrix3d R_WF, R_FM;
  Vector3d p_WF, p_WM;
  Matrix6Xd freedoms;  ///< unit twists of M in F
  Matrix6Xd held;      ///< orthonormal wrenches that do no work on them
};
FreeJoint CutFree(const Mechanism& mechanism, std::span<const LinkMotion> links, int joint);

/// Twist of M in F, axes of F, from the motions of the two links.
Vector6d RelativeTwist(const Mechanism& mechanism, std::span<const LinkMotion> links, int joint);

Vector3d CentreOfGravity(const Link& link, const LinkMotion& motion);
/// What must act on a link about its centre of gravity, besides its weight, for it to move so.
Wrenchd NeededWrench(const Mechanism& mechanism, const Link& link, const LinkMotion& motion);
/// A constant load of the study about a point, world axes.
Wrenchd LoadAbout(const ExternalLoad& load, const LinkMotion& motion, const Vector3d& p_W);

/// Per link, what its joints must exert on it about its centre of gravity.
std::vector<Wrenchd> NeededOfJoints(const LoadStudy& study, const PoseLoads& pose);

/// A x = b: unknowns are the held components of all joints in turn, each with its driven freedoms
/// behind; b is what the moving links need, six rows each.
struct EquilibriumProblem {
  MatrixXd A;
  VectorXd b;
  std::vector<FreeJoint> joints;
  std::vector<MatrixXd> on_links;   ///< per joint: what its wrench does to the links [rows, 6]
  std::vector<Matrix6Xd> wrenches;  ///< per joint: one column for each of its unknowns, axes of F
  std::vector<Matrix6Xd> driven;    ///< per joint: the columns that are drives
  std::vector<int> first_column;    ///< per joint
};
EquilibriumProblem FormEquilibrium(const LoadStudy& study, const PoseLoads& pose);

/// The joint wrenches of a solution.
std::vector<Wrenchd> JointWrenches(const EquilibriumProblem& problem, const VectorXd& x);

}  // namespace vmech
