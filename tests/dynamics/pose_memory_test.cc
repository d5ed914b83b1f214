#include "vmech/dynamics/loads/pose/pose_arena.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {
namespace {

TEST(PoseArena, GivesPiecesThatDoNotOverlap) {
  PoseArena memory(PoseArena::Rounded(24) + PoseArena::Rounded(8));
  auto* a = static_cast<std::byte*>(memory.Take(24));
  auto* b = static_cast<std::byte*>(memory.Take(8));
  EXPECT_GE(std::abs(b - a), 24);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(b) % 16, 0u);
}

TEST(PoseArena, GivesMoreThanItWasMadeFor) {
  PoseArena memory(16);
  memory.Take(16);
  auto* more = static_cast<double*>(memory.Take(1000 * sizeof(double)));
  for (int i = 0; i < 1000; ++i) more[i] = i;
  EXPECT_EQ(more[999], 999);
}

TEST(PoseLoads, CopyOutlivesTheResultItIsTakenFrom) {
  std::optional<PoseArena> memory(PoseLoads::Size(1, 2, 3));
  PoseLoads copy;
  {
    PoseLoads pose(&*memory);
    pose.joints.resize(2);
    pose.links.resize(3);
    pose.joints[1].force = {1, 2, 3};
    copy = pose;
    const PoseLoads second = pose;
    EXPECT_EQ(second.joints.get_allocator().memory(), nullptr);
  }
  memory.reset();
  EXPECT_EQ(copy.joints[1].force, Vector3d(1, 2, 3));
  EXPECT_EQ(copy.links.size(), 3u);
}

}  // namespace
}  // namespace vmech
