// What a program does with the installed vmech: the loads of a pendulum, its weight in a hand, and
// a session with a simulated device; each compared with what statics says. Then a problem of two
// unknowns by every back end. Every class that needs arguments is made on the stack, on the heap
// and in a vector.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string_view>
#include <vector>

#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/in_hand/hand_dynamics.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/hw_interface/estimation/hand_observer.h"
#include "vmech/hw_interface/loop/loop_clock.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/kinematics/inverse/hand_tracker.h"
#include "vmech/solvers/backend.h"
#include "vmech/studies/study_reader.h"

namespace {

using vmech::Vector3d;

constexpr double kMass = 0.4, kArm = 0.05, kSpeed = 20, kGravity = 9.81;

int failures = 0;

void Expect(const char* what, double value, double expected, double tolerance) {
  const bool met = std::abs(value - expected) <= tolerance;
  if (!met) ++failures;
  std::cout << (met ? "  " : "MISSED ") << what << ": " << value << ", expected " << expected
            << "\n";
}

vmech::Mechanism Pendulum() {
  vmech::Mechanism pendulum;
  pendulum.name = "pendulum";
  pendulum.gravity_W = {0, -kGravity, 0};
  pendulum.links = {{"frame", {}, {{"pin", {}}}}, {"bob", {}, {{"pin", {}}}}};
  vmech::MassProperties& bob = pendulum.links[1].mass_properties;
  bob.mass = kMass;
  bob.p_LoLcm = {kArm, 0, 0};
  pendulum.joints = {vmech::MakeJoint("pin", vmech::JointType::kRevolute, {0, 0}, {1, 0})};
  vmech::Grasp tip;
  tip.name = "tip";
  tip.link = 1;
  tip.X_LG.p = {kArm, 0, 0};
  pendulum.grasps = {tip};
  return pendulum;
}

/// Level arm, uniform speed: centripetal force inwards, weight borne upwards.
void RunLoads() {
  vmech::LoadStudy study;
  study.mechanism = Pendulum();
  study.drives = {{0, 0, vmech::MotionLaw::Uniform(0, kSpeed)}};
  study.times = {0.0};
  const vmech::LoadStudyResult result = vmech::RunLoadStudy(study);
  const Vector3d force = result.poses[0].joints[0].force;
  std::cout << result.BriefReport() << "\n";
  Expect("pin force x [N]", force.x(), -kMass * kArm * kSpeed * kSpeed, 1e-12);
  Expect("pin force y [N]", force.y(), kMass * kGravity, 1e-12);
}

/// A study that a file describes.
vmech::LoadStudyResult Loads(const char* file) {
  const vmech::StudyFile study = vmech::ReadStudy(file);  // throws FileErrors, with every error
  return vmech::RunLoadStudy(study.study);
}

/// Three of a class: a vector grows, and its elements move.
template <typename T, typename... Arguments>
void MakeMany(const Arguments&... arguments) {
  std::vector<T> many;
  for (int i = 0; i < 3; ++i) many.emplace_back(arguments...);
  const auto on_heap = std::make_unique<T>(arguments...);
}

/// A stiff coupling to a hand at rest carries the weight; so does the hand in the paper's way.
void Hold() {
  const vmech::KinematicTree tree = vmech::BuildKinematicTree(Pendulum());
  const vmech::GraspFrame grasp = vmech::GraspFrameOf(tree, 0);
  const vmech::VectorXd q = vmech::StartCoordinates(tree);
  vmech::HandCoupling coupling;
  coupling.stiffness << 1e4, 1e4, 1e4, 0, 0, 0;
  coupling.damping << 100, 100, 100, 0, 0, 0;
  vmech::CoupledDynamics coupled(tree, grasp, coupling, 1e-3, q);
  const vmech::Posed X_WH = coupled.X_WG();
  int moved = 0;
  for (int i = 0; i < 3000; ++i) {
    moved += coupled.Step(X_WH, vmech::Vector6d::Zero()) == vmech::CoupledStatus::kMoved;
  }
  Expect("steps", moved, 3000, 0);
  Expect("pull of the coupling [N]", coupled.w()[1], kMass * kGravity, 1e-3);
  Expect("stretch [m]", coupled.stretch().linear[1], kMass * kGravity / 1e4, 1e-5);
  MakeMany<vmech::CoupledDynamics>(tree, grasp, coupling, 1e-3, q);

  const vmech::Vector6d zero = vmech::Vector6d::Zero();
  vmech::HandDynamics hand(tree, grasp, coupling.stiffness, q);
  Expect("is evaluated", hand.Evaluate(zero, zero), true, 0);
  // About the pin: w_d is the least wrench that holds the weight.
  const double torque = hand.w_d()[1] * kArm + hand.w_d()[5];
  Expect("torque of the hand [N m]", torque, kMass * kGravity * kArm, 1e-9);
  const auto on_heap = std::make_unique<vmech::HandDynamics>(tree, grasp, coupling.stiffness, q);

  vmech::HandTracker tracker(tree, grasp, q);
  Expect("is followed", tracker.Advance(X_WH) == vmech::TrackStatus::kFollowed, true, 0);
}

/// The device's own loop, observer, safety filter and recorder, for half a second.
void RunSession() {
  const vmech::KinematicTree tree = vmech::BuildKinematicTree(Pendulum());
  const vmech::VectorXd q = vmech::StartCoordinates(tree);
  vmech::CoupledTickOptions options;
  options.coupling.stiffness << 500, 500, 500, 1, 1, 1;
  options.coupling.damping << 5, 5, 5, 0.01, 0.01, 0.01;
  vmech::SimulatedMaster master;
  master.Configure();
  const vmech::DeviceInfo& info = master.info();
  vmech::CoupledTick tick(tree, 0, q, info.period, options);
  const vmech::HandObserver observer({}, info);
  MakeMany<vmech::HandObserver>(vmech::HandObserverOptions(), info);
  vmech::RunnerOptions run;
  run.seconds = 0.5;
  run.realtime.reset();
  vmech::FreeRunningClock clock;
  vmech::Runner runner(run, &master, &tick, &clock);
  const vmech::RunSummary summary = runner.Run();
  std::cout << summary.BriefReport() << "\n";
  Expect("ticks", static_cast<double>(summary.ticks), 0.5 / info.period, 0);
  const std::vector<vmech::TickRecord> kept = runner.Kept().ticks;
  Expect("kept ticks", static_cast<double>(kept.size()), 0.5 / info.period, 0);
}

/// The point of the unit circle nearest to (2, 1).
class Circle final : public vmech::ConstrainedLeastSquares {
 public:
  Circle() : ConstrainedLeastSquares({2, 2, 2, 1}) {}
  void Evaluate(const vmech::VectorXd& x, vmech::VectorXd* r, vmech::MatrixXd* J,
                vmech::VectorXd* c, vmech::MatrixXd* C) override {
    if (r) *r << x[0] - 2, x[1] - 1;
    if (J) J->setIdentity();
    if (c) *c << x.squaredNorm() - 1;
    if (C) *C = 2 * x.transpose();
  }
};

/// By every back end. `packages` are those that vmech was built with, as in "vmech_ceres".
void SolveByEveryBackend(const std::vector<std::string_view>& packages) {
  Circle circle;
  const vmech::VectorXd x0 = (vmech::VectorXd(2) << 0.5, 0.5).finished();
  int off_circle = 0;
  for (const vmech::Backend backend : vmech::kAllBackends) {
    const std::string_view name = vmech::NameOf(backend);
    bool there = true;
    for (const std::string_view package : {"ceres", "ipopt", "kinsol", "nlopt"}) {
      if (!name.starts_with(package)) continue;
      const auto named = [&](std::string_view built) { return built.ends_with(package); };
      there = std::any_of(packages.begin(), packages.end(), named);
    }
    const vmech::Summary summary = vmech::Solve(backend, circle, {}, x0);
    std::cout << summary.BriefReport() << " " << summary.message << "\n";
    const bool available = summary.status != vmech::SolveStatus::kUnavailable;
    Expect("is available", available, there, 0);
    // One that says it has come to an end of its iterations off the circle is elsewhere.
    const bool closed = available && summary.constraint_norm < 1e-5;
    off_circle += available && !closed;
    if (closed) Expect("x on the circle", summary.x[0], 2 / std::sqrt(5.0), 1e-3);
  }
  Expect("all but one are on the circle", off_circle <= 1, true, 0);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return EXIT_FAILURE;
  Expect("poses of a file", static_cast<double>(Loads(arguments[1]).poses.size()), 360, 0);
  RunLoads();
  Hold();
  RunSession();
  SolveByEveryBackend({arguments + 2, arguments + count});
  std::cout << (failures == 0 ? "all as expected\n" : "NOT as expected\n");
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
