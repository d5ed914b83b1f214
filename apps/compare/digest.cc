#include "vmech/apps/compare/digest.h"

#include <fstream>
#include <vector>

namespace vmech {

uint64_t DigestOf(std::string_view text, uint64_t before) {
  uint64_t digest = before;
  for (const char c : text) {
    digest = (digest ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  }
  return digest;
}

uint64_t DigestOfThisProgram() {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  if (!program) return 0;
  uint64_t digest = DigestOf("");
  std::vector<char> block(1 << 16);
  while (program.read(block.data(), static_cast<std::streamsize>(block.size())),
         program.gcount() > 0) {
    digest = DigestOf({block.data(), static_cast<size_t>(program.gcount())}, digest);
  }
  return digest;
}

}  // namespace vmech
