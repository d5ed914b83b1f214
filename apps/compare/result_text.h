#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/comparison/result.h"

namespace vmech {

/// A result as one line of JSON, without the end of line, and back. Numbers read back to the same
/// double; one that is not finite becomes null and NaN.
std::string ToLine(const Result& result);
/// Nothing if the line is not a result.
std::optional<Result> ResultFromLine(std::string_view line);

/// results.csv: one row per problem and solver, in the order of `results`. SI units; the names are
/// those of docs/compare.md.
std::string ResultsTable(const Suite& suite, const std::vector<Result>& results);

}  // namespace vmech
