#include "vmech/dynamics/loads/load_result.h"

#include <fmt/format.h>

namespace vmech {

PoseLoads::PoseLoads(PoseArena* memory)
    : drives(PoseAllocator<DriveSample>(memory)),
      joints(PoseAllocator<JointSample>(memory)),
      links(PoseAllocator<LinkMotion>(memory)) {}

size_t PoseLoads::Size(size_t drive_count, size_t joint_count, size_t link_count) {
  return PoseArena::Rounded(drive_count * sizeof(DriveSample)) +
         PoseArena::Rounded(joint_count * sizeof(JointSample)) +
         PoseArena::Rounded(link_count * sizeof(LinkMotion));
}

std::string LoadStudyResult::BriefReport() const {
  const auto plural = [](size_t count) { return count == 1 ? "" : "s"; };
  return fmt::format(
      "{} pose{}, mobility {}, {} redundant equation{}, closure {:.1e}, power {:.1e}", poses.size(),
      plural(poses.size()), mobility, redundant_equations, plural(redundant_equations), max_closure,
      max_power_error);
}

}  // namespace vmech
