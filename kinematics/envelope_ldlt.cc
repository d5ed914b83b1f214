#include "vmech/kinematics/envelope_ldlt.h"

#include <algorithm>
#include <cmath>

namespace vmech {

EnvelopeLdlt::EnvelopeLdlt(std::vector<int> first) : first_(std::move(first)) {
  int total = 0;
  for (int i = 0; i < size(); ++i) {
    start_.push_back(total);
    total += i - first_[i] + 1;
  }
  values_.assign(total, 0.0);
  inverse_pivot_.assign(first_.size(), 0.0);
}

void EnvelopeLdlt::SetZero() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

void EnvelopeLdlt::Factor() {
  zero_pivots_ = 0;
  smallest_pivot_ = 1;
  for (int i = 0; i < size(); ++i) {
    double* row_i = values_.data() + start_[i] - first_[i];
    // row_i[j] becomes L(i,j) D(j): what is left of A(i,j) after the columns before j.
    for (int j = first_[i]; j < i; ++j) {
      const double* row_j = values_.data() + start_[j] - first_[j];
      double sum = row_i[j];
      for (int k = std::max(first_[i], first_[j]); k < j; ++k) sum -= row_i[k] * row_j[k];
      row_i[j] = sum;
    }
    double pivot = row_i[i];
    double size = std::abs(pivot);
    for (int j = first_[i]; j < i; ++j) {
      const double scaled = row_i[j] * inverse_pivot_[j];
      const double taken = row_i[j] * scaled;
      pivot -= taken;
      size += std::abs(taken);
      row_i[j] = scaled;
    }
    row_i[i] = pivot;
    const bool is_zero = !(std::abs(pivot) > kSingular * size);
    inverse_pivot_[i] = is_zero ? 0 : 1 / pivot;
    zero_pivots_ += is_zero;
    smallest_pivot_ = std::min(smallest_pivot_, is_zero ? 0 : std::abs(pivot) / size);
  }
}

void EnvelopeLdlt::Solve(double* x) const {
  for (int i = 0; i < size(); ++i) {
    const double* row = values_.data() + start_[i] - first_[i];
    double sum = x[i];
    for (int j = first_[i]; j < i; ++j) sum -= row[j] * x[j];
    x[i] = sum;
  }
  for (int i = 0; i < size(); ++i) x[i] *= inverse_pivot_[i];
  for (int i = size() - 1; i >= 0; --i) {
    const double* row = values_.data() + start_[i] - first_[i];
    for (int j = first_[i]; j < i; ++j) x[j] -= row[j] * x[i];
  }
}

}  // namespace vmech
