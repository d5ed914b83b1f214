#include <nlopt.h>

#include <memory>
#include <string>

#include "vmech/solvers/programs/scaled_program.h"

namespace vmech {
namespace {

struct DestroyProgram {
  void operator()(nlopt_opt_s* opt) const { nlopt_destroy(opt); }
};

const ScaledProgram::Point& PointAt(unsigned n, const double* u, void* program) {
  return static_cast<ScaledProgram*>(program)->At(Eigen::Map<const VectorXd>(u, n));
}

double ProgramObjective(unsigned n, const double* u, double* gradient, void* program) {
  const ScaledProgram::Point& point = PointAt(n, u, program);
  if (gradient != nullptr) Eigen::Map<VectorXd>(gradient, n) = point.df;
  return point.f;
}

void ProgramConstraints(unsigned m, double* g, unsigned n, const double* u, double* gradient,
                        void* program) {
  const ScaledProgram::Point& point = PointAt(n, u, program);
  const double inside = 0.5 * static_cast<ScaledProgram*>(program)->feasibility();
  Eigen::Map<VectorXd>(g, m) = point.g.array() + inside;
  if (gradient == nullptr) return;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(gradient, m, n) = point.dg;
}

std::string MinimiseByNlopt(ScaledProgram& program, const ProgramOptions& options,
                            const VectorXd& u) {
  const auto n = static_cast<unsigned>(program.variables());
  const auto m = static_cast<unsigned>(program.constraints());
  const bool slsqp = options.method == ProgramMethod::kSlsqp;
  const std::unique_ptr<nlopt_opt_s, DestroyProgram> opt(
      nlopt_create(slsqp ? NLOPT_LD_SLSQP : NLOPT_LD_MMA, n));
  nlopt_set_min_objective(opt.get(), ProgramObjective, &program);
  nlopt_set_lower_bounds1(opt.get(), 0);
  nlopt_set_upper_bounds1(opt.get(), 1);
  if (m > 0) {
    const VectorXd closeness = VectorXd::Constant(m, 0.1 * program.feasibility());
    nlopt_add_inequality_mconstraint(opt.get(), m, ProgramConstraints, &program, closeness.data());
  }
  nlopt_set_ftol_rel(opt.get(), options.tolerance);
  nlopt_set_xtol_rel(opt.get(), options.tolerance);
  nlopt_set_maxeval(opt.get(), options.max_evaluations);
  VectorXd at = u;
  double f = 0;
  const nlopt_result result = nlopt_optimize(opt.get(), at.data(), &f);
  return std::string(slsqp ? "SLSQP: " : "MMA: ") + nlopt_result_to_string(result);
}

}  // namespace
}  // namespace vmech

extern "C" const vmech::MinimiseFunction vmech_minimise;
const vmech::MinimiseFunction vmech_minimise = vmech::MinimiseByNlopt;
