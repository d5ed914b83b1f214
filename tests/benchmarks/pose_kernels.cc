#include <array>

#include "kernels.h"
#include "vmech/base/pose.h"

namespace vmech {
namespace {

/// The poses of seven links in a row, each from the one before: an arm's forward kinematics
/// without its joints.
std::function<void()> PoseChain() {
  std::array<Posed, 7> X_PL;
  for (Posed& X : X_PL) X = {Matrix3d::Identity(), Vector3d(0.1, 0.2, 0.3)};
  return [X_PL, X_WL = Posed{}]() mutable {
    for (const Posed& X : X_PL) X_WL = X_WL * X;
  };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel({{"chain", vmech::PoseChain}}, argc, argv);
}
