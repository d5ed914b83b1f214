#include "vmech/comparison/suite.h"

namespace vmech {

std::string_view NameOf(TargetKind kind) {
  constexpr std::string_view kNames[] = {"reachable", "unreachable", "singular", "dead_centre",
                                         "tracking"};
  return kNames[static_cast<int>(kind)];
}

std::string_view NameOf(StartKind start) {
  return start == StartKind::kNear ? "near" : "far";
}

std::vector<ProblemId> ProblemsOf(const Suite& suite) {
  std::vector<ProblemId> problems;
  for (size_t m = 0; m < suite.mechanisms.size(); ++m) {
    for (const int block : suite.mechanisms[m].blocks) {
      for (int index = 0; index < suite.blocks[block].count; ++index) {
        problems.push_back({static_cast<int>(m), block, index});
      }
    }
  }
  return problems;
}

}  // namespace vmech
