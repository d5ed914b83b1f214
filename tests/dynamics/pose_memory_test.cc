#include "vmech/dynamics/pose_memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "vmech/dynamics/load_study.h"

namespace vmech {
namespace {

TEST(PoseMemory, GivesPiecesThatDoNotOverlap) {
  PoseMemory memory(PoseMemory::Rounded(24) + PoseMemory::Rounded(8));
  auto* a = static_cast<std::byte*>(memory.Take(24));
  auto* b = static_cast<std::byte*>(memory.Take(8));
  EXPECT_GE(std::abs(b - a), 24);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(b) % 16, 0u);
}

TEST(PoseMemory, GivesMoreThanItWasMadeFor) {
  PoseMemory memory(16);
  memory.Take(16);
  auto* more = static_cast<double*>(memory.Take(1000 * sizeof(double)));
  for (int i = 0; i < 1000; ++i) more[i] = i;
  EXPECT_EQ(more[999], 999);
}

TEST(PoseLoads, CopyOutlivesTheResultItIsTakenFrom) {
  std::optional<PoseMemory> memory(PoseLoads::Size(1, 2, 3));
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
