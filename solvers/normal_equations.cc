#include "vmech/solvers/normal_equations.h"

#include <algorithm>

namespace vmech {
namespace {

// a'b, four terms at a time and the rest of m without a loop.
inline double Dot(const double* a, const double* b, int m) noexcept {
  using Pack = Eigen::Array4d;
  using Load = Eigen::Map<const Pack>;
  double rest = 0;
  if (m & 1) --m, rest = a[m] * b[m];
  if (m & 2) m -= 2, rest += a[m] * b[m] + a[m + 1] * b[m + 1];
  if (m == 0) return rest;
  Pack sum = Load(a) * Load(b);
  for (int k = 4; k < m; k += 4) sum += Load(a + k) * Load(b + k);
  return sum.sum() + rest;
}

// The kernels below take their size from the template where it is not zero, so that the compiler
// unrolls them: twice as fast for the few unknowns of one loop.

template <int kSize>
void FormKernel(const Linearization& at_x, double weight, const double* forces,
                NormalEquations* equations) noexcept {
  const int n = kSize > 0 ? kSize : equations->size();
  const int rows = static_cast<int>(at_x.r.size()), closures = static_cast<int>(at_x.c.size());
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

// The lower triangle becomes unit L, with 1/D on the diagonal.
template <int kSize>
bool FactorInPlace(double* L, int size) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) {
    double* const L_j = L + j * n;
    if (!(L_j[j] > 0)) return false;
    const double inverse = 1 / L_j[j];
    L_j[j] = inverse;
    for (int k = j + 1; k < n; ++k) {
      const double scaled = L_j[k] * inverse;
      for (int i = k; i < n; ++i) L[k * n + i] -= scaled * L_j[i];
    }
    for (int i = j + 1; i < n; ++i) L_j[i] *= inverse;
  }
  return true;
}

template <int kSize>
void SolveInPlace(const double* L, int size, double* x) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) x[i] -= L[j * n + i] * x[j];
  }
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= L[j * n + j];
    for (int i = j + 1; i < n; ++i) x[j] -= L[j * n + i] * x[i];
  }
}

}  // namespace

struct NormalEquations::Kernels {
  void (*form)(const Linearization&, double, const double*, NormalEquations*) noexcept;
  bool (*factor)(double*, int) noexcept;
  void (*solve)(const double*, int, double*) noexcept;

  template <int kSize>
  static constexpr Kernels Of() {
    return {FormKernel<kSize>, FactorInPlace<kSize>, SolveInPlace<kSize>};
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
  kernels_->form(at_x, weight, forces.data(), this);
}

bool NormalEquations::Factor(const VectorXd& damping) noexcept {
  std::copy_n(H.data(), H.size(), factor_.data());
  for (int j = 0; j < size(); ++j) {
    if (held[j])
      Isolate(j);
    else
      factor_(j, j) += damping[j];
  }
  return kernels_->factor(factor_.data(), size());
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
