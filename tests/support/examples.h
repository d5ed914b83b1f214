#pragma once

#include <random>
#include <string>
#include <vector>

#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech {

/// The shipped example mechanisms by file name, without ".yaml".
inline const std::vector<std::string>& ExampleNames() {
  static const std::vector<std::string> names{"crank",
                                              "two-link-arm",
                                              "slider-crank",
                                              "four-bar",
                                              "rssr",
                                              "rsup",
                                              "spherical-four-bar",
                                              "bennett",
                                              "bricard",
                                              "stewart-gough",
                                              "andrews-squeezer",
                                              "n-window-four-bar",
                                              "delta-robot",
                                              "square-four-bar",
                                              "marghitu-slider-crank",
                                              "modelica-four-bar",
                                              "modelica-engine1a",
                                              "door-on-two-hinges",
                                              "flyball-governor",
                                              "sundials-slider-crank",
                                              "dietmaier-platform",
                                              "manseur-doty"};
  return names;
}

inline Mechanism Example(const std::string& name) {
  return ReadMechanism(std::string(VMECH_EXAMPLES) + "/" + name + ".yaml");
}

/// "four-bar" as a word that a test's name may contain.
inline std::string TestName(const std::string& example) {
  std::string name;
  bool capital = true;
  for (char c : example) {
    if (c == '-') {
      capital = true;
      continue;
    }
    name += capital ? static_cast<char>(std::toupper(c)) : c;
    capital = false;
  }
  return name;
}

/// Random vectors from a local seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Between(double a, double b) {
    return a + (b - a) * std::uniform_real_distribution<double>()(engine_);
  }
  VectorXd Vector(int n, double size = 1) {
    VectorXd x(n);
    for (int i = 0; i < n; ++i) x[i] = Between(-size, size);
    return x;
  }

 private:
  std::mt19937 engine_;
};

/// A coordinate vector near the start values, whether the loops are closed or not.
inline VectorXd RandomCoordinates(const KinematicTree& tree, Random* random, double size = 0.3) {
  VectorXd q = StartCoordinates(tree);
  MoveCoordinates(tree, random->Vector(tree.nv, size), &q);
  return q;
}

}  // namespace vmech
