#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace vmech {

inline void RequireSundials(bool ok) {
  if (!ok) throw std::runtime_error("SUNDIALS could not set up its objects");
}

/// A context of SUNDIALS, and vectors in it.
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
