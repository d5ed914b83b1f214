#include "hand_path.h"

#include <stdexcept>

#include "benchmark_studies.h"
#include "vmech/kinematics/loops/assembly.h"

namespace vmech {

HandPath::HandPath(const Mechanism& mechanism, const Grasp& grasp, double step, int ticks,
                   double pull)
    : tree_(BuildKinematicTree(mechanism)), start_(StartCoordinates(tree_)) {
  const int link = grasp.link;
  grasp_ = {tree_.NodeOfLink(link), tree_.X_node_link(link) * grasp.X_LG, grasp.kind};
  InverseKinematics problem = Problem();
  AssemblyOptions driven;
  driven.fixed = {0};
  VectorXd q = start_;
  for (int i = 0; i < ticks; ++i, q[0] += step) {
    if (!Assemble(tree_, driven, &q).closed) throw std::runtime_error("the path is not reachable");
    if (i == 0) start_ = q;
    targets_.push_back(problem.GraspPose(q));
    targets_.back().p.y() += pull;
  }
}

const Posed& HandPath::Next() {
  const int last = static_cast<int>(targets_.size()) - 1;
  if (next_ + direction_ < 0 || next_ + direction_ > last) direction_ = -direction_;
  next_ += direction_;
  return targets_[next_];
}

HandPath SliderCrankPath(double pull) {
  constexpr double kStep = 2 * 3.14159265358979323846 / 1000;
  const Mechanism mechanism = SliderCrankStudy(1).mechanism;
  return {mechanism, mechanism.grasps[0], kStep, 200, pull};
}

HandPath WindowPath(int windows) {
  const Mechanism mechanism = WindowStudy(windows, 1).mechanism;
  Grasp grasp;
  grasp.link = static_cast<int>(mechanism.links.size()) - 1;
  return {mechanism, grasp, 6e-3, 50};
}

}  // namespace vmech
