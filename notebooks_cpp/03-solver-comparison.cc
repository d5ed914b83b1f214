//%% [markdown]
// # One set of problems, every solver
//
// Which solver should close the loops of a mechanism? Papers on closed chains mostly answer with
// the time of one solver on one mechanism. This chapter does what `vmech compare` does at large: it
// poses problems whose answers are known, lets every solver at them, and judges what comes back by
// one measure, whatever the solver says of itself.

//%%
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "notebook.h"
#include "vmech/comparison/profile.h"
#include "vmech/comparison/solve_problem.h"
#include "vmech/comparison/statistics.h"
#include "vmech/comparison/target_maker.h"
#include "vmech/mechanisms/files/reader.h"

using namespace vmech;

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## Problems with known answers
  //
  // All solvers get the same problem: bring the grasp as near to the hand as the loops allow,
  //
  // $$
  // \min_q \frac{1}{2} e_1^T K e_1 \quad \text{subject to} \quad e_2(q) = 0
  // $$
  //
  // A target that can be reached is easily made: walk from the mechanism's start over closed
  // configurations and take the pose of the grasp wherever the walk ends. A target that can *not*
  // be reached, with a known answer, takes one thought more. At a closed configuration $q$ let $Z$
  // span the free motions and $J$ be the Jacobian of the grasp. Moved off its pose by $u$ with
  //
  // $$
  // Z^T J^T K u = 0
  // $$
  //
  // the hand pulls at right angles to every motion there is, and $q$ itself stays a stationary
  // point: exactly, since the logarithm of a rotation keeps $J^T K e_1 = J^T K u$.

  //%%
  Suite suite;
  suite.stopping.max_iterations = 200;
  suite.reach_tolerance = 1e-5;
  suite.repetitions = 1;
  for (const char* name : {"slider-crank", "rssr", "bennett", "delta-robot"}) {
    SuiteMechanism entry;
    entry.name = name;
    entry.mechanism = ReadMechanism(fmt::format("mechanisms/examples/{}.yaml", name));
    entry.grasp = entry.mechanism.grasps[0];
    entry.blocks = {0, 1, 2};
    suite.mechanisms.push_back(entry);
  }
  TargetBlock near, far, off;
  near.name = "near", near.count = 30, near.start_distance = 0.2;
  far.name = "far", far.count = 30, far.start = StartKind::kFar;
  off.name = "unreachable", off.count = 15, off.kind = TargetKind::kUnreachable, off.offset = 0.02;
  suite.blocks = {near, far, off};

  const auto make = [&](const ProblemId& id, Subject* subject) {
    const uint64_t seed =
        SeedOf(3, {uint64_t(id.mechanism), uint64_t(id.block), uint64_t(id.index)});
    return MakeProblem(subject, suite.blocks[id.block], seed);
  };
  std::vector<Result> results;
  for (const ProblemId& id : ProblemsOf(suite)) {
    Subject subject(suite.mechanisms[id.mechanism]);
    const Problem problem = make(id, &subject);
    for (const SolverEntry& solver : AllContestants()) {
      if (!solver.Takes(suite.blocks[id.block])) continue;
      const Result result = SolveProblem(suite, id, problem, &subject, solver);
      if (result.verdict != Verdict::kUnavailable) results.push_back(result);
    }
  }
  const std::vector<SolverEntry> solvers = SolversOf(results);

  //%% [markdown]
  // ## Who solves what
  //
  // Success means: the loops closed to $10^{-10}$ and the target reached; or, where it is out of
  // reach, a KKT error of at most $10^{-9}$ and second derivatives that say it is a minimum.

  //%%
  html::Table table;
  table.columns = {{"Solver"}};
  for (const TargetBlock& block : suite.blocks) table.columns.push_back({block.name, true});
  auto share = [&](const SolverEntry& solver, int block) {
    return TallyOf(suite, results,
                   [&](const Result& r) { return r.solver == solver && r.problem.block == block; })
        .share();
  };
  double best_near = 0, best_off = 0;
  for (const SolverEntry& solver : solvers) {
    table.rows.push_back({std::string(solver.name())});
    for (int b = 0; b < 3; ++b) {
      table.rows.back().push_back(fmt::format("{:.1f} %", 100 * share(solver, b)));
    }
    best_near = std::max(best_near, share(solver, 0));
    best_off = std::max(best_off, share(solver, 2));
  }
  notebook.Show(table);
  notebook.Check("from nearby, some solver reaches every target", best_near == 1);
  notebook.Check("where none can be reached, some solver finds every nearest pose", best_off == 1);

  //%% [markdown]
  // The penalty of the paper, eq. (8), is a special case: it never closes the loops of a mechanism
  // that is pulled off its path, but leaves them open by the multiplier over $\lambda^2$ (chapter 2
  // measures how far). Its verdict is `biased`, and that is no fault of the program:

  //%%
  const SolverEntry penalty(Backend::kPenalty);
  int closed = 0, biased = 0;
  for (const Result& r : results) {
    if (!(r.solver == penalty) || r.problem.block != 2) continue;
    closed += r.verdict == Verdict::kUnreachable;
    biased += r.verdict == Verdict::kBiased;
  }
  notebook.Print(fmt::format("penalty, out of reach: {} biased, {} closed", biased, closed));
  notebook.Check("the penalty leaves the loops open when it is pulled on", biased > 0);

  //%% [markdown]
  // All others that end at the configuration from which the target was made end at the *same* one.
  // How near they come to it depends on the problem as well: where the hand is off by the radius of
  // curvature of the path, the minimum is flat.

  //%%
  double farthest = 0;
  int agreeing = 0;
  for (const Result& r : results) {
    if (r.verdict != Verdict::kUnreachable || r.branch != Branch::kOwn) continue;
    farthest = std::max(farthest, r.distance);
    ++agreeing;
  }
  notebook.Print(fmt::format("{} results on their own branch", agreeing));
  notebook.CheckNear("farthest from the stationary configuration [rad, lengths]", farthest, 0,
                     1e-5);

  //%% [markdown]
  // ## Why nobody solves everything from far away
  //
  // From a start that has nothing to do with the target even an exact solver may end at a pose that
  // is nearest *in its neighbourhood*. That is a property of the problem, as a look at the
  // slider-crank shows: it has one freedom, so all its configurations lie on one curve, and the
  // distance of the grasp from a target can be drawn over it. Here is the first target at which the
  // null space method ended at a local minimum.

  //%%
  const auto missed = std::find_if(results.begin(), results.end(), [](const Result& r) {
    return r.problem.mechanism == 0 && r.verdict == Verdict::kLocalMinimum &&
           r.solver == SolverEntry(Backend::kNullspace);
  });
  notebook.Check("there is such a target", missed != results.end());
  if (missed == results.end()) return notebook.ExitCode();
  Subject slider_crank(suite.mechanisms[0]);
  const Problem problem = make(missed->problem, &slider_crank);
  const KinematicTree& tree = slider_crank.tree();
  const int crank = CoordinateIndex(tree, FindJoint(tree.mechanism, "main"), 0);
  PortableRandom random(1);
  ClosedWalk walk = slider_crank.WalkFrom(slider_crank.q_start(), &random);
  InverseKinematics& ik = slider_crank.problem();
  ik.SetTarget(problem.targets[0]);
  std::vector<std::pair<double, double>> curve;  // crank angle, distance
  for (double way = 0; way < 14; way += 0.02) {
    const Vector6d e1 = ik.HandError(walk.q());
    const double turn = 2 * std::numbers::pi;
    const double angle = walk.q()[crank] - turn * std::floor(walk.q()[crank] / turn);
    curve.push_back({angle * 180 / std::numbers::pi,
                     std::hypot(e1.head<3>().norm() / tree.length, e1.tail<3>().norm())});
    walk.Step(0.02, 0);
  }
  std::sort(curve.begin(), curve.end());

  plot::LinePlot distance;
  distance.title = "Slider-crank: distance of the grasp from one target";
  distance.x = {"crank angle", "°", plot::ScaleType::kDegrees};
  distance.y = {"distance, characteristic lengths and radians", ""};
  distance.series = {{"distance", {}, {}}};
  int minima = 0;
  for (size_t i = 0; i < curve.size(); ++i) {
    distance.series[0].x.push_back(curve[i].first);
    distance.series[0].y.push_back(curve[i].second);
  }
  const size_t n = curve.size(), window = n / 40;  // wide enough to look past the seam of two turns
  for (size_t i = 0; i < n; ++i) {
    bool least = true;
    for (size_t k = 1; k <= window; ++k) {
      least = least && curve[i].second < curve[(i + k) % n].second &&
              curve[i].second <= curve[(i + n - k) % n].second;
    }
    minima += least;
  }
  notebook.Show(distance);
  notebook.Check("the distance has more than one minimum along the crank's turn", minima > 1);

  //%% [markdown]
  // A solver that walks downhill ends in the valley it began in. So a comparison must say two
  // things: how much is solved from nearby, where a failure is the solver's, and how much from far
  // away, where it may be the problem's. `vmech compare` lists the problems that nobody solved.
  //
  // ## Performance profiles
  //
  // Means of times say little when some solvers fail. Dolan and Moré draw, for each solver $s$, the
  // share of all problems that it solves within a factor $\tau$ of the best:
  //
  // $$
  // \rho_s(\tau) = \frac{1}{n} \sum_p [ t_{p,s} \le \tau \min_{s'} t_{p,s'} ]
  // $$
  //
  // Here the cost is the number of evaluations of the loops, which is the same on every machine.

  //%%
  const auto costs = CostsOf(
      suite, results, solvers, [](const Result&) { return true; },
      [](const Result& r) { return std::max(r.evaluations, 1); });
  const PerformanceProfile profile = MakePerformanceProfile(costs);
  const double solved =
      double(std::count_if(costs.begin(), costs.end(),
                           [](const auto& row) {
                             return std::isfinite(*std::min_element(row.begin(), row.end()));
                           })) /
      double(costs.size());
  plot::LinePlot profiles;
  profiles.title = "Performance profile on evaluations";
  profiles.x = {"evaluations over those of the most frugal solver", "", plot::ScaleType::kLog, 1,
                100};
  profiles.y = {"share of the problems", "%", plot::ScaleType::kLinear, 0, 100};
  profiles.height = 340;
  double first = 0, worst = 0;
  for (size_t s = 0; s < solvers.size(); ++s) {
    plot::Series series{std::string(solvers[s].name()), {}, {}};
    if (s >= 7) series.line = plot::LineStyle::kDashed;
    for (double tau = 1; tau < 100; tau *= 1.02) {
      series.x.push_back(tau);
      series.y.push_back(100 * profile.curves[s].At(tau));
    }
    profiles.series.push_back(series);
    first += profile.curves[s].At(1);
    const Tally all =
        TallyOf(suite, results, [&](const Result& r) { return r.solver == solvers[s]; });
    worst = std::max(worst, std::abs(profile.curves[s].At(profile.largest_ratio) - all.share()));
  }
  notebook.Show(profiles);
  notebook.CheckNear("a profile ends at the share of success, largest difference", worst, 0, 1e-12);
  notebook.Check("every solved problem has a best solver, some have several",
                 first >= solved - 1e-12);

  //%% [markdown]
  // At the left stands who is best most often, at the right who solves most. Evaluations are not
  // time: Ipopt needs few of them, and for each a hundred times as long as the fast paths do, which
  // is why a real-time loop uses those. The report of
  //
  // ```
  // vmech compare mechanisms/examples/closed-chains.yaml
  // ```
  //
  // has both profiles, on time and on evaluations, over 22 mechanisms and thousands of problems.

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
