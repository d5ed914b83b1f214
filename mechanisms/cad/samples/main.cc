// Writes the sample assemblies as STEP files: cad_samples DIR

#include <cstdio>
#include <exception>
#include <filesystem>

#include "samples.h"

namespace {

using vmech::samples::StepWriter;

void Write(void (*build)(StepWriter*), const std::filesystem::path& path) {
  StepWriter step;
  build(&step);
  step.Write(path);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: cad_samples DIR\n");
    return 1;
  }
  const std::filesystem::path folder = argv[1];
  try {
    std::filesystem::create_directories(folder);
    Write(vmech::samples::BuildSliderCrank, folder / "slider-crank.step");
    Write(vmech::samples::BuildFourBar, folder / "four-bar.step");
    Write(vmech::samples::BuildRssr, folder / "rssr.step");
    Write(vmech::samples::BuildArm, folder / "arm.step");
    Write(vmech::samples::BuildDoor, folder / "door.step");
    Write(vmech::samples::BuildPump, folder / "pump.step");
    Write(vmech::samples::BuildLinkage, folder / "linkage.step");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cad_samples: %s\n", error.what());
    return 2;
  }
  return 0;
}
