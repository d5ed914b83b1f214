#include "vmech/apps/compare/digest.h"

#include <filesystem>
#include <fstream>
#include <vector>

#include "vmech/solvers/backends/package.h"

namespace vmech {
namespace {

/// Goes on from `before`; what cannot be read has no part in it.
uint64_t DigestOfFile(const std::filesystem::path& path, uint64_t before) {
  std::ifstream file(path, std::ios::binary);
  uint64_t digest = before;
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0) {
    digest = DigestOf({block.data(), static_cast<size_t>(file.gcount())}, digest);
  }
  return digest;
}

}  // namespace

uint64_t DigestOf(std::string_view text, uint64_t before) {
  uint64_t digest = before;
  for (const char c : text) {
    digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  }
  return digest;
}

uint64_t DigestOfThisProgram() {
  uint64_t digest = DigestOfFile("/proc/self/exe", DigestOf(""));
  for (const char* package : kPackages) {
    digest = DigestOfFile(LateLibrary(package).path(), digest);
  }
  return digest;
}

}  // namespace vmech
