#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "handles.h"
#include "vmech/base/nonblocking.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/validity.h"

struct vmech_tick : HandleState {
  std::unique_ptr<const vmech::KinematicTree> tree;
  std::unique_ptr<vmech::CoupledTick> tick;
  vmech::TickInput input;
  std::vector<double> channels;
};

namespace vmech::c {
namespace {

double OrUnlimited(double limit) {
  return limit == 0 ? std::numeric_limits<double>::infinity() : limit;
}

CoupledTickOptions OptionsOf(const vmech_tick_options& given) {
  CoupledTickOptions options;
  options.coupling.stiffness = Eigen::Map<const Vector6d>(given.stiffness);
  options.coupling.damping = Eigen::Map<const Vector6d>(given.damping);
  options.coupling.max_force = OrUnlimited(given.max_force);
  options.coupling.max_moment = OrUnlimited(given.max_moment);
  options.scale = given.scale == 0 ? 1 : given.scale;
  options.smoothing = 2 * given.period;
  return options;
}

void Start(const Mechanism& mechanism, const vmech_tick_options& options, vmech_tick* tick) {
  RequireValid(mechanism);
  RequireIndex("options.grasp", options.grasp, mechanism.grasps.size());
  tick->tree = std::make_unique<const KinematicTree>(
      BuildKinematicTree(RequireAssembled(mechanism).mechanism, KeepPassiveJoints(mechanism)));
  tick->tick =
      std::make_unique<CoupledTick>(*tick->tree, options.grasp, StartCoordinates(*tick->tree),
                                    options.period, OptionsOf(options));
  tick->channels.resize(tick->tick->ChannelNames().size());
  tick->input.fresh = true;
  tick->input.elapsed = options.period;
}

vmech_status Step(vmech_tick* tick, const vmech_pose& hand,
                  double* wrench) noexcept VMECH_NONBLOCKING {
  tick->input.X_WH = PoseOf(hand);
  const TickOutput out = tick->tick->Step(tick->input, tick->channels);
  const bool sound = out.status != TickStatus::kFailed;
  for (int i = 0; i < 6; ++i) wrench[i] = sound ? out.F_Ho_W[i] : 0;
  return sound ? VMECH_OK : VMECH_NO_SOLUTION;
}

}  // namespace
}  // namespace vmech::c

using namespace vmech::c;

vmech_tick* vmech_tick_new(const vmech_mechanism* mechanism, const vmech_tick_options* options) {
  return Make<vmech_tick>(
      [&](vmech_tick* tick) { Start(Sound(mechanism).mechanism, Read("options", options), tick); });
}

void vmech_tick_free(vmech_tick* tick) {
  delete tick;
}

vmech_status vmech_tick_status(const vmech_tick* tick) {
  return StatusOf(tick);
}

const char* vmech_tick_message(const vmech_tick* tick) {
  return MessageOf(tick);
}

vmech_status vmech_tick_step(vmech_tick* tick, const vmech_pose* hand, double wrench[6]) {
  const vmech_status status = StatusOf(tick);
  if (status == VMECH_OK && hand != nullptr && wrench != nullptr) return Step(tick, *hand, wrench);
  return status == VMECH_OK ? VMECH_INVALID : status;
}

vmech_status vmech_tick_grasp(const vmech_tick* tick, vmech_pose* pose) {
  const vmech_status status = StatusOf(tick);
  if (status != VMECH_OK || pose == nullptr) return status == VMECH_OK ? VMECH_INVALID : status;
  const vmech::Posed X_WG = tick->tick->GraspFrame();
  for (int i = 0; i < 3; ++i) {
    pose->position[i] = X_WG.p[i];
    for (int k = 0; k < 3; ++k) pose->rotation[3 * i + k] = X_WG.R(i, k);
  }
  return VMECH_OK;
}

vmech_status vmech_tick_wrenches(const vmech_tick* tick, double* wrenches, size_t count) {
  const vmech_status status = StatusOf(tick);
  if (status != VMECH_OK) return status;
  const std::vector<vmech::Wrenchd>& joints = tick->tick->dynamics().joints();
  if (wrenches == nullptr || count < joints.size()) return VMECH_INVALID;
  for (size_t j = 0; j < joints.size(); ++j) {
    Eigen::Map<vmech::Vector6d>(wrenches + 6 * j) = joints[j].Stacked();
  }
  return VMECH_OK;
}
