#include "vmech/comparison/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace vmech {
namespace {

constexpr std::string_view kVerdicts[] = {
    "solved", "unreachable", "local minimum", "saddle",          "biased",
    "lost",   "jumped",      "infeasible",    "iteration limit", "stalled",
    "failed", "unsuitable",  "unavailable",   "not posed"};
constexpr std::string_view kBranches[] = {"unknown", "own", "other", "free"};

template <typename Enum, size_t n>
Enum FromName(std::string_view name, const std::string_view (&names)[n]) {
  const auto found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names)) {
    throw std::invalid_argument(fmt::format("'{}' is no verdict or branch", name));
  }
  return static_cast<Enum>(found - std::begin(names));
}

}  // namespace

std::string_view NameOf(Verdict verdict) {
  return kVerdicts[static_cast<int>(verdict)];
}

std::string_view NameOf(Branch branch) {
  return kBranches[static_cast<int>(branch)];
}

Verdict VerdictFromName(std::string_view name) {
  return FromName<Verdict>(name, kVerdicts);
}

Branch BranchFromName(std::string_view name) {
  return FromName<Branch>(name, kBranches);
}

bool Succeeded(const Result& result, TargetKind kind) {
  return result.verdict ==
         (kind == TargetKind::kUnreachable ? Verdict::kUnreachable : Verdict::kSolved);
}

bool Counts(const Result& result) {
  return result.verdict != Verdict::kNotPosed && result.verdict != Verdict::kUnavailable;
}

}  // namespace vmech
