// The sanitizers bring an allocator of theirs.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/count_allocations.h"
#include "support/examples.h"
#include "support/windows.h"
#include "vmech/dynamics/simulation/equations/equations_of_motion.h"

namespace vmech {
namespace {

Simulation With(const Mechanism& mechanism) {
  Simulation simulation;
  simulation.mechanism = mechanism;
  JointMotor motor;
  motor.at = {0, 0};
  motor.force = {{0, 1}, {1, 2}, 0};
  simulation.motors = {motor};
  simulation.times = {0, 1};
  return simulation;
}

TEST(EquationsOfMotion, AllocateNothing) {
  for (const Mechanism& mechanism :
       {Example("andrews-squeezer"), Example("bricard"), Example("four-bar"), Windows(5, 0.3)}) {
    const PreparedSimulation prepared = PrepareSimulation(With(mechanism));
    EquationsOfMotion equations(prepared);
    VectorXd y = VectorXd::Zero(equations.size()), slopes = y;
    y.head(prepared.q.size()) = prepared.q;
    ASSERT_TRUE(equations.Slopes(0, y.data(), slopes.data()));
    const long before = allocations;
    for (int i = 0; i < 100; ++i) {
      y.head(prepared.q.size()) += 1e-9 * slopes.head(prepared.q.size());
      ASSERT_TRUE(equations.Slopes(1e-3 * i, y.data(), slopes.data()));
    }
    EXPECT_EQ(allocations - before, 0) << mechanism.name;
  }
}

}  // namespace
}  // namespace vmech

#endif
