#include <gtest/gtest.h>

#include "vmech/mechanisms/cad/step/step_reader.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

TEST(StepReader, SaysWhatToInstallWhereOpenCascadeIsAbsent) {
  EXPECT_FALSE(HasStepReader());
  try {
    ReadStep("crank.step");
    FAIL() << "read without a reader";
  } catch (const FileErrors& error) {
    EXPECT_NE(std::string(error.what()).find("crank.step: vmech was built without Open CASCADE"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace vmech
