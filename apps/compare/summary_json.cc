#include "vmech/apps/compare/summary_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "vmech/comparison/statistics.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

Json Finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json BlockSummary(const Suite& suite, const std::vector<Result>& results, SolverEntry solver,
                  int block) {
  const Tally tally = TallyOf(suite, results, [&](const Result& r) {
    return r.solver == solver && r.problem.block == block;
  });
  std::vector<double> times, evaluations;
  for (const Result& r : results) {
    if (r.solver != solver || r.problem.block != block) continue;
    if (!Succeeded(r, suite.blocks[block].kind)) continue;
    times.push_back(r.time);
    evaluations.push_back(r.evaluations);
  }
  Json json{{"problems", tally.problems},
            {"succeeded", tally.succeeded},
            {"own_branch", tally.own},
            {"other_branch", tally.other},
            {"median_time", Finite(MedianOf(times))},
            {"median_evaluations", Finite(MedianOf(evaluations))}};
  if (suite.blocks[block].is_path()) {
    json["targets"] = tally.targets;
    json["reached"] = tally.reached;
    json["jumps"] = tally.jumps;
  }
  return json;
}

}  // namespace

std::string ComparisonSummary(const Suite& suite, const std::vector<Result>& results,
                              std::string_view version) {
  Json json{{"suite", suite.name},         {"vmech", version},       {"seed", suite.seed},
            {"mechanisms", Json::array()}, {"rows", results.size()}, {"solvers", Json::object()}};
  for (const SuiteMechanism& mechanism : suite.mechanisms) {
    json["mechanisms"].push_back(mechanism.name);
  }
  for (const SolverEntry& solver : SolversOf(results)) {
    Json& blocks = json["solvers"][std::string(solver.name())] = Json::object();
    for (size_t b = 0; b < suite.blocks.size(); ++b) {
      blocks[suite.blocks[b].name] = BlockSummary(suite, results, solver, static_cast<int>(b));
    }
  }
  return json.dump(2) + "\n";
}

}  // namespace vmech
