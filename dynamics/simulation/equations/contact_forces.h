#pragma once

#include <vector>

#include "vmech/base/eigen.h"
#include "vmech/base/pose.h"

namespace vmech {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rates that something holds, and what it can exert on them.
struct HeldContact {
  /// What a contact can exert.
  enum class Kind {
    kGiven,     ///< whatever it takes
    kFriction,  ///< sum (F_i / limits_i)^2 <= 1
    kStop,      ///< side F <= 0
  };
  Kind kind = Kind::kGiven;            ///< decides which of the following count
  int first = 0, count = 1;            ///< rows
  Vector3d limits = Vector3d::Zero();  ///< kFriction [N], [N m]
  int side = 0;                        ///< kStop: -1 at a lower limit, 1 at an upper one
};

/// Forces F along held rates, and what is left of the slopes of these, u = b + W F.
struct ContactForces {
  VectorXd F, u;  ///< [held] [N, N m]; [held] [m/s^2, rad/s^2]
};

/// The forces that hold as much as they can: u of given rows is zero; of friction it is zero, or
/// all friction opposes it, F_i = -f_i^2 u_i / |f u|; a stop is left, side u < 0, or pressed, side
/// F < 0. It is the dual of
///
///   minimise 1/2 s''A s' - r's' + sum |f_c (B_c s' - beta_c)|,   W = B A^-1 B',
///   b = B A^-1 r - beta,                                          side (B_n s' - beta_n) <= 0,
///
/// whose u is unique, however many contacts share in holding a freedom. By projected Gauss-Seidel
/// from `start` [rows].
ContactForces SolveContacts(const MatrixXd& W, const VectorXd& b,
                            const std::vector<HeldContact>& contacts, const VectorXd& start);

}  // namespace vmech
