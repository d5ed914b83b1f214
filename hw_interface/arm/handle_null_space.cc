#include "vmech/hw_interface/arm/handle_null_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

/// a = A x for a with the columns A: x = (row[0] a, row[1] a, row[2] a)/det.
struct InverseOfColumns {
  InverseOfColumns(const Double4& a0, const Double4& a1, const Double4& a2)
      : rows{Cross(a1, a2), Cross(a2, a0), Cross(a0, a1)}, scale(1 / Dot(rows.x, a0)) {}
  Double4 operator*(const Double4& a) const { return scale * InverseRotate(rows, a); }

  Frame rows;
  double scale;
};

/// s_0 a_0 + s_1 a_1 + s_2 a_2.
Double4 Combined(const Double4& s, const Double4& a0, const Double4& a1, const Double4& a2) {
  return s[0] * a0 + s[1] * a1 + s[2] * a2;
}

}  // namespace

int HandleNullSpace::Find(const std::vector<Screw>& S,
                          std::array<JointArray, kMaxArmJoints>* motions) noexcept {
  // The pivots of the last posture mostly do.
  if (rank_ == 6 && FindByBlocks(S, motions)) return joints_ - 6;
  Eliminate(S);
  for (int k = 0; k < joints_ - rank_; ++k) {
    JointArray& motion = (*motions)[k];
    for (int i = rank_; i < joints_; ++i) motion[joint_[i]] = i == rank_ + k ? 1 : 0;
    for (int i = 0; i < rank_; ++i) motion[joint_[i]] = -reduced_(pivot_row_[i], rank_ + k);
  }
  return joints_ - rank_;
}

/// With the linear velocities of the first three joints for one pivot, and what is left of the
/// angular ones of the next three for another. False if that is ill conditioned.
bool HandleNullSpace::FindByBlocks(const std::vector<Screw>& S,
                                   std::array<JointArray, kMaxArmJoints>* motions) const noexcept {
  constexpr double kMostGrowth = 8;
  const auto column = [&](int k) -> const Screw& { return S[joint_[k]]; };
  const Screw &a0 = column(0), &a1 = column(1), &a2 = column(2);
  const InverseOfColumns first(a0.linear, a1.linear, a2.linear);
  const auto first_shares = [&](int k) { return first * column(k).linear; };
  const auto angular_left = [&](int k, const Double4& s) {
    return column(k).angular - Combined(s, a0.angular, a1.angular, a2.angular);
  };
  const Double4 s3 = first_shares(3), s4 = first_shares(4), s5 = first_shares(5);
  const InverseOfColumns second(angular_left(3, s3), angular_left(4, s4), angular_left(5, s5));
  Double4 growth = s3 * s3 + s4 * s4 + s5 * s5;
  for (int k = 6; k < joints_; ++k) {
    const Double4 s = first_shares(k), t = second * angular_left(k, s);
    const Double4 r = s - Combined(t, s3, s4, s5);
    growth += r * r + t * t;
    JointArray& motion = (*motions)[k - 6];
    for (int i = 6; i < joints_; ++i) motion[joint_[i]] = i == k ? 1 : 0;
    for (int i = 0; i < 3; ++i) {
      motion[joint_[i]] = -r[i];
      motion[joint_[3 + i]] = -t[i];
    }
  }
  return growth[0] + growth[1] + growth[2] < kMostGrowth * kMostGrowth;
}

/// Gauss-Jordan elimination of J, row by row with the largest entry for a pivot. Leaves each
/// column's shares of the pivots' in the pivots' rows.
void HandleNullSpace::Eliminate(const std::vector<Screw>& S) noexcept {
  constexpr double kSingular = 1e-9;  // pivot over the norm of J: the handle cannot go that way
  std::iota(joint_.begin(), joint_.end(), 0);
  for (int j = 0; j < joints_; ++j) reduced_.col(j) = Vector6Of(S[j]);
  const double singular = kSingular * reduced_.leftCols(joints_).norm();
  rank_ = 0;
  for (int row = 0; row < 6 && rank_ < joints_; ++row) {
    BringLargestForward(row);
    const Vector6d pivot = reduced_.col(rank_);
    if (!(std::abs(pivot[row]) > singular)) continue;
    for (int j = rank_ + 1; j < joints_; ++j) {
      const double share = reduced_(row, j) / pivot[row];
      reduced_.col(j) -= share * pivot;
      reduced_(row, j) = share;
    }
    pivot_row_[rank_++] = row;
  }
}

/// Of the columns that are no pivots yet.
void HandleNullSpace::BringLargestForward(int row) noexcept {
  Eigen::Index largest = 0;
  reduced_.row(row).segment(rank_, joints_ - rank_).cwiseAbs().maxCoeff(&largest);
  std::swap(joint_[rank_], joint_[rank_ + largest]);
  reduced_.col(rank_).swap(reduced_.col(rank_ + largest));
}

}  // namespace vmech
