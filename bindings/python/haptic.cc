#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "convert.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/paper_choice.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/validity.h"

namespace vmech::python {
namespace {

KinematicTree HeldTree(const Mechanism& mechanism, int grasp) {
  RequireValid(mechanism);
  RequireIndex("grasp", grasp, mechanism.grasps.size());
  return BuildKinematicTree(RequireAssembled(mechanism).mechanism, KeepPassiveJoints(mechanism));
}

py::tuple TupleOf(const Posed& X) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R = X.R;
  return py::make_tuple(py::array_t<double>(3, X.p.data()), py::array_t<double>({3, 3}, R.data()));
}

/// A mechanism in a hand, stepped by the program.
class PythonTick {
 public:
  PythonTick(const Mechanism& mechanism, int grasp, double period, const Numbers& stiffness,
             const Numbers& damping, double max_force, double max_moment, double scale)
      : tree_(HeldTree(mechanism, grasp)),
        tick_(tree_, grasp, StartCoordinates(tree_), period,
              OptionsOf(period, stiffness, damping, max_force, max_moment, scale)),
        channels_(tick_.ChannelNames().size()) {
    input_.fresh = true;
    input_.elapsed = period;
  }

  py::array_t<double> Step(const Numbers& position, const std::optional<Numbers>& rotation) {
    input_.X_WH = PoseOf(position, rotation);
    const TickOutput out = tick_.Step(input_, channels_);
    if (out.status == TickStatus::kFailed) {
      throw std::runtime_error("no sound wrench for this hand: stop the motors");
    }
    return CopyOf(out.F_Ho_W);
  }

  py::tuple Grasp() const { return TupleOf(tick_.GraspFrame()); }
  py::array_t<double> Wrenches() const {
    const std::vector<Wrenchd>& joints = tick_.dynamics().joints();
    py::array_t<double> wrenches({static_cast<py::ssize_t>(joints.size()), py::ssize_t{6}});
    for (size_t j = 0; j < joints.size(); ++j) {
      Eigen::Map<Vector6d>(wrenches.mutable_data(static_cast<py::ssize_t>(j), 0)) =
          joints[j].Stacked();
    }
    return wrenches;
  }

 private:
  static CoupledTickOptions OptionsOf(double period, const Numbers& stiffness,
                                      const Numbers& damping, double max_force, double max_moment,
                                      double scale) {
    CoupledTickOptions options;
    options.coupling = {Vector6Of("stiffness", stiffness), Vector6Of("damping", damping), max_force,
                        max_moment};
    options.scale = scale;
    options.smoothing = 2 * period;
    return options;
  }

  KinematicTree tree_;
  CoupledTick tick_;
  TickInput input_;
  std::vector<double> channels_;
};

/// A device whose handle is where a function says, and whose force another one hears. What Python
/// raises is a fault of the device.
class PythonMaster final : public Master {
 public:
  PythonMaster(const DeviceInfo& device, py::object hand, py::object felt)
      : device_(device), hand_(std::move(hand)), felt_(std::move(felt)) {}
  ~PythonMaster() override { Shutdown(); }

  /// The loop that ends where Python raises something.
  void StopOnError(Runner* runner) { runner_ = runner; }
  /// Goes on with what Python raised.
  void Rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  DeviceInfo OnConfigure() override { return device_; }

  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override {
    if (first_ns_ < 0) first_ns_ = now_ns;
    state->sequence = static_cast<std::uint64_t>(
        1 + std::llround(1e-9 * static_cast<double>(now_ns - first_ns_) / device_.period));
    state->host_time_ns = state->device_time_ns = now_ns;
    state->valid = kSensesPose;
    state->dead_man = true;
    return Ask([&] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      const py::object pose = hand_(1e-9 * static_cast<double>(now_ns - first_ns_));
      if (py::len(pose) == 2) {
        const auto [position, rotation] = pose.cast<std::pair<Numbers, Numbers>>();
        state->X_DH = PoseOf(position, rotation);
      } else {
        state->X_DH = PoseOf(pose.cast<Numbers>(), std::nullopt);
      }
    });
  }

  IoStatus OnWrite(const MasterCommand& command) noexcept override {
    if (error_) return IoStatus::kDeviceFault;
    return Ask([&] {
      if (!felt_.is_none()) felt_(CopyOf(command.F_Ho_D));
    });
  }

  template <typename Question>
  IoStatus Ask(Question question) noexcept {
    if (error_) return IoStatus::kDeviceFault;
    const py::gil_scoped_acquire held;
    try {
      question();
    } catch (...) {
      error_ = std::current_exception();
      runner_->Stop();
    }
    return error_ ? IoStatus::kDeviceFault : IoStatus::kOk;
  }

  DeviceInfo device_;
  py::object hand_, felt_;
  Runner* runner_ = nullptr;
  std::int64_t first_ns_ = -1;
  std::exception_ptr error_;
};

/// What a session renders by, and how it is watched.
struct Rendered {
  std::unique_ptr<Tick> tick;
  SafetyOptions safety;
  HandObserverOptions observer;
};

Rendered Render(const KinematicTree& tree, int grasp, const DeviceInfo& device, bool paper) {
  const VectorXd q = StartCoordinates(tree);
  if (paper) {
    const PaperChoice choice = ChoosePaper({}, tree, grasp, q, device);
    return {std::make_unique<MechanismTick>(tree, grasp, q, device, choice.tick), choice.safety,
            choice.observer};
  }
  CoupledTickOptions options;
  options.smoothing = 2 * device.period;
  const CouplingChoice choice =
      ChooseCoupling(tree, GraspFrameOf(tree, grasp), q, device, options.smoothing);
  options.coupling = choice.coupling;
  options.scale = choice.scale;
  return {std::make_unique<CoupledTick>(tree, grasp, q, device.period, options), choice.Safety(),
          HandObserverOptions{}};
}

/// mass, damping, coulomb, resolution, peak, max_speed.
HandlePhysics PhysicsOf(const char* name, const Numbers& numbers) {
  const Vector6d n = Vector6Of(name, numbers);
  return {n[0], n[1], n[2], n[3], n[4], n[5]};
}

DeviceInfo DeviceOf(double period, const Numbers& linear, const Numbers& angular) {
  DeviceInfo device;
  device.name = "python";
  device.period = period;
  device.senses = kSensesPose;
  device.takes_wrench = true;
  device.linear = PhysicsOf("linear", linear);
  device.angular = PhysicsOf("angular", angular);
  return device;
}

/// (report, ticks, skipped, peak force, fault or "", times, positions, wrenches): what was sent to
/// the device at every tick, and where the hand was in the world.
py::tuple TakeSession(const RunSummary& summary, const Recording& kept) {
  const auto ticks = static_cast<py::ssize_t>(kept.ticks.size());
  py::array_t<double> times(ticks), positions({ticks, py::ssize_t{3}});
  py::array_t<double> wrenches({ticks, py::ssize_t{6}});
  for (py::ssize_t i = 0; i < ticks; ++i) {
    const TickRecord& tick = kept.ticks[static_cast<size_t>(i)];
    const auto passed = static_cast<double>(tick.state.sequence - kept.ticks[0].state.sequence);
    times.mutable_at(i) = passed * kept.period;
    const Vector3d p = tick.registration.HandInWorld(tick.state.X_DH).p;
    Eigen::Map<Vector3d>(positions.mutable_data(i, 0)) = p;
    Eigen::Map<Vector6d>(wrenches.mutable_data(i, 0)) = tick.sent_F_Ho_D;
  }
  const bool fault = summary.status == RunStatus::kFault;
  return py::make_tuple(summary.FullReport(), summary.ticks, summary.skipped, summary.peak_force,
                        fault ? std::string(NameOf(summary.cause)) : "", times, positions,
                        wrenches);
}

py::tuple Hold(const Mechanism& mechanism, int grasp, const py::object& hand,
               const py::object& felt, double seconds, double period, const Numbers& linear,
               const Numbers& angular, bool paper, bool real_time) {
  const KinematicTree tree = HeldTree(mechanism, grasp);
  const DeviceInfo device = DeviceOf(period, linear, angular);
  PythonMaster master(device, hand, felt);
  master.Configure();
  Rendered rendered = Render(tree, grasp, device, paper);
  RunnerOptions options;
  options.seconds = seconds;
  options.record = true;
  options.safety = rendered.safety;
  options.observer = rendered.observer;
  options.realtime.reset();
  WallClock wall;
  FreeRunningClock free;
  LoopClock* clock = &wall;
  if (!real_time) clock = &free;
  Runner runner(options, &master, rendered.tick.get(), clock);
  master.StopOnError(&runner);
  RunSummary summary;
  {
    const py::gil_scoped_release released;
    summary = runner.Run();
  }
  master.Rethrow();
  return TakeSession(summary, runner.Kept());
}

}  // namespace

void BindHaptic(py::module_* module) {
  py::class_<PythonTick>(*module, "Tick")
      .def(py::init<const Mechanism&, int, double, const Numbers&, const Numbers&, double, double,
                    double>())
      .def("step", &PythonTick::Step)
      .def("grasp", &PythonTick::Grasp)
      .def("wrenches", &PythonTick::Wrenches);
  module->def("hold", &Hold);
}

}  // namespace vmech::python
