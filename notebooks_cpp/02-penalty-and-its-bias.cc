//%% [markdown]
// # The penalty and its bias
//
// A hand holds a linkage and leads it about. A thousand times a second the pose has to be found
// that is nearest to the hand *and* keeps the loop closed. The paper does it by a penalty: it gives
// the open loop a large weight and lets least squares do the rest. That is fast and simple, and it
// leaves the loop open whenever the hand pulls. This chapter measures by how much, and takes the
// error away at no cost.

//%%
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "notebook.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/inverse/hand_tracker.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

using namespace vmech;

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## A hand that pulls
  //
  // The four-bar linkage of chapter 1, held rigidly at the middle of its coupler. It has one
  // freedom, so of the six things that a hand can ask for the linkage can grant one. The rest is
  // *constraint violation*: the hand pulls, and the linkage pulls back. Let the hand be 4 cm above
  // the grasp and turned by 6 degrees, with a spring of 1 kN/m between the two.

  //%%
  const KinematicTree tree = BuildKinematicTree(ReadMechanism("mechanisms/examples/four-bar.yaml"));
  VectorXd q_start = StartCoordinates(tree);
  notebook.Check("the loop is closed at the start", Assemble(tree, {}, &q_start).closed);

  InverseKinematicsOptions options;
  options.stiffness << 1000, 1000, 1000, 500, 500, 500;  // [N/m, N m/rad]
  InverseKinematics problem(tree, GraspFrameOf(tree, 0), options);
  const Posed X_WG = problem.GraspPose(q_start);
  const Matrix3d turn = Eigen::AngleAxisd(0.1, Vector3d::UnitZ()).toRotationMatrix();
  problem.SetTarget({turn * X_WG.R, X_WG.p + Vector3d(0, 0.04, 0)});

  //%% [markdown]
  // The question is eq. (7) of the paper in the metric of that spring,
  //
  // $$
  // \min_q \frac{1}{2} e_1' K e_1 \quad \text{subject to} \quad e_2(q) = 0
  // $$
  //
  // with $e_1$ from the grasp to the hand and $e_2$ what is left to close the loop. An exact solver
  // (steps in the null space of the loop equations) says what the answer is:

  //%%
  NullspaceOptions strict;
  strict.stopping = {1e-13, 1e-11, 500};
  const Summary exact = Solve(problem, strict, q_start);
  const Vector6d pull = problem.HandWrench(exact.x);
  const VectorXd multipliers = problem.LoopMultipliers(exact.multipliers);
  notebook.Print(exact.BriefReport());
  notebook.Print(
      fmt::format("the hand pulls with {:.2f} N and {:.2f} N m; the cut hinge answers "
                  "with {:.2f} N",
                  pull.head<3>().norm(), pull.tail<3>().norm(), multipliers.head<3>().norm()));
  notebook.Check("the exact solver arrives", exact.converged());

  //%% [markdown]
  // At the answer the pull $K e_1$ does no work on the motion that the linkage allows: along a free
  // motion $n$ ($C n = 0$) it holds that $n' J' K e_1 = 0$. So the hand is resisted in the
  // directions in which the linkage cannot move, and in no other. This is why $K$ must be the
  // metric: the minimum in any other metric $W$ has $n' J' W e_1 = 0$, and the rendered force $K
  // e_1$ would push the linkage along.

  //%%
  Linearization at(problem.sizes());
  at.Evaluate(problem, exact.x);
  const VectorXd free = FindNullSpace(at.C, 1e-9).basis.col(0);
  const VectorXd force = at.J.transpose() * at.r;  // J' K e1, over the energy scale
  notebook.CheckNear("work of the pull on the free motion, relative",
                     std::abs(free.dot(force)) / force.norm(), 0, 1e-9);

  //%% [markdown]
  // ## The paper's answer
  //
  // Eq. (8) stacks the loop under the hand, with a weight $\lambda$. In the metric $K$ the rows of
  // the hand are weighed by its square root:
  //
  // $$
  // \begin{bmatrix} K^{1/2} J \\ \lambda C \end{bmatrix} \Delta q
  // = \begin{bmatrix} K^{1/2} e_1 \\ \lambda e_2 \end{bmatrix}
  // $$
  //
  // Its normal equations are $(J' K J + \lambda^2 C' C) \Delta q = J' K e_1 + \lambda^2 C' e_2$.
  // Iterated, they stop where the right-hand side is zero, $J' K e_1 + \lambda^2 C' e_2 = 0$. At
  // the true answer the first term is not zero, because the hand pulls. So the second cannot be
  // zero either: the loop stays open by
  //
  // $$
  // e_2 \approx \frac{\mu}{\lambda^2}
  // $$
  //
  // where $\mu$ is the load that the loop would have to carry, the Lagrange multiplier. Here is the
  // same problem with one weight after another:

  //%%
  plot::LinePlot closure;
  closure.title = "How far the loop stays open";
  closure.x = {"weight λ", "", plot::ScaleType::kLog};
  closure.y = {"open loop, over the size of the linkage", "", plot::ScaleType::kLog};
  closure.series = {{"measured", {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle},
                    {"bound that the solver reports", {}, {}, plot::LineStyle::kDashed}};
  plot::LinePlot distance;
  distance.title = "How far the pose is from the exact one";
  distance.x = closure.x;
  distance.y = {"distance of the joint angles", "rad", plot::ScaleType::kLog};
  distance.series = {{"penalty", {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle}};

  bool bounded = true;
  std::vector<double> measured;
  const std::vector<double> weights{3, 10, 30, 100, 300, 1000, 3000, 1e4};
  for (double lambda : weights) {
    PenaltyOptions penalty;
    penalty.weight = lambda;
    const Summary biased = Solve(problem, penalty, q_start);
    at.Evaluate(problem, biased.x);
    measured.push_back(at.c.norm());
    bounded = bounded && at.c.norm() <= biased.bias_bound * (1 + 1e-6);
    for (plot::Series& series : closure.series) series.x.push_back(lambda);
    closure.series[0].y.push_back(at.c.norm());
    closure.series[1].y.push_back(biased.bias_bound);
    distance.series[0].x.push_back(lambda);
    distance.series[0].y.push_back((biased.x - exact.x).norm());
  }
  notebook.Show(closure);
  notebook.Show(distance);
  notebook.Check("the truth is within the reported bound at every weight", bounded);
  notebook.CheckNear("ten times the weight closes the loop better by", measured[2] / measured[4],
                     100, 1);
  notebook.CheckNear("open loop at weight 100, times its square, over the multiplier",
                     measured[3] * 1e4 / exact.multipliers.norm(), 1, 0.01);

  //%% [markdown]
  // So the penalty's error is not noise: it *is* the load, divided by the weight squared. Two
  // things follow. The weight cannot be raised for ever, because the condition number of the normal
  // equations grows with $\lambda^2$: at $\lambda = 10^4$ the free motion, which has weight one,
  // has lost about half of the sixteen digits of a double. And the error can be computed, so it can
  // be taken away.
  //
  // ## One more vector
  //
  // Keep a running multiplier $\mu$ and shift the loop error by it before each step:
  //
  // $$
  // \begin{bmatrix} K^{1/2} J \\ \lambda C \end{bmatrix} \Delta q
  // = \begin{bmatrix} K^{1/2} e_1 \\ \lambda (e_2 + \mu / \lambda^2) \end{bmatrix} , \qquad
  // \mu \leftarrow \mu + \lambda^2 (e_2 - C \Delta q)
  // $$
  //
  // That is the augmented Lagrangian of Hestenes and Powell: the same matrix, the same
  // factorisation, and one vector to remember. Step by step from the start:

  //%%
  plot::LinePlot steps;
  steps.title = "The loop closes step by step";
  steps.x = {"step", ""};
  steps.y = {"open loop", "", plot::ScaleType::kLog};
  const int count = 14;
  bool finite = true;
  for (double lambda : {10.0, 30.0, 100.0}) {
    AugmentedLagrangianOptions multiplier;
    multiplier.weight = lambda;
    AugmentedLagrangianWorkspace workspace(problem);
    VectorXd q = q_start;
    plot::Series series{
        fmt::format("λ = {:.0f}", lambda), {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle};
    for (int i = 1; i <= count; ++i) {
      finite = Step(problem, multiplier, &q, &workspace).ok && finite;
      at.Evaluate(problem, q);
      series.x.push_back(i);
      series.y.push_back(std::max(at.c.norm(), 1e-17));
    }
    steps.series.push_back(series);
    notebook.CheckNear(fmt::format("open loop at the end, weight {:.0f}", lambda), at.c.norm(), 0,
                       1e-10);
    notebook.CheckNear(fmt::format("load found, over the exact one, weight {:.0f}", lambda),
                       (at.C.transpose() * workspace.multipliers).norm() /
                           (at.C.transpose() * exact.multipliers).norm(),
                       1, 1e-5);
  }
  notebook.Show(steps);
  notebook.Check("every step is finite", finite);

  //%% [markdown]
  // The weight no longer decides how well the loop closes, only how fast. And the multipliers,
  // which are the forces at the cut hinge, are known at the end without further work.
  //
  // ## A moving hand
  //
  // In the haptic loop nothing is iterated to the end. The hand moves on after a millisecond; the
  // pose and the multipliers of the last tick are where the next one begins. Let the hand draw a
  // circle that the coupler cannot follow, once in two seconds, and compare the paper's two steps
  // of penalty with `HandTracker`, which remembers the multipliers:

  //%%
  const int ticks = 2000;
  PenaltyOptions penalty;
  penalty.weight = 100;
  PenaltyWorkspace workspace(problem);
  TrackOptions track;
  track.kinematics = options;
  HandTracker tracker(tree, GraspFrameOf(tree, 0), q_start, track);
  VectorXd q = q_start;

  plot::LinePlot moving;
  moving.title = "Open loop while the hand draws a circle";
  moving.x = {"time", "s"};
  moving.y = {"open loop", "m", plot::ScaleType::kLog};
  moving.series = {{"penalty, two steps a tick", {}, {}},
                   {"with multipliers", {}, {}, plot::LineStyle::kDashed}};
  double worst_penalty = 0, worst_tracker = 0;
  for (int k = 0; k < ticks; ++k) {
    const double angle = 2 * 3.14159265358979 * k / ticks;
    const Vector3d off(0.08 * std::sin(angle), 0.08 * (1 - std::cos(angle)), 0);
    const Posed X_WH{X_WG.R, X_WG.p + off};
    problem.SetTarget(X_WH);
    for (int i = 0; i < 2; ++i) (void)Step(problem, penalty, &q, &workspace);
    (void)tracker.Advance(X_WH);
    const double by_penalty = problem.LoopError(q).norm();
    const double by_tracker = problem.LoopError(tracker.q()).norm();
    worst_penalty = std::max(worst_penalty, by_penalty);
    worst_tracker = std::max(worst_tracker, by_tracker);
    for (plot::Series& series : moving.series) series.x.push_back(1e-3 * k);
    moving.series[0].y.push_back(by_penalty);
    moving.series[1].y.push_back(std::max(by_tracker, 1e-17));
  }
  notebook.Show(moving);
  notebook.Print(tracker.summary().BriefReport());
  notebook.Print(fmt::format("largest open loop: penalty {:.2g} m, with multipliers {:.2g} m",
                             worst_penalty, worst_tracker));
  notebook.Check("the penalty leaves micrometres", worst_penalty > 1e-6);
  notebook.Check("with multipliers the loop is closed to a tenth of a nanometre",
                 worst_tracker <= 1e-10);
  notebook.Check("no target was lost", tracker.summary().held() == 0);

  //%% [markdown]
  // A micrometre cannot be felt. But a loop error that jumps by $e$ from one tick to the next
  // looks, differentiated twice over a period $T$, like an acceleration of $e / T^2$: 1 micrometre
  // at 1 kHz is 1 m/s². Times the mass of a link that is a force, so the wrenches of chapter 4 are
  // only as good as the pose that they are computed in.

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
