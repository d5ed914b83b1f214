#include "notebook.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temp_folder.h"

namespace vmech {
namespace {

std::string FileText(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Notebook, WritesItsResultsWithTheLineTheyCameFrom) {
  const TempFolder folder;
  std::string file = folder / "chapter.results";
  std::string program = "chapter";
  char* arguments[] = {program.data(), file.data()};
  int line = 0;
  {
    Notebook notebook(2, arguments);
    line = __LINE__ + 1;
    notebook.Print("two\nlines");
    EXPECT_EQ(notebook.ExitCode(), 0);
    notebook.Check("false claim", false);
    EXPECT_EQ(notebook.ExitCode(), 1);
    EXPECT_FALSE(std::filesystem::exists(file)) << "an unfinished chapter has results";
  }
  EXPECT_EQ(FileText(file), std::to_string(line) + " text 9\ntwo\nlines\n" +
                                std::to_string(line + 2) + " fails 11\nfalse claim\n");
}

TEST(Notebook, AValueThatIsNotANumberIsNotNear) {
  std::string program = "chapter";
  char* arguments[] = {program.data()};
  Notebook notebook(1, arguments);
  notebook.CheckNear("nothing", std::nan(""), 0, 1e300);
  EXPECT_EQ(notebook.ExitCode(), 1);
}

}  // namespace
}  // namespace vmech
