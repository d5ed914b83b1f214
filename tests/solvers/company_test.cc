// How back ends behave towards the program they run in: in several threads, and silently.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "textbook_problems.h"
#include "vmech/solvers/backend.h"

namespace vmech::company_test {
namespace {

using textbook::TextbookProblem;
using textbook::TextbookProblems;

std::vector<Summary> SolveEveryProblem(Backend backend) {
  std::vector<Summary> summaries;
  for (const TextbookProblem& known : TextbookProblems()) {
    const auto problem = known.make();
    summaries.push_back(Solve(backend, *problem, StoppingRule{}, known.start));
  }
  for (const TextbookProblem& impossible : textbook::InfeasibleProblems()) {
    const auto problem = impossible.make();
    summaries.push_back(Solve(backend, *problem, StoppingRule{}, impossible.start));
  }
  return summaries;
}

class EveryBackendInCompany : public ::testing::TestWithParam<Backend> {};

INSTANTIATE_TEST_SUITE_P(All, EveryBackendInCompany, ::testing::ValuesIn(kAllBackends),
                         [](const auto& info) { return std::string(NameOf(info.param)); });

TEST_P(EveryBackendInCompany, FindsTheSameInSeveralThreadsAtOnce) {
  const std::vector<Summary> alone = SolveEveryProblem(GetParam());
  std::vector<std::vector<Summary>> together(4);
  std::vector<std::thread> threads;
  for (auto& summaries : together) {
    threads.emplace_back([&] { summaries = SolveEveryProblem(GetParam()); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<Summary>& summaries : together) {
    ASSERT_EQ(summaries.size(), alone.size());
    for (size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(summaries[i].x, alone[i].x) << alone[i].FullReport();
      EXPECT_EQ(summaries[i].status, alone[i].status);
      EXPECT_EQ(summaries[i].evaluations, alone[i].evaluations);
    }
  }
}

/// What is written to a file descriptor from construction until Text().
class Captured {
 public:
  explicit Captured(int descriptor) : descriptor_(descriptor), file_(std::tmpfile()) {
    std::fflush(nullptr);
    saved_ = dup(descriptor);
    dup2(fileno(file_), descriptor);
  }
  ~Captured() {
    Restore();
    std::fclose(file_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::string Text() {
    Restore();
    std::rewind(file_);
    std::string text;
    for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) text += static_cast<char>(c);
    return text;
  }

 private:
  void Restore() {
    if (saved_ < 0) return;
    std::fflush(nullptr);
    dup2(saved_, descriptor_);
    close(saved_);
    saved_ = -1;
  }

  int descriptor_, saved_ = -1;
  std::FILE* file_;
};

TEST_P(EveryBackendInCompany, WritesNothing) {
  Captured out(STDOUT_FILENO), error(STDERR_FILENO);
  SolveEveryProblem(GetParam());
  EXPECT_EQ(error.Text(), "");
  EXPECT_EQ(out.Text(), "");
}

TEST(Captured, HoldsWhatIsWritten) {
  Captured error(STDERR_FILENO);
  std::fputs("a word", stderr);
  EXPECT_EQ(error.Text(), "a word");
}

}  // namespace
}  // namespace vmech::company_test
