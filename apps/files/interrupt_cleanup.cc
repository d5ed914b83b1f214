#include "vmech/apps/files/interrupt_cleanup.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace vmech {
namespace {

constexpr int kInterrupts[] = {SIGINT, SIGTERM, SIGHUP};

std::atomic<const InterruptCleanup*> active{nullptr};

void OnInterrupt(int signal) {
  if (const InterruptCleanup* cleanup = active) cleanup->Run();
  raise(signal);  // whose action is the default again
}

/// What is ignored (nohup) stays ignored.
void SetAction(void (*action)(int)) {
  for (const int signal : kInterrupts) {
    struct sigaction now = {};
    if (sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
    now = {};
    now.sa_handler = action;
    now.sa_flags = SA_RESETHAND | SA_NODEFER;
    sigaction(signal, &now, nullptr);
  }
}

void Mask(int how) {
  sigset_t interrupts;
  sigemptyset(&interrupts);
  for (const int signal : kInterrupts) sigaddset(&interrupts, signal);
  pthread_sigmask(how, &interrupts, nullptr);
}

}  // namespace

InterruptCleanup::InterruptCleanup(const std::vector<std::filesystem::path>& files,
                                   const std::vector<std::filesystem::path>& folders)
    : files_(files.begin(), files.end()),
      folders_(folders.begin(), folders.end()),
      owner_(getpid()) {
  active = this;
  SetAction(OnInterrupt);
}

InterruptCleanup::~InterruptCleanup() {
  SetAction(SIG_DFL);
  active = nullptr;
}

void InterruptCleanup::Run() const noexcept {
  if (getpid() != owner_) return;  // a child, which has the action but not the files
  for (const std::string& file : files_) unlink(file.c_str());
  for (const std::string& folder : folders_) rmdir(folder.c_str());
}

InterruptsWait::InterruptsWait() {
  Mask(SIG_BLOCK);
}

InterruptsWait::~InterruptsWait() {
  Mask(SIG_UNBLOCK);
}

}  // namespace vmech
