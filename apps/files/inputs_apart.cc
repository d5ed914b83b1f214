#include "vmech/apps/files/inputs_apart.h"

#include <fmt/format.h>

#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

/// Files that are not there yet are compared by their paths.
bool AreOneFile(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  const auto place = [](const fs::path& file) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(file), ignored);
  };
  return place(a) == place(b);
}

}  // namespace

void RequireOutputsApart(const std::vector<fs::path>& inputs,
                         const std::vector<fs::path>& outputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    for (const fs::path& input : inputs) {
      if (!AreOneFile(input, outputs[i])) continue;
      throw FileErrors(outputs[i].string(),
                       fmt::format("would be written over {}, which is read; give another file",
                                   input == outputs[i] ? "itself" : input.string()));
    }
    for (size_t j = 0; j < i; ++j) {
      if (!AreOneFile(outputs[j], outputs[i])) continue;
      throw FileErrors(outputs[i].string(), "would be written twice; give two files");
    }
  }
}

}  // namespace vmech
