#pragma once

#include <complex>
#include <string>
#include <vector>

#include "vmech/dynamics/simulation/equilibrium.h"
#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// A small motion x(t) = Re(shape e^(lambda t)) about a pose.
struct Mode {
  std::complex<double>
      eigenvalue;            ///< lambda [1/s]; of a pair the one with positive imaginary part
  double frequency = 0;      ///< |Im lambda| / 2 pi [Hz]; 0 for one that does not oscillate
  double damping_ratio = 0;  ///< -Re lambda / |lambda|; negative where it grows
  Eigen::VectorXcd shape;    ///< [nv] of the tree; the largest entry, lengths over L, is 1
};

/// The linearised mechanism
///
///   (N'M N) x'' + D x' + K x = 0,
///
/// N the free motions, at a pose where it stands still. With gravity, springs, dampers, motors,
/// external loads and the hand's coupling; without dry friction.
struct Modes {
  KinematicTree tree;                        ///< of the assembled mechanism
  VectorXd q;                                ///< [nq]
  std::vector<Mode> modes;                   ///< by |eigenvalue|, slowest first
  Stability stability = Stability::kStable;  ///< by the eigenvalues
  double residual = 0;  ///< largest force along a free motion [N], [N m]; 0 at an equilibrium
  MatrixXd mass, damping, stiffness;  ///< [freedoms, freedoms] N'M N, D, K
  MatrixXd free_motions;              ///< N [nv, freedoms]
  std::vector<std::string> freedoms;  ///< the velocity that each column of N moves at unit rate
  std::vector<std::string> warnings;  ///< such as: this is no equilibrium
};

/// About the simulation's start, or about its equilibrium if that is its start.
/// @throws as Simulate; std::runtime_error where no equilibrium is found.
Modes FindModes(const Simulation& simulation);

}  // namespace vmech
