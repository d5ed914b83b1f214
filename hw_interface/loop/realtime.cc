#include "vmech/hw_interface/loop/realtime.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#if defined(__SSE__)
#include <xmmintrin.h>

#include "vmech/base/check_range.h"
#endif

namespace vmech {
namespace {

constexpr unsigned kFlushToZero = 0x8040;  // FTZ and DAZ of MXCSR

/// Touches the stack that a loop may need, so that its first use is no page fault.
void PrefaultStack() noexcept {
  constexpr int kBytes = 256 * 1024, kPage = 4096;
  volatile char stack[kBytes];
  for (int i = 0; i < kBytes; i += kPage) stack[i] = 0;
  (void)stack[0];
}

bool IsRealtimeKernel() {
  std::ifstream file("/sys/kernel/realtime");
  int value = 0;
  return file >> value && value == 1;
}

}  // namespace

unsigned SetFlushToZero() noexcept {
#if defined(__SSE__)
  const unsigned mode = _mm_getcsr();
  _mm_setcsr(mode | kFlushToZero);
  return mode;
#else
  return 0;
#endif
}

void RestoreFloatingPoint([[maybe_unused]] unsigned mode) noexcept {
#if defined(__SSE__)
  _mm_setcsr(mode);
#endif
}

void RealtimeOptions::Validate() const {
  CheckRange("RealtimeOptions", "priority", priority, 0, 99);
}

std::string RealtimeReport::BriefReport() const {
  std::string text = fmt::format(
      "{}, memory {}locked, {} kernel, {}flush to zero", fifo ? "SCHED_FIFO" : "usual scheduling",
      memory_locked ? "" : "not ", preempt_rt ? "real-time" : "usual", flush_to_zero ? "" : "no ");
  for (const std::string& what : refused) text += "; " + what;
  return text;
}

RealtimeScope::RealtimeScope(const RealtimeOptions& options) {
  options.Validate();
  if (options.lock_memory) LockMemory();
  PrefaultStack();
  pthread_getschedparam(pthread_self(), &old_policy_, &old_parameter_);
  if (options.priority > 0) Schedule(options.priority);
  report_.preempt_rt = IsRealtimeKernel();
  old_mode_ = SetFlushToZero();
#if defined(__SSE__)
  report_.flush_to_zero = true;
#endif
}

RealtimeScope::~RealtimeScope() {
  RestoreFloatingPoint(old_mode_);
  if (report_.fifo) pthread_setschedparam(pthread_self(), old_policy_, &old_parameter_);
  if (report_.memory_locked) munlockall();
}

void RealtimeScope::LockMemory() {
  report_.memory_locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  if (report_.memory_locked) return;
  report_.refused.push_back(fmt::format(
      "memory could not be locked ({}): raise 'memlock' in limits.conf", std::strerror(errno)));
}

void RealtimeScope::Schedule(int priority) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  report_.fifo = error == 0;
  if (report_.fifo) return;
  report_.refused.push_back(
      fmt::format("SCHED_FIFO {} was refused ({}): raise 'rtprio' in limits.conf", priority,
                  std::strerror(error)));
}

}  // namespace vmech
