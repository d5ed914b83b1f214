#pragma once

#include <array>
#include <vector>

#include "vmech/hw_interface/arm/arm_model.h"

namespace vmech {

/// The motions of an arm's joints that leave its handle at rest: a basis of the null space of
/// J. No allocation.
class HandleNullSpace {
 public:
  explicit HandleNullSpace(int joints) : joints_(joints) {}  ///< at most kMaxArmJoints

  /// From the columns S of J about Do [joints]. Writes how the joints move, and returns the number
  /// of motions.
  int Find(const std::vector<Screw>& S, std::array<JointArray, kMaxArmJoints>* motions) noexcept;

 private:
  bool FindByBlocks(const std::vector<Screw>& S,
                    std::array<JointArray, kMaxArmJoints>* motions) const noexcept;
  void Eliminate(const std::vector<Screw>& S) noexcept;
  void BringLargestForward(int row) noexcept;

  int joints_;
  int rank_ = 0;
  std::array<int, kMaxArmJoints> joint_{};  // in the order of elimination; those of pivots first
  std::array<int, 6> pivot_row_{};
  Eigen::Matrix<double, 6, kMaxArmJoints> reduced_;  // J, as Eliminate leaves it
};

}  // namespace vmech
