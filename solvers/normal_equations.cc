#include "vmech/solvers/normal_equations.h"

#include <algorithm>

#include "vmech/base/linear_algebra/small_ldlt.h"

namespace vmech {
namespace {

// The rows of residuals and constraints as constants too, where they are those of a rigid grasp and
// of one loop with a pin.
template <int kSize, int kRows, int kClosures>
void FormKernel(const Linearization& at_x, double weight, const double* forces,
                NormalEquations* equations) noexcept {
  const int n = kSize > 0 ? kSize : equations->size();
  const int rows = kRows > 0 ? kRows : static_cast<int>(at_x.r.size());
  const int closures = kClosures > 0 ? kClosures : static_cast<int>(at_x.c.size());
  const double *J_j = at_x.J.data(), *C_j = at_x.C.data();
  const double* const r = at_x.r.data();
  double* H_j = equations->H.data();
  for (int j = 0; j < n; ++j, J_j += rows, C_j += closures, H_j += n) {
    for (int i = j; i < n; ++i) {
      H_j[i] = Dot(J_j + (i - j) * rows, J_j, rows) +
               weight * Dot(C_j + (i - j) * closures, C_j, closures);
    }
    equations->objective_gradient[j] = Dot(J_j, r, rows);
    equations->g[j] = equations->objective_gradient[j] + Dot(C_j, forces, closures);
  }
}

}  // namespace

struct NormalEquations::Kernels {
  void (*form_pinned)(const Linearization&, double, const double*, NormalEquations*) noexcept;
  void (*form)(const Linearization&, double, const double*, NormalEquations*) noexcept;
  bool (*factor)(int, double*) noexcept;
  void (*solve)(const double*, int, double*) noexcept;

  template <int kSize>
  static constexpr Kernels Of() {
    return {FormKernel<kSize, 6, 5>, FormKernel<kSize, 0, 0>, FactorLdlt<kSize>, SolveLdlt<kSize>};
  }
  static const Kernels* ForSize(int size);
};

const NormalEquations::Kernels* NormalEquations::Kernels::ForSize(int size) {
  static constexpr Kernels kKernels[] = {Of<0>(), Of<1>(), Of<2>(), Of<3>(), Of<4>(),
                                         Of<5>(), Of<6>(), Of<7>(), Of<8>()};
  return &kKernels[size < static_cast<int>(std::size(kKernels)) ? size : 0];
}

NormalEquations::NormalEquations(int unknowns)
    : H(MatrixXd::Zero(unknowns, unknowns)),
      g(VectorXd::Zero(unknowns)),
      objective_gradient(VectorXd::Zero(unknowns)),
      kernels_(Kernels::ForSize(unknowns)),
      factor_(MatrixXd::Zero(unknowns, unknowns)) {
  held.setConstant(unknowns, false);
}

void NormalEquations::Form(const Linearization& at_x, double weight,
                           const VectorXd& forces) noexcept {
  const bool pinned = at_x.r.size() == 6 && at_x.c.size() == 5;
  (pinned ? kernels_->form_pinned : kernels_->form)(at_x, weight, forces.data(), this);
}

bool NormalEquations::Factor(const VectorXd& damping) noexcept {
  std::copy_n(H.data(), H.size(), factor_.data());
  for (int j = 0; j < size(); ++j) {
    if (held[j])
      Isolate(j);
    else
      factor_(j, j) += damping[j];
  }
  return kernels_->factor(size(), factor_.data());
}

// Row and column j of what is to be factored become those of the unit matrix.
void NormalEquations::Isolate(int j) noexcept {
  factor_.row(j).head(j).setZero();
  factor_.col(j).tail(size() - j).setZero();
  factor_(j, j) = 1;
}

void NormalEquations::Solve(VectorXd* x) const noexcept {
  for (int j = 0; j < size(); ++j) {
    if (held[j]) (*x)[j] = 0;
  }
  kernels_->solve(factor_.data(), size(), x->data());
}

}  // namespace vmech
