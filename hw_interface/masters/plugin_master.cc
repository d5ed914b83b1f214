#include "vmech/hw_interface/masters/plugin_master.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace vmech {
namespace {

using ErrorText = std::array<char, 256>;

[[noreturn]] void Fail(const std::string& library, std::string_view what) {
  throw std::runtime_error(fmt::format("plug-in {}: {}", library, what));
}

HandlePhysics PhysicsOf(const vmech_plugin_physics& p) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  return {p.mass,       p.damping, p.coulomb,
          p.resolution, p.peak,    p.max_speed > 0 ? p.max_speed : kNoLimit};
}

bool IsComplete(const vmech_plugin& p) {
  return p.configure && p.activate && p.deactivate && p.recover && p.read && p.write && p.destroy;
}

IoStatus StatusOf(int result) noexcept {
  switch (result) {
    case VMECH_PLUGIN_OK:
      return IoStatus::kOk;
    case VMECH_PLUGIN_NO_NEW_DATA:
      return IoStatus::kNoNewData;
    case VMECH_PLUGIN_LINK_LOST:
      return IoStatus::kLinkLost;
    default:
      return IoStatus::kDeviceFault;
  }
}

}  // namespace

PluginMaster::PluginMaster(const std::filesystem::path& library, const std::string& parameters)
    : library_name_(library.string()), library_(dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (!library_) {
    Fail(library_name_,
         fmt::format("{}; a shared library is wanted (docs/device-plugin.md)", dlerror()));
  }
  const auto create =
      reinterpret_cast<decltype(&vmech_plugin_create)>(dlsym(library_, "vmech_plugin_create"));
  std::string problem;
  ErrorText error{};
  if (!create) {
    problem = "it has no function vmech_plugin_create; see docs/device-plugin.md";
  } else if (create(parameters.c_str(), &plugin_, error.data(), error.size()) != 0) {
    problem = fmt::format("refuses '{}': {}", parameters, error.data());
  } else if (plugin_.version != VMECH_PLUGIN_VERSION) {
    // Another version may have another table: nothing in it can be called.
    problem = fmt::format("made for version {} of plugin.h, this is {}; build it again",
                          plugin_.version, VMECH_PLUGIN_VERSION);
  } else if (!IsComplete(plugin_)) {
    problem = "its table of functions has gaps";
    if (plugin_.destroy) plugin_.destroy(plugin_.device);
  }
  if (problem.empty()) return;
  dlclose(library_);
  Fail(library_name_, problem);
}

PluginMaster::~PluginMaster() {
  Shutdown();
  plugin_.destroy(plugin_.device);
  dlclose(library_);
}

DeviceInfo PluginMaster::OnConfigure() {
  vmech_plugin_info p{};
  ErrorText error{};
  if (plugin_.configure(plugin_.device, &p, error.data(), error.size()) != 0) {
    Fail(library_name_, error.data());
  }
  p.name[sizeof p.name - 1] = 0;
  if (!(p.period > 0)) Fail(library_name_, fmt::format("states a period of {} s", p.period));
  DeviceInfo info;
  info.name = p.name;
  info.period = p.period;
  info.delay = p.delay;
  info.senses = kSensesPose | kSensesButtons | (p.senses_twist ? kSensesTwist : 0u) |
                (p.senses_gripper ? kSensesGripper : 0u) |
                (p.senses_wrench ? kSensesAppliedWrench : 0u);
  info.takes_wrench = true;
  info.has_dead_man = p.has_dead_man != 0;
  info.linear = PhysicsOf(p.linear);
  info.angular = PhysicsOf(p.angular);
  return info;
}

void PluginMaster::OnActivate() {
  ErrorText error{};
  if (plugin_.activate(plugin_.device, error.data(), error.size()) == 0) return;
  Fail(library_name_, error.data());
}

void PluginMaster::OnRecover() {
  ErrorText error{};
  if (plugin_.recover(plugin_.device, error.data(), error.size()) == 0) return;
  Fail(library_name_, error.data());
}

IoStatus PluginMaster::OnRead(std::int64_t now_ns, MasterState* state) noexcept {
  vmech_plugin_state p{};
  const IoStatus status = StatusOf(plugin_.read(plugin_.device, now_ns, &p));
  if (status != IoStatus::kOk) return status;
  *state = MasterState{};
  state->sequence = p.sequence;
  state->device_time_ns = p.device_time_ns;
  state->valid = info().senses;
  state->buttons = p.buttons;
  state->dead_man = p.dead_man != 0 || !info().has_dead_man;
  state->emergency_stop = p.emergency_stop != 0;
  state->X_DH.p = Eigen::Map<const Vector3d>(p.position);
  state->X_DH.R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(p.rotation);
  state->V_DH = Eigen::Map<const Vector6d>(p.twist);
  state->applied_F_Ho_D = Eigen::Map<const Vector6d>(p.applied_wrench);
  state->gripper_opening = p.gripper_opening;
  return status;
}

IoStatus PluginMaster::OnWrite(const MasterCommand& command) noexcept {
  vmech_plugin_command p{};
  p.sequence = command.sequence;
  p.valid_until_ns = command.valid_until_ns;
  if (command.mode == CommandMode::kWrench) {
    std::copy_n(command.F_Ho_D.data(), 6, p.wrench);
    p.gripper_torque = command.gripper_torque;
  }
  plugin_.write(plugin_.device, &p);
  return IoStatus::kOk;
}

}  // namespace vmech
