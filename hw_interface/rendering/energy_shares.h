#pragma once

#include <span>
#include <vector>

namespace vmech {

/// Whose is the energy S of a mechanism that several hands hold? The passivity of each hand is
/// judged by what it alone has stored there,
///
///   dS_i = dP_i - g_i (sum dP_j - dS),   sum S_i = S,
///
/// P_i the energy of its coupling's spring and the work that its coupling has done on the
/// mechanism, g_i its share of what the mechanism lost in between, sum g_i = 1. Of one hand S_1 is
/// S.
class EnergyShares {
 public:
  /// `hands`: how many, at least 1.
  explicit EnergyShares(int hands)
      : paid_(static_cast<size_t>(hands)), shares_(static_cast<size_t>(hands)) {}

  /// After a step. `total`: S [J]. `paid`: P_i [J]. `weights`: g_i in proportion; all zero: the
  /// first hand's is whatever is lost.
  void Update(double total, std::span<const double> paid,
              std::span<const double> weights) noexcept {
    double weight = 0, lost = total_ - total;
    for (size_t i = 0; i < paid.size(); ++i) {
      weight += weights[i];
      lost += paid[i] - paid_[i];
    }
    shares_[0] = total_ = total;
    for (size_t i = 0; i < paid.size(); ++i) {
      if (i > 0) {
        shares_[i] += paid[i] - paid_[i];
        if (weight > 0) shares_[i] -= weights[i] / weight * lost;
        shares_[0] -= shares_[i];
      }
      paid_[i] = paid[i];
    }
  }
  /// Nothing is anybody's but the first hand's.
  void Reset(double total) noexcept {
    for (size_t i = 0; i < paid_.size(); ++i) paid_[i] = shares_[i] = 0;
    shares_[0] = total_ = total;
  }

  double operator[](int hand) const noexcept { return shares_[hand]; }  ///< S_i [J]

 private:
  std::vector<double> paid_, shares_;
  double total_ = 0;
};

}  // namespace vmech
