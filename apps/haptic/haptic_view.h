#pragma once

#include <memory>

#include "vmech/apps/view/live_design.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/variation/varied_tick.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// What a page may change of a session.
struct LiveVariation {
  VariedTick* tick = nullptr;  ///< null: nothing
  std::unique_ptr<LiveDesign> design;
};

/// A page that shows a running session: the hand, the mechanism, the wrenches and the figures of
/// the loop. It is served by threads of its own while this lives; the loop never waits for them.
class HapticView {
 public:
  /// Keeps references. @throws std::runtime_error if the page cannot be served.
  HapticView(const KinematicTree& tree, Runner* runner, LiveVariation variation = {});
  ~HapticView();

  std::string url() const;

 private:
  class Subject;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vmech
