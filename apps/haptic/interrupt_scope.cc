#include "vmech/apps/haptic/interrupt_scope.h"

#include <csignal>

namespace vmech {
namespace {

std::atomic<Runner*> runner_to_stop = nullptr;
std::atomic<std::atomic<bool>*> flag_to_set = nullptr;

void Interrupt(int) {
  if (Runner* runner = runner_to_stop) runner->Stop();
  if (std::atomic<bool>* flag = flag_to_set) *flag = true;
}

void Listen(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace

InterruptScope::InterruptScope(Runner* runner) {
  runner_to_stop = runner;
  Listen(Interrupt);
}

InterruptScope::InterruptScope(std::atomic<bool>* flag) {
  flag_to_set = flag;
  Listen(Interrupt);
}

InterruptScope::~InterruptScope() {
  Listen(SIG_DFL);
  runner_to_stop = nullptr;
  flag_to_set = nullptr;
}

}  // namespace vmech
