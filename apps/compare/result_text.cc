#include "vmech/apps/compare/result_text.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "vmech/studies/csv_table.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

double NumberOf(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::string Row(const Suite& suite, const Result& r) {
  const TargetBlock& block = suite.blocks[r.problem.block];
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                     CsvCell(suite.mechanisms[r.problem.mechanism].name), CsvCell(block.name),
                     NameOf(block.kind), block.is_path() ? "path" : NameOf(block.start),
                     r.problem.index + 1, r.solver.name(), NameOf(r.verdict), r.targets, r.reached,
                     r.jumps, r.iterations, r.evaluations, r.jacobian_evaluations, r.time,
                     r.e1_position, r.e1_rotation, r.e2, r.kkt, NameOf(r.branch), r.distance,
                     CsvCell(r.message));
}

}  // namespace

std::string ToLine(const Result& r) {
  const Json json{{"mechanism", r.problem.mechanism},
                  {"block", r.problem.block},
                  {"index", r.problem.index},
                  {"solver", r.solver.name()},
                  {"verdict", NameOf(r.verdict)},
                  {"message", r.message},
                  {"targets", r.targets},
                  {"reached", r.reached},
                  {"jumps", r.jumps},
                  {"iterations", r.iterations},
                  {"evaluations", r.evaluations},
                  {"jacobian_evaluations", r.jacobian_evaluations},
                  {"time", r.time},
                  {"e1_position", r.e1_position},
                  {"e1_rotation", r.e1_rotation},
                  {"e2", r.e2},
                  {"kkt", r.kkt},
                  {"branch", NameOf(r.branch)},
                  {"distance", r.distance}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Result> ResultFromLine(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    Result r;
    r.problem = {json.at("mechanism"), json.at("block"), json.at("index")};
    const std::optional<SolverEntry> solver =
        ContestantFromName(json.at("solver").get<std::string>());
    if (!solver) return {};
    r.solver = *solver;
    r.verdict = VerdictFromName(json.at("verdict").get<std::string>());
    r.message = json.at("message");
    r.targets = json.at("targets");
    r.reached = json.at("reached");
    r.jumps = json.at("jumps");
    r.iterations = json.at("iterations");
    r.evaluations = json.at("evaluations");
    r.jacobian_evaluations = json.at("jacobian_evaluations");
    r.time = NumberOf(json.at("time"));
    r.e1_position = NumberOf(json.at("e1_position"));
    r.e1_rotation = NumberOf(json.at("e1_rotation"));
    r.e2 = NumberOf(json.at("e2"));
    r.kkt = NumberOf(json.at("kkt"));
    r.branch = BranchFromName(json.at("branch").get<std::string>());
    r.distance = NumberOf(json.at("distance"));
    return r;
  } catch (const Json::exception&) {
    return {};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::string ResultsTable(const Suite& suite, const std::vector<Result>& results) {
  std::string table =
      "mechanism,block,kind,start,index,solver,verdict,targets,reached,jumps,iterations,"
      "evaluations,jacobian_evaluations,time,e1_position,e1_rotation,e2,kkt,branch,distance,"
      "message\n";
  for (const Result& result : results) table += Row(suite, result);
  return table;
}

}  // namespace vmech
