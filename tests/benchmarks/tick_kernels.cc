// Whole ticks of the haptic mode, which instruction budgets watch.

#include "hw_interface/held_tick.h"
#include "kernels.h"

namespace vmech {
namespace {

std::function<std::function<void()>()> FullTickOf(const std::string& example,
                                                  Architecture architecture) {
  return [=] {
    auto tick = std::make_shared<HeldTick>(example, architecture);
    return [tick] { tick->Full(); };
  };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  vmech::Kernels kernels;
  for (const char* example :
       {"crank", "two-link-arm", "slider-crank", "four-bar", "rssr", "bennett", "stewart-gough"}) {
    kernels[example] = vmech::FullTickOf(example, vmech::Architecture::kCoupled);
    kernels[std::string(example) + "_paper"] =
        vmech::FullTickOf(example, vmech::Architecture::kPaper);
  }
  return vmech::RunKernel(kernels, argc, argv);
}
