#include "vmech/apps/files/output_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public testing::Test {
 protected:
  static std::string Read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static int Entries(const fs::path& folder) {
    return static_cast<int>(std::distance(fs::directory_iterator(folder), {}));
  }

  const TempFolder temp_;
  const fs::path base_ = temp_.path();
};

TEST_F(OutputFolderTest, FilesAppearTogetherAtCommit) {
  OutputFolder folder(base_ / "a" / "b");
  folder.Write("one.csv", "1\n");
  folder.Write("two.csv", "2\n");
  EXPECT_FALSE(fs::exists(folder.path() / "one.csv"));
  folder.Commit();
  EXPECT_EQ(Read(folder.path() / "one.csv"), "1\n");
  EXPECT_EQ(Read(folder.path() / "two.csv"), "2\n");
  EXPECT_EQ(Entries(folder.path()), 2);
}

TEST_F(OutputFolderTest, WithoutCommitTheOldResultStays) {
  {
    OutputFolder folder(base_);
    folder.Write("one.csv", "old");
    folder.Commit();
  }
  { OutputFolder(base_).Write("one.csv", "new"); }
  EXPECT_EQ(Read(base_ / "one.csv"), "old");
  EXPECT_EQ(Entries(base_), 1);
}

TEST_F(OutputFolderTest, WithoutCommitAFolderMadeForItGoesAgain) {
  { OutputFolder(base_ / "new").Write("one.csv", "1"); }
  EXPECT_FALSE(fs::exists(base_ / "new"));
}

TEST_F(OutputFolderTest, NameOfAFolderIsRefusedBeforeAnythingChanges) {
  fs::create_directories(base_ / "two.csv");
  {
    OutputFolder folder(base_);
    folder.Write("one.csv", "1");
    EXPECT_THROW(folder.Write("two.csv", "2"), FileErrors);
  }
  EXPECT_FALSE(fs::exists(base_ / "one.csv"));
  EXPECT_EQ(Entries(base_), 1);
}

TEST_F(OutputFolderTest, FileInTheWayIsRefusedByName) {
  std::ofstream(base_ / "file") << "x";
  try {
    OutputFolder folder(base_ / "file");
    FAIL() << "a file was taken for a folder";
  } catch (const FileErrors& errors) {
    EXPECT_NE(std::string(errors.what()).find((base_ / "file").string()), std::string::npos);
  }
}

}  // namespace
}  // namespace vmech
