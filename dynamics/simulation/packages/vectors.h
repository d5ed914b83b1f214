#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "vmech/base/eigen.h"

namespace vmech {

inline void RequireSundials(bool ok) {
  if (!ok) throw std::runtime_error("SUNDIALS could not set up its objects");
}

inline Eigen::Map<VectorXd> Numbers(N_Vector v) {
  return {NV_DATA_S(v), NV_LENGTH_S(v)};
}
inline void LinearSum(double a, N_Vector x, double b, N_Vector y, N_Vector sum) {
  Numbers(sum) = a * Numbers(x) + b * Numbers(y);
}
inline double WeightedRootMeanSquare(N_Vector x, N_Vector weights) {
  const auto size = static_cast<double>(NV_LENGTH_S(x));
  return std::sqrt(Numbers(x).cwiseProduct(Numbers(weights)).squaredNorm() / size);
}

/// A context of SUNDIALS, and vectors in it. What integrators do with vectors most often, which are
/// short, is done by Eigen: the loops of SUNDIALS take as long as the accelerations of a mechanism.
class SundialsVectors {
 public:
  explicit SundialsVectors(int size) : size_(size) {
    RequireSundials(SUNContext_Create(nullptr, &context_) == 0);
  }
  ~SundialsVectors() {
    for (N_Vector v : vectors_) N_VDestroy(v);
    if (context_) SUNContext_Free(&context_);
  }
  SundialsVectors(const SundialsVectors&) = delete;
  SundialsVectors& operator=(const SundialsVectors&) = delete;

  SUNContext context() const { return context_; }
  N_Vector New() {
    N_Vector v = N_VNew_Serial(size_, context_);
    RequireSundials(v != nullptr);
    v->ops->nvlinearsum = LinearSum;  // clones have it from there
    v->ops->nvwrmsnorm = WeightedRootMeanSquare;
    vectors_.push_back(v);
    std::fill_n(N_VGetArrayPointer(v), size_, 0.0);
    return v;
  }
  void Copy(const double* from, N_Vector to) const {
    std::copy(from, from + size_, N_VGetArrayPointer(to));
  }

 private:
  int size_;
  SUNContext context_ = nullptr;
  std::vector<N_Vector> vectors_;
};

}  // namespace vmech
