#include "vmech/apps/compare/journal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "support/temp_folder.h"
#include "vmech/apps/compare/result_text.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr Journal::Origin kOrigin{17, 4, "1.2.3"};

Suite SmallSuite() {
  Suite suite;
  suite.blocks = {TargetBlock{}};
  suite.blocks[0].count = 5;
  suite.mechanisms.resize(1);
  return suite;
}

Result ResultOf(int index) {
  Result result;
  result.problem = {0, 0, index};
  result.verdict = Verdict::kLocalMinimum;
  result.message = "a \"quoted\" word, a comma";
  result.time = 1.0 / 3;
  result.e2 = std::numeric_limits<double>::quiet_NaN();
  return result;
}

class JournalFile : public testing::Test {
 protected:
  std::string Text() const {
    std::ostringstream text;
    text << std::ifstream(folder_ / Journal::kFileName).rdbuf();
    return text.str();
  }
  void Append(const std::string& text) const {
    std::ofstream(folder_ / Journal::kFileName, std::ios::app) << text;
  }
  std::string Refusal(const Journal::Origin& origin) const {
    try {
      Journal journal(folder_.path(), origin, SmallSuite());
    } catch (const FileErrors& error) {
      return error.what();
    }
    return "";
  }

  TempFolder folder_;
};

TEST_F(JournalFile, GivesBackWhatWasPutIn) {
  {
    Journal journal(folder_.path(), kOrigin, SmallSuite());
    EXPECT_TRUE(journal.found().empty());
    journal.Append(ResultOf(0));
    journal.Append(ResultOf(3));
  }
  const Journal journal(folder_.path(), kOrigin, SmallSuite());
  ASSERT_EQ(journal.found().size(), 2u);
  const Result& back = journal.found()[1];
  EXPECT_EQ(back.problem, (ProblemId{0, 0, 3}));
  EXPECT_EQ(back.verdict, Verdict::kLocalMinimum);
  EXPECT_EQ(back.message, ResultOf(3).message);
  EXPECT_EQ(back.time, 1.0 / 3);
  EXPECT_TRUE(std::isnan(back.e2));
}

TEST_F(JournalFile, PassesOverALineThatWasCutOffWhereverThatWas) {
  {
    Journal journal(folder_.path(), kOrigin, SmallSuite());
    journal.Append(ResultOf(0));
  }
  const std::string whole = Text(), line = ToLine(ResultOf(1)) + "\n";
  for (size_t length = 0; length < line.size(); length += 7) {
    std::ofstream(folder_ / Journal::kFileName) << whole;
    Append(line.substr(0, length));
    Journal journal(folder_.path(), kOrigin, SmallSuite());
    EXPECT_EQ(journal.found().size(), 1u);
    journal.Append(ResultOf(1));
    EXPECT_EQ(Text(), whole + line);
  }
}

TEST_F(JournalFile, BeginsAnewWhereEvenTheFirstLineWasCutOff) {
  { const Journal journal(folder_.path(), kOrigin, SmallSuite()); }
  const std::string header = Text();
  std::ofstream(folder_ / Journal::kFileName) << header.substr(0, 9);
  { const Journal journal(folder_.path(), kOrigin, SmallSuite()); }
  EXPECT_EQ(Text(), header);
}

TEST_F(JournalFile, RefusesAnotherSuiteAndAnotherBuild) {
  { const Journal journal(folder_.path(), kOrigin, SmallSuite()); }
  EXPECT_NE(Refusal({18, 4, "1.2.3"}).find("rows of another suite"), std::string::npos);
  EXPECT_NE(Refusal({17, 5, "1.2.3"}).find("another build of vmech"), std::string::npos);
  EXPECT_NE(Refusal({17, 4, "1.2.4"}).find("another build of vmech, version 1.2.3"),
            std::string::npos);
  EXPECT_EQ(Refusal(kOrigin), "");
}

TEST_F(JournalFile, RefusesWhatItCannotHaveWritten) {
  { const Journal journal(folder_.path(), kOrigin, SmallSuite()); }
  Append(ToLine(ResultOf(5)) + "\n");  // the block has five problems, from 0
  EXPECT_NE(Refusal(kOrigin).find("line 2 is damaged"), std::string::npos);
  std::ofstream(folder_ / Journal::kFileName) << "something else\n";
  EXPECT_NE(Refusal(kOrigin).find("is not a file of vmech's"), std::string::npos);
}

TEST_F(JournalFile, LetsOnlyOneWrite) {
  const Journal first(folder_.path(), kOrigin, SmallSuite());
  EXPECT_NE(Refusal(kOrigin).find("another vmech is writing here"), std::string::npos);
}

}  // namespace
}  // namespace vmech
