// Accelerations beside Simbody's in the same run: what an integrator asks for at every evaluation.
// Simbody is given loops without redundant equations, and closed poses.

#include <benchmark/benchmark.h>

#include <chrono>
#include <vector>

#include "reference_cases.h"
#include "simbody_model.h"
#include "support/windows.h"
#include "vmech/dynamics/simulation/equations/equations_of_motion.h"

namespace vmech {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The start of a simulation as Simbody takes it: its links there, in the order of `mechanism`.
peers::SimbodyQuery QueryOf(const LoadStudyResult& loads, const Mechanism& mechanism) {
  peers::SimbodyQuery query;
  query.external_W.resize(mechanism.links.size());
  for (size_t link = 0; link < mechanism.links.size(); ++link) {
    const LinkMotion& motion = loads.poses[0].links[link];
    query.links.push_back({motion.X_WL, motion.v, motion.w});
  }
  return query;
}

/// Both sides compute accelerations at the same pose by turns, once they agree about them.
void BesideSimbody(benchmark::State& state, const Simulation& simulation,
                   const Mechanism& for_simbody, peers::SimbodyQuery query,
                   const LoadStudyResult& loads) {
  peers::SimbodyModel peer(for_simbody, {}, peers::DriveMode::kForce);
  peer.DropRedundantEquations(query.links);
  const peers::SimbodyAnswer answer = peer.Evaluate(query);
  for (size_t link = 0; link < for_simbody.links.size(); ++link) {
    const Vector3d own = loads.poses[0].links[link].alpha;
    if ((own - answer.accelerations[link].alpha_WL).norm() > 1e-6 * (1 + own.norm())) {
      state.SkipWithError("the two sides disagree on an acceleration");
      return;
    }
  }
  const PreparedSimulation prepared = PrepareSimulation(simulation);
  EquationsOfMotion equations(prepared);
  VectorXd y = VectorXd::Zero(equations.size()), slopes = y;
  y.head(prepared.q.size()) = prepared.q;
  double own = 0, others = 0;
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 10; ++i) equations.Slopes(0, y.data(), slopes.data());
    own += SecondsSince(start);
    start = std::chrono::steady_clock::now();
    for (int i = 0; i < 10; ++i) peer.Accelerate();
    others += SecondsSince(start);
  }
  const double count = 10 * static_cast<double>(state.iterations());
  state.counters["vmech_us"] = 1e6 * own / count;
  state.counters["simbody_us"] = 1e6 * others / count;
  state.counters["ratio"] = others / own;
}

/// For Simbody the spring is a force between two points, without the strut whose links have no
/// mass.
void AndrewsBesideSimbody(benchmark::State& state) {
  const Simulation simulation = AndrewsSqueezer();
  const LoadStudyResult loads = Simulate(simulation).loads;
  Mechanism m = simulation.mechanism;
  const int barrel = FindLink(m, "strut_barrel"), k3 = FindLink(m, "k3");
  std::erase_if(m.joints, [&](const Joint& joint) {
    return joint.first.link >= barrel || joint.second.link >= barrel;
  });
  m.links.resize(static_cast<size_t>(barrel));
  peers::SimbodyQuery query = QueryOf(loads, m);
  const Posed& X_WL = query.links[static_cast<size_t>(k3)].X_WL;
  const Vector3d p_WD = X_WL * m.links[static_cast<size_t>(k3)].anchors[2].X_LA.p;
  const Vector3d strut = p_WD - m.links[0].anchors[3].X_LA.p;
  const Vector3d pull = -4530 * (strut.norm() - 0.07785) * strut.normalized();
  query.external_W[static_cast<size_t>(k3)] = {pull, (p_WD - X_WL.p).cross(pull)};
  const int crank = FindLink(m, "k1");
  query.external_W[static_cast<size_t>(crank)] = {Vector3d::Zero(), {0, 0, 0.033}};
  BesideSimbody(state, simulation, m, query, loads);
}
BENCHMARK(AndrewsBesideSimbody);

void WindowsBesideSimbody(benchmark::State& state) {
  Simulation simulation;
  simulation.mechanism = Windows(40, 0.3);
  simulation.times = {0, 1e-3};
  const LoadStudyResult loads = Simulate(simulation).loads;
  const Mechanism& m = simulation.mechanism;
  BesideSimbody(state, simulation, m, QueryOf(loads, m), loads);
}
BENCHMARK(WindowsBesideSimbody);

}  // namespace
}  // namespace vmech
