#pragma once

#include <string>

namespace vmech {

/// The day for a report, UTC, as "2026-02-01": today, or that of the environment variable
/// SOURCE_DATE_EPOCH [seconds since 1970], with which the same input gives the same bytes on any
/// day.
/// @throws std::invalid_argument if the variable holds anything but a number of seconds.
std::string ReportDate();

}  // namespace vmech
