#include "vmech/apps/compare/comparison_report.h"

#include <gtest/gtest.h>

#include "vmech/apps/compare/report_sections.h"
#include "vmech/apps/compare/result_text.h"

namespace vmech {
namespace {

Suite SmallSuite() {
  Suite suite;
  suite.name = "trial <of> names & signs";
  suite.blocks.resize(2);
  suite.blocks[0].name = "near";
  suite.blocks[0].count = 2;
  suite.blocks[1].name = "path";
  suite.blocks[1].kind = TargetKind::kTracking;
  suite.mechanisms.resize(1);
  suite.mechanisms[0].name = "four-bar";
  suite.mechanisms[0].blocks = {0, 1};
  return suite;
}

Result Of(ProblemId problem, Backend solver, Verdict verdict, const std::string& message) {
  Result result;
  result.problem = problem;
  result.solver = SolverEntry(solver);
  result.verdict = verdict;
  result.message = message;
  result.time = 1e-5;
  result.evaluations = 4;
  return result;
}

std::vector<Result> SmallResults() {
  std::vector<Result> results = {
      Of({0, 0, 0}, Backend::kPenalty, Verdict::kSolved, "the target is reached"),
      Of({0, 0, 0}, Backend::kIpopt, Verdict::kSolved, "the target is reached"),
      Of({0, 0, 1}, Backend::kPenalty, Verdict::kStalled, "gave <up>, \"tired\""),
      Of({0, 0, 1}, Backend::kIpopt, Verdict::kFailed, "its process was ended by signal 11"),
      Of({0, 1, 0}, Backend::kPenalty, Verdict::kJumped, "40 of 40 targets reached, 2 jumps"),
      Of({0, 1, 0}, Backend::kIpopt, Verdict::kSolved, "all"),
  };
  for (size_t i = 4; i < 6; ++i) results[i].targets = results[i].reached = 40;
  results[4].jumps = 2;
  return results;
}

std::string Page() {
  return RenderComparisonReport(SmallSuite(), SmallResults(), "1.2.3");
}

bool Has(const std::string& page, const std::string& words) {
  return page.find(words) != page.npos;
}

TEST(ComparisonReport, ListsEveryFailureWithItsReason) {
  const std::string page = Page();
  EXPECT_TRUE(Has(page, "gave &lt;up&gt;, &quot;tired&quot;"));
  EXPECT_TRUE(Has(page, "its process was ended by signal 11"));
  EXPECT_TRUE(Has(page, "40 of 40 targets reached, 2 jumps"));
  EXPECT_TRUE(Has(page, "penalty: 2 failures"));
  EXPECT_TRUE(Has(page, "ipopt: 1 failures"));
}

TEST(ComparisonReport, NamesTheProblemsThatNobodySolved) {
  EXPECT_TRUE(Has(Page(), "<td>four-bar</td><td>near</td><td class=\"number\">1</td><td>2</td>"));
}

TEST(ComparisonReport, ShowsSharesBranchesAndJumps) {
  const std::string page = Page();
  EXPECT_TRUE(Has(page, "50.0 %"));
  EXPECT_TRUE(Has(page, "<strong>100 %</strong>"));
  EXPECT_TRUE(Has(page, "100 %, 2 jumps"));
}

TEST(ComparisonReport, EscapesNamesAndGivesTheSameBytes) {
  EXPECT_TRUE(Has(Page(), "trial &lt;of&gt; names &amp; signs"));
  EXPECT_EQ(Page(), Page());
}

TEST(ComparisonReport, HasSomethingToSayOfNoResultsAtAll) {
  Suite suite = SmallSuite();
  EXPECT_TRUE(Has(RenderComparisonReport(suite, {}, "1"), "Every problem was solved"));
}

TEST(Percent, CallsNothingAHundredPercentThatIsNot) {
  EXPECT_EQ(Percent(3, 3), "100 %");
  EXPECT_EQ(Percent(99999, 100000), "99.9 %");
  EXPECT_EQ(Percent(0, 7), "0.0 %");
}

TEST(ResultsTable, QuotesMessagesAndCountsFromOne) {
  const std::string table = ResultsTable(SmallSuite(), SmallResults());
  EXPECT_TRUE(Has(table, "\nfour-bar,near,reachable,near,2,penalty,stalled,1,0,0,0,4,0,1e-05,"));
  EXPECT_TRUE(Has(table, ",\"gave <up>, \"\"tired\"\"\"\n"));
  EXPECT_TRUE(Has(table, "\nfour-bar,path,tracking,path,1,penalty,jumped,40,40,2,"));
}

}  // namespace
}  // namespace vmech
