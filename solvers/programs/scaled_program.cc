#include "vmech/solvers/programs/scaled_program.h"

#include <algorithm>

namespace vmech {
namespace {

double Violation(const VectorXd& g) {
  return g.size() == 0 ? 0 : std::max(0.0, g.maxCoeff());
}

}  // namespace

bool ScaledProgram::IsFeasible(const Point& point) const {
  return Violation(point.g) <= feasibility_;
}

VectorXd ScaledProgram::Unscaled(const VectorXd& u) const {
  return program_.lower() + u.cwiseProduct(Range());
}

const ScaledProgram::Point& ScaledProgram::At(const VectorXd& u) {
  if (here_.u.size() == 0 || u != here_.u) Evaluate(u);
  return here_;
}

void ScaledProgram::Evaluate(const VectorXd& u) {
  ++evaluations_;
  here_.u = u;
  here_.df.setZero(variables());
  here_.g.setZero(constraints());
  here_.dg.setZero(constraints(), variables());
  here_.defined = program_.Evaluate(Unscaled(u), &here_.f, &here_.df, &here_.g, &here_.dg);
  if (!here_.defined) {
    DrawBack();
    return;
  }
  here_.df.array() *= Range().array();
  here_.dg *= Range().asDiagonal();
  last_ = here_;
  if (!best_.defined || IsBetter(here_, best_)) best_ = here_;
}

void ScaledProgram::DrawBack() {
  constexpr double kSteep = 10;
  if (!last_.defined) {
    here_.f = 1e6;
    return;
  }
  const double steep = kSteep * (1 + std::abs(last_.f));
  const VectorXd away = here_.u - last_.u;
  here_.f = last_.f + steep * away.squaredNorm();
  here_.df = 2 * steep * away;
  here_.g = last_.g;
}

bool ScaledProgram::IsBetter(const Point& a, const Point& b) const {
  if (IsFeasible(a) != IsFeasible(b)) return IsFeasible(a);
  return IsFeasible(a) ? a.f < b.f : Violation(a.g) < Violation(b.g);
}

}  // namespace vmech
