#include "vmech/apps/files/result_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <set>

#include "support/temp_folder.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStage = ".vmech-unfinished";

class ResultFolderTest : public testing::Test {
 protected:
  static std::string Read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void Put(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }
  static std::set<std::string> Names(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
    return names;
  }
  void WriteLoads(const fs::path& folder, const std::string& text) const {
    ResultFolder result(folder, ResultKind::kLoads);
    result.Write("loads.csv", text);
    result.Write("report.html", text);
    result.Commit();
  }
  static std::string Refusal(const fs::path& folder, ResultKind kind) {
    try {
      ResultFolder result(folder, kind);
    } catch (const FileErrors& errors) {
      return errors.what();
    }
    return "";
  }

  const TempFolder temp_;
  const fs::path base_ = temp_.path(), out_ = base_ / "a" / "out";
};

TEST_F(ResultFolderTest, AppearsAsAWhole) {
  {
    ResultFolder result(out_, ResultKind::kLoads);
    result.Write("loads.csv", "1");
    EXPECT_FALSE(fs::exists(out_));
    result.Commit();
    EXPECT_EQ(Names(out_), (std::set<std::string>{"loads.csv"}));
  }
  EXPECT_EQ(Names(base_ / "a"), (std::set<std::string>{"out"}));
}

TEST_F(ResultFolderTest, ReplacesTheWholeSetAndNothingElse) {
  WriteLoads(out_, "old");
  Put(out_ / "notes.txt", "mine");
  Put(out_ / "figures" / "one.svg", "drawn");
  fs::create_symlink("nowhere", out_ / "link");
  {
    ResultFolder result(out_, ResultKind::kLoads);
    result.Write("loads.csv", "new");
    result.Commit();  // without the report of the old set
  }
  EXPECT_EQ(Names(out_), (std::set<std::string>{"figures", "link", "loads.csv", "notes.txt"}));
  EXPECT_EQ(Read(out_ / "loads.csv"), "new");
  EXPECT_EQ(Read(out_ / "notes.txt"), "mine");
  EXPECT_EQ(Read(out_ / "figures" / "one.svg"), "drawn");
  EXPECT_EQ(fs::read_symlink(out_ / "link"), "nowhere");
  EXPECT_EQ(Names(base_ / "a"), (std::set<std::string>{"out"}));
}

TEST_F(ResultFolderTest, KeepsTheRightsOfTheFolder) {
  WriteLoads(out_, "old");
  fs::permissions(out_, fs::perms::owner_all | fs::perms::group_read);
  WriteLoads(out_, "new");
  EXPECT_EQ(fs::status(out_).permissions(), fs::perms::owner_all | fs::perms::group_read);
}

TEST_F(ResultFolderTest, IsReplacedWhereALinkLeads) {
  WriteLoads(base_ / "real", "old");
  fs::create_directory_symlink("real", base_ / "link");
  WriteLoads(base_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(base_ / "link"));
  EXPECT_EQ(Read(base_ / "real" / "loads.csv"), "new");
  EXPECT_EQ(Names(base_), (std::set<std::string>{"link", "real"}));
}

TEST_F(ResultFolderTest, WithoutCommitEverythingIsAsBefore) {
  { ResultFolder(out_, ResultKind::kLoads).Write("loads.csv", "1"); }
  EXPECT_FALSE(fs::exists(base_ / "a"));
  WriteLoads(out_, "old");
  Put(out_ / "notes.txt", "mine");
  { ResultFolder(out_, ResultKind::kLoads).Write("loads.csv", "new"); }
  EXPECT_EQ(Read(out_ / "loads.csv"), "old");
  EXPECT_EQ(Names(base_ / "a"), (std::set<std::string>{"out"}));
}

TEST_F(ResultFolderTest, IsForOneAtATime) {
  const std::string self = "another vmech (process " + std::to_string(getpid()) + ") is writing";
  {
    const ResultFolder first(out_, ResultKind::kLoads);
    EXPECT_NE(Refusal(out_, ResultKind::kLoads).find(out_.string() + ": " + self),
              std::string::npos);
  }
  WriteLoads(out_, "old");
  ResultFolder first(out_, ResultKind::kLoads);
  EXPECT_NE(Refusal(out_, ResultKind::kLoads).find(self), std::string::npos);
  first.Commit();
  EXPECT_NE(Refusal(out_, ResultKind::kLoads).find(self), std::string::npos);
}

TEST_F(ResultFolderTest, ReturnsWhatAKilledRunHasLeft) {
  WriteLoads(out_, "new");
  const fs::path stage = out_.string() + kStage;
  Put(stage / "loads.csv", "old");
  Put(stage / "figures" / "one.svg", "drawn");
  Put(stage / "notes.txt", "mine");
  { const ResultFolder next(out_, ResultKind::kLoads); }
  EXPECT_EQ(Names(base_ / "a"), (std::set<std::string>{"out"}));
  EXPECT_EQ(Names(out_),
            (std::set<std::string>{"figures", "loads.csv", "notes.txt", "report.html"}));
  EXPECT_EQ(Read(out_ / "loads.csv"), "new");
}

TEST_F(ResultFolderTest, LosesNoFolderThatIsThereTwice) {
  WriteLoads(out_, "new");
  Put(out_ / "figures" / "two.svg", "drawn");
  const fs::path left = fs::path(out_.string() + kStage) / "figures";
  Put(left / "one.svg", "drawn");
  EXPECT_NE(Refusal(out_, ResultKind::kLoads).find(left.string() + ": is left over"),
            std::string::npos);
  EXPECT_TRUE(fs::exists(left / "one.svg"));
}

TEST_F(ResultFolderTest, RefusesAResultOfAnotherKind) {
  WriteLoads(out_, "1");
  EXPECT_NE(Refusal(out_, ResultKind::kComparison).find("holds a result of `vmech loads`"),
            std::string::npos);
  Put(base_ / "other" / "rows.jsonl", "");
  EXPECT_NE(Refusal(base_ / "other", ResultKind::kLoads).find("`vmech compare` (rows.jsonl)"),
            std::string::npos);
}

TEST_F(ResultFolderTest, RefusesToOverwriteWhatIsNoResult) {
  Put(out_ / "report.html", "mine");
  const std::string refusal = Refusal(out_, ResultKind::kLoads);
  EXPECT_NE(refusal.find((out_ / "report.html").string() + ": would be overwritten"),
            std::string::npos);
  EXPECT_NE(refusal.find("no loads.csv beside it"), std::string::npos);
}

TEST_F(ResultFolderTest, InTheCurrentFolderIsPutInPlace) {
  WriteLoads(out_, "old");
  Put(out_ / "notes.txt", "mine");
  const fs::path before = fs::current_path();
  fs::current_path(out_);
  WriteLoads(".", "new");
  EXPECT_EQ(fs::current_path(), fs::canonical(out_));  // and not that of a folder removed
  fs::current_path(before);
  EXPECT_EQ(Read(out_ / "report.html"), "new");
  EXPECT_EQ(Names(out_), (std::set<std::string>{"loads.csv", "notes.txt", "report.html"}));
}

TEST_F(ResultFolderTest, NamesAFileInTheWay) {
  Put(base_ / "file", "x");
  EXPECT_EQ(Refusal(base_ / "file", ResultKind::kLoads),
            (base_ / "file").string() + ": is a file; give a folder with --out");
}

TEST_F(ResultFolderTest, OfAComparisonIsThereFromTheStart) {
  {
    const ResultFolder result(out_, ResultKind::kComparison);
    EXPECT_TRUE(fs::exists(out_));
  }
  EXPECT_FALSE(fs::exists(base_ / "a"));
}

}  // namespace
}  // namespace vmech
