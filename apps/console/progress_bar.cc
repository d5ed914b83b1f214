#include "vmech/apps/console/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <tuple>
#include <utility>

namespace vmech {
namespace {

/// Not by way of stderr, where nothing that moves the cursor comes through.
void Draw(const std::string& text) {
  std::ignore = write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

ProgressBar::ProgressBar(std::string what, size_t total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      active_(!quiet && total > 0 && isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
  if (shown_) Draw("\r\033[K");
}

void ProgressBar::Show(size_t done) {
  using namespace std::chrono_literals;
  constexpr int kWidth = 40;
  const Clock::time_point now = Clock::now();
  if (!active_ || now - start_ < 1s || now - last_ < 100ms) return;
  last_ = now;
  shown_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  Draw(fmt::format("\r{} [{:<{}}] {:3.0f} %  {:.0f} s left ", what_,
                   std::string(static_cast<size_t>(share * kWidth), '#'), kWidth, 100 * share,
                   share > 0 ? elapsed * (1 - share) / share : 0.0));
}

}  // namespace vmech
