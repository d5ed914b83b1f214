// Whole ticks of the haptic mode, which instruction budgets watch.

#include "held_tick.h"
#include "kernels.h"

namespace vmech {
namespace {

std::function<std::function<void()>()> FullTickOf(const std::string& example) {
  return [example] {
    auto tick = std::make_shared<HeldTick>(example);
    return [tick] { tick->Full(); };
  };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  vmech::Kernels kernels;
  for (const char* example :
       {"crank", "two-link-arm", "slider-crank", "four-bar", "rssr", "bennett", "stewart-gough"}) {
    kernels[example] = vmech::FullTickOf(example);
  }
  return vmech::RunKernel(kernels, argc, argv);
}
