#pragma once

#include <valgrind/callgrind.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

namespace vmech {

/// A piece of work by name. The map's functions do the set-up and return the work proper.
using Kernels = std::map<std::string, std::function<std::function<void()>()>>;

/// The main function of a program `PROGRAM KERNEL TIMES`: sets the kernel up, calls it as often as
/// is worth to warm it, then TIMES more. Callgrind is on for these alone, and is told nothing by a
/// program that runs without it; instruction_counts.py divides what it counts by TIMES.
inline int RunKernel(const Kernels& kernels, int argc, char** argv) {
  const auto kernel = argc == 3 ? kernels.find(argv[1]) : kernels.end();
  if (kernel == kernels.end()) {
    std::fprintf(stderr, "usage: %s KERNEL TIMES, with KERNEL one of:\n", argv[0]);
    for (const auto& [name, set_up] : kernels) std::fprintf(stderr, "  %s\n", name.c_str());
    return EXIT_FAILURE;
  }
  constexpr int kWarmUp = 100;
  const std::function<void()> work = kernel->second();
  for (int times = kWarmUp; times > 0; --times) work();
  CALLGRIND_START_INSTRUMENTATION;
  for (int times = std::atoi(argv[2]); times > 0; --times) work();
  CALLGRIND_STOP_INSTRUMENTATION;
  return EXIT_SUCCESS;
}

}  // namespace vmech
