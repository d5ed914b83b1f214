#include "vmech/apps/compare/run_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>

#include "vmech/apps/compare/result_text.h"
#include "vmech/comparison/random.h"
#include "vmech/comparison/solve_problem.h"
#include "vmech/comparison/target_maker.h"

namespace vmech {
namespace {

/// A problem and the solvers that are still to solve it.
struct Task {
  ProblemId problem;
  std::vector<SolverEntry> solvers;
};

std::string TextOf(const Task& task) {
  std::string text =
      fmt::format("{} {} {}", task.problem.mechanism, task.problem.block, task.problem.index);
  for (const SolverEntry solver : task.solvers) text += fmt::format(" {}", solver.name());
  return text;
}

Task TaskFrom(const std::string& text) {
  Task task;
  std::istringstream words(text);
  words >> task.problem.mechanism >> task.problem.block >> task.problem.index;
  for (std::string name; words >> name;) task.solvers.push_back(ContestantFromName(name).value());
  return task;
}

uint64_t SeedOfProblem(const Suite& suite, const ProblemId& id) {
  return SeedOf(suite.seed, {static_cast<uint64_t>(id.mechanism), static_cast<uint64_t>(id.block),
                             static_cast<uint64_t>(id.index)});
}

bool Before(const Result& a, const Result& b) {
  return std::pair(a.problem, a.solver) < std::pair(b.problem, b.solver);
}

/// Collects results and knows what is missing.
class Ledger {
 public:
  Ledger(const Suite& suite, const std::vector<SolverEntry>& solvers, Journal* journal)
      : journal_(journal) {
    std::set<std::pair<ProblemId, SolverEntry>> there;
    for (const Result& result : journal->found()) {
      if (std::find(solvers.begin(), solvers.end(), result.solver) == solvers.end()) continue;
      there.insert({result.problem, result.solver});
      results_.push_back(result);
    }
    for (const ProblemId& problem : ProblemsOf(suite)) {
      Task task{problem, {}};
      for (const SolverEntry solver : solvers) {
        if (!solver.Takes(suite.blocks[problem.block])) continue;
        if (!there.contains({problem, solver})) task.solvers.push_back(solver);
      }
      if (!task.solvers.empty()) open_.push_back(task);
    }
  }

  std::vector<std::string> Tasks() const {
    std::vector<std::string> texts;
    for (const Task& task : open_) texts.push_back(TextOf(task));
    return texts;
  }

  void Add(size_t task, const Result& result) {
    journal_->Append(result);
    results_.push_back(result);
    std::erase(open_[task].solvers, result.solver);
  }

  /// A solver that took its process down has failed; the others go on.
  std::optional<std::string> RecordLost(size_t index, const std::string& reason) {
    Task& task = open_[index];
    if (task.solvers.empty()) return {};
    Result result;
    result.problem = task.problem;
    result.solver = task.solvers.front();
    result.verdict = Verdict::kFailed;
    result.message = reason;
    Add(index, result);
    if (task.solvers.empty()) return {};
    return TextOf(task);
  }

  size_t done() const { return results_.size(); }

  std::vector<Result> Sorted() && {
    std::sort(results_.begin(), results_.end(), Before);
    return std::move(results_);
  }

 private:
  Journal* journal_;
  std::vector<Task> open_;
  std::vector<Result> results_;
};

}  // namespace

size_t RowsOf(const Suite& suite, const std::vector<SolverEntry>& solvers) {
  size_t rows = 0;
  for (const ProblemId& problem : ProblemsOf(suite)) {
    for (const SolverEntry& solver : solvers) rows += solver.Takes(suite.blocks[problem.block]);
  }
  return rows;
}

Work ComparisonWork(const Suite& suite) {
  auto subjects = std::make_shared<std::map<int, Subject>>();
  return [&suite, subjects](const std::string& text, const Emit& emit) {
    const Task task = TaskFrom(text);
    const int m = task.problem.mechanism;
    Subject& subject = subjects->try_emplace(m, suite.mechanisms[m]).first->second;
    const Problem problem =
        MakeProblem(&subject, suite.blocks[task.problem.block], SeedOfProblem(suite, task.problem));
    for (const SolverEntry solver : task.solvers) {
      emit(ToLine(SolveProblem(suite, task.problem, problem, &subject, solver)));
    }
  };
}

std::vector<Result> RunComparison(const Suite& suite, const std::vector<SolverEntry>& solvers,
                                  const Spread& spread, Journal* journal,
                                  const std::function<void(size_t done)>& progress) {
  Ledger ledger(suite, solvers, journal);
  Coordinator coordinator;
  coordinator.answer = [&](size_t task, const std::string& line) {
    const std::optional<Result> result = ResultFromLine(line);
    if (!result) throw std::logic_error("a worker answered what is not a result: " + line);
    ledger.Add(task, *result);
    progress(ledger.done());
  };
  coordinator.lost = [&](size_t task, const std::string& reason) {
    return ledger.RecordLost(task, reason);
  };
  spread(ledger.Tasks(), coordinator);
  return std::move(ledger).Sorted();
}

}  // namespace vmech
