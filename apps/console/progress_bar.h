#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace vmech {

/// A line on a terminal that says how far a long job is. Says nothing if the job is over within a
/// second, if standard error is not a terminal, or if it is told to be quiet.
class ProgressBar {
 public:
  ProgressBar(std::string what, size_t total, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  size_t total_;
  bool active_;
  bool shown_ = false;
  Clock::time_point start_, last_;
};

}  // namespace vmech
