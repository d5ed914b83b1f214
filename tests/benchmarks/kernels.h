#pragma once

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

namespace vmech {

/// A piece of work by name. The map's functions do the set-up and return the work proper.
using Kernels = std::map<std::string, std::function<std::function<void()>()>>;

/// The main function of a program `PROGRAM KERNEL TIMES`: sets the kernel up and runs it so many
/// times. Two runs with different TIMES tell what one call costs, set-up excluded; this is how
/// instruction_counts.py measures.
inline int RunKernel(const Kernels& kernels, int argc, char** argv) {
  const auto kernel = argc == 3 ? kernels.find(argv[1]) : kernels.end();
  if (kernel == kernels.end()) {
    std::fprintf(stderr, "usage: %s KERNEL TIMES, with KERNEL one of:\n", argv[0]);
    for (const auto& [name, set_up] : kernels) std::fprintf(stderr, "  %s\n", name.c_str());
    return EXIT_FAILURE;
  }
  const std::function<void()> work = kernel->second();
  for (int times = std::atoi(argv[2]); times > 0; --times) work();
  return EXIT_SUCCESS;
}

}  // namespace vmech
