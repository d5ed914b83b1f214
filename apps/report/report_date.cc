#include "vmech/apps/report/report_date.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <string_view>

namespace vmech {
namespace {

constexpr int64_t kLastSecond = 253402300799;  // of the year 9999

std::time_t SecondsOf(std::string_view text) {
  int64_t seconds = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || seconds < 0 || seconds > kLastSecond) {
    throw std::invalid_argument(
        fmt::format("SOURCE_DATE_EPOCH is '{}'; it must be seconds since 1970, as 1700000000, or "
                    "not be set",
                    text));
  }
  return static_cast<std::time_t>(seconds);
}

}  // namespace

std::string ReportDate() {
  const char* given = std::getenv("SOURCE_DATE_EPOCH");  // NOLINT(concurrency-mt-unsafe)
  const std::time_t seconds = given != nullptr ? SecondsOf(given) : std::time(nullptr);
  std::tm day{};
  gmtime_r(&seconds, &day);
  return fmt::format("{:04}-{:02}-{:02}", day.tm_year + 1900, day.tm_mon + 1, day.tm_mday);
}

}  // namespace vmech
