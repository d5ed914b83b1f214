// rewrite FOLDER FILE...: reads mechanisms and writes them into a folder, in both choices of units.

#include <filesystem>
#include <fstream>

#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/writer.h"

int main(int count, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  for (int i = 2; i < count; ++i) {
    const std::filesystem::path file = arguments[i];
    const vmech::Mechanism mechanism = vmech::ReadMechanism(file);
    std::ofstream(folder / ("si-" + file.filename().string())) << vmech::WriteMechanism(mechanism);
    std::ofstream(folder / ("mm-" + file.filename().string()))
        << vmech::WriteMechanism(mechanism, {vmech::FileUnits::kMillimetresDegrees, "In mm."});
  }
}
