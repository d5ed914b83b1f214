#include "vmech/base/linear_algebra/envelope_ldlt.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {

template <typename T>
EnvelopeLdlt<T>::EnvelopeLdlt(std::vector<int> first) : first_(std::move(first)) {
  int total = 0;
  for (int i = 0; i < size(); ++i) {
    row_.push_back(total - first_[i]);
    total += i - first_[i] + 1;
  }
  values_.assign(total, T(0));
  inverse_pivot_.assign(first_.size(), T(0));
  products_.assign(first_.size(), T(0));
}

template <typename T>
void EnvelopeLdlt<T>::SetZero() {
  std::fill(values_.begin(), values_.end(), T(0));
}

template <typename T>
void EnvelopeLdlt<T>::Factor() {
  using std::abs;
  using std::min;
  smallest_pivot_ = T(1);
  const int n = size();
  T* const values = values_.data();
  for (int i = 0; i < n; ++i) {
    const int first = first_[i];
    T* const row_i = values + row_[i];
    T pivot = row_i[i];
    T size = abs(Constant(pivot));
    // products_[j] = L(i,j) D(j) is what is left of A(i,j) after the columns before j.
    for (int j = first; j < i; ++j) {
      const T* const row_j = values + row_[j];
      T sum = row_i[j];
      for (int k = std::max(first, first_[j]); k < j; ++k) sum -= products_[k] * row_j[k];
      const T scaled = sum * inverse_pivot_[j];
      const T taken = sum * scaled;
      pivot -= taken;
      size += abs(Constant(taken));
      products_[j] = sum;
      row_i[j] = scaled;
    }
    row_i[i] = pivot;
    const T left = abs(Constant(pivot));
    const auto counts = left > kSingular * size;
    inverse_pivot_[i] = Select(counts, 1.0 / pivot, T(0));
    smallest_pivot_ = min(smallest_pivot_, Select(counts, left / size, T(0)));
  }
}

template <typename T>
void EnvelopeLdlt<T>::Solve(T* x) const {
  const int n = size();
  const T* const values = values_.data();
  for (int i = 0; i < n; ++i) {
    const T* const row = values + row_[i];
    T sum = x[i];
    for (int j = first_[i]; j < i; ++j) sum -= row[j] * x[j];
    x[i] = sum;
  }
  for (int i = 0; i < n; ++i) x[i] *= inverse_pivot_[i];
  for (int i = n - 1; i > 0; --i) {
    const T* const row = values + row_[i];
    const T solved = x[i];
    for (int j = first_[i]; j < i; ++j) x[j] -= row[j] * solved;
  }
}

template <typename T>
void EnvelopeLdlt<T>::MotionOfPivot(int i, T* z) const {
  std::fill(z, z + size(), T(0));
  z[i] = T(1);
  for (int k = i; k > 0; --k) {
    const T* const row = values_.data() + row_[k];
    for (int j = first_[k]; j < k; ++j) z[j] -= row[j] * z[k];
  }
}

template class EnvelopeLdlt<double>;
template class EnvelopeLdlt<Dual>;
template class EnvelopeLdlt<Taped4>;
template class EnvelopeLdlt<Lanes4>;

}  // namespace vmech
