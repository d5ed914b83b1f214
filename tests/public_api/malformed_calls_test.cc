#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "vmech/dynamics/bearings/duty_cycle.h"
#include "vmech/dynamics/bearings/joint_bearings.h"
#include "vmech/dynamics/bearings/rating_life.h"
#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/in_hand/hand_dynamics.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/hw_interface/safety/safety_filter.h"
#include "vmech/kinematics/inverse/assembly_modes.h"
#include "vmech/kinematics/inverse/hand_tracker.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/mechanisms/files/writer.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a program may get wrong, and words that the message must have.
struct Malformed {
  std::string name;
  std::function<void()> call;
  std::vector<std::string> says;
};

/// A crank and a rod whose end slides: one loop.
Mechanism SliderCrank() {
  Mechanism m;
  m.name = "slider-crank";
  m.gravity_W = {0, 0, -9.81};
  const Matrix3d along_x = AxesFromZX({1, 0, 0}, {0, 1, 0});
  m.links = {{"frame", {}, {{"main", {}}, {"guide", {along_x, Vector3d::Zero()}}}},
             {"crank", {}, {{"main", {}}, {"pin", {Matrix3d::Identity(), {0.05, 0, 0}}}}},
             {"rod", {}, {{"pin", {}}, {"wrist", {Matrix3d::Identity(), {0.15, 0, 0}}}}},
             {"piston", {}, {{"wrist", {}}, {"guide", {along_x, Vector3d::Zero()}}}}};
  for (size_t i = 1; i < m.links.size(); ++i) {
    m.links[i].mass_properties = {1, {0.02, 0, 0}, 1e-3 * Matrix3d::Identity()};
  }
  m.joints = {MakeJoint("main", JointType::kRevolute, {0, 0}, {1, 0}),
              MakeJoint("pin", JointType::kRevolute, {1, 1}, {2, 0}),
              MakeJoint("wrist", JointType::kRevolute, {2, 1}, {3, 0}),
              MakeJoint("guide", JointType::kPrismatic, {0, 1}, {3, 1})};
  m.joints[0].start = {0.5};
  m.grasps = {{"handle", 1, {Matrix3d::Identity(), {0.05, 0, 0}}, GraspKind::kPoint}};
  return m;
}

LoadStudy Turning() {
  LoadStudy study;
  study.mechanism = SliderCrank();
  study.drives = {{0, 0, MotionLaw::Uniform(0.5, 10)}};
  for (int i = 0; i < 36; ++i) study.times.push_back(0.01 * i);
  return study;
}

ExternalLoad Push() {
  ExternalLoad load;
  load.link = 3;
  load.at = {0};
  load.wrenches = {{{1, 0, 0}, {0, 0, 0}}};
  return load;
}

HandDrive Hand() {
  return {0, HandLaw::Table({0, 1}, {Posed(), Posed()})};
}

/// A mechanism with one thing wrong, made ready for computation.
Malformed Of(std::string name, const std::function<void(Mechanism*)>& spoil,
             std::vector<std::string> says) {
  return {std::move(name),
          [spoil] {
            Mechanism mechanism = SliderCrank();
            spoil(&mechanism);
            BuildKinematicTree(mechanism);
          },
          std::move(says)};
}

/// A study with one thing wrong.
Malformed Of(std::string name, const std::function<void(LoadStudy*)>& spoil,
             std::vector<std::string> says) {
  return {std::move(name),
          [spoil] {
            LoadStudy study = Turning();
            spoil(&study);
            RunLoadStudy(study);
          },
          std::move(says)};
}

using M = Mechanism*;
using S = LoadStudy*;

std::vector<Malformed> Mechanisms() {
  return {
      Of("no links", [](M m) { *m = {}; }, {"ground = 0", "are 0"}),
      Of("ground", [](M m) { m->ground = FindLink(*m, "no such link"); }, {"ground = -1", "are 4"}),
      Of("twice", [](M m) { m->links[2].name = "crank"; }, {"links", "'crank'"}),
      Of("joint twice", [](M m) { m->joints[1].name = "main"; }, {"joints", "'main'"}),
      Of("anchor twice", [](M m) { m->links[1].anchors[1].name = "main"; }, {"links[1] 'crank'"}),
      Of("mass", [](M m) { m->links[2].mass_properties.mass = -1; }, {"links[2] 'rod'", "= -1"}),
      Of("mass nan", [](M m) { m->links[2].mass_properties.mass = kNan; }, {"mass = nan"}),
      Of("mass inf", [](M m) { m->links[2].mass_properties.mass = kInfinity; }, {"mass = inf"}),
      Of("centre", [](M m) { m->links[2].mass_properties.p_LoLcm.y() = kNan; },
         {"p_LoLcm = (0.02, nan, 0)"}),
      Of("inertia nan", [](M m) { m->links[1].mass_properties.I_Lcm(0, 0) = kNan; },
         {"links[1] 'crank'", "I_Lcm"}),
      Of("inertia not symmetric", [](M m) { m->links[1].mass_properties.I_Lcm(0, 1) = 1e-4; },
         {"I_Lcm", "symmetric"}),
      Of("inertia negative", [](M m) { m->links[1].mass_properties.I_Lcm(0, 0) = -1e-3; },
         {"I_Lcm", "not positive definite", "-0.001"}),
      Of("anchor nan", [](M m) { m->links[1].anchors[1].X_LA.p.x() = kNan; },
         {"links[1] 'crank'.anchors[1] 'pin'.X_LA.p"}),
      Of("anchor not square", [](M m) { m->links[1].anchors[1].X_LA.R *= 2; },
         {"anchors[1] 'pin'", "no rotation", "AxesFromZX"}),
      Of("anchor left-handed", [](M m) { m->links[1].anchors[1].X_LA.R.col(1) *= -1; },
         {"no rotation", "-1"}),
      Of("joint's link", [](M m) { m->joints[2].first.link = FindLink(*m, "absent"); },
         {"joints[2] 'wrist'.first.link = -1", "are 4"}),
      Of("joint's anchor", [](M m) { m->joints[2].second.anchor = 9; },
         {"joints[2] 'wrist'.second.anchor = 9", "are 2"}),
      Of("joint with itself",
         [](M m) {
           m->joints[1].second = {1, 0};
         },
         {"'crank' with itself"}),
      Of("joint type", [](M m) { m->joints[1].type = static_cast<JointType>(99); }, {"type = 99"}),
      Of("pitch", [](M m) { m->joints[1].pitch = kNan; }, {"joints[1] 'pin'.pitch = nan"}),
      Of("start's length", [](M m) { m->joints[1].start = {}; }, {"start", "0 entries"}),
      Of("start nan", [](M m) { m->joints[1].start = {kNan}; }, {"start = nan"}),
      Of("quaternion",
         [](M m) {
           m->joints[2] = MakeJoint("wrist", JointType::kSpherical, {2, 1}, {3, 0});
           m->joints[2].start = {2, 0, 0, 0};
         },
         {"joints[2] 'wrist'.start", "length 2, must be 1"}),
      Of("limits crossed",
         [](M m) {
           m->joints[1].lower = {1};
           m->joints[1].upper = {-1};
         },
         {"joints[1] 'pin'", "lower[0] = 1", "upper[0] = -1"}),
      Of("limit nan", [](M m) { m->joints[1].lower = {kNan}; }, {"lower[0] = nan"}),
      Of("limits' length", [](M m) { m->joints[1].upper = {}; }, {"upper", "must have 1"}),
      Of("spring", [](M m) { m->joints[1].passive[0].stiffness = -5; }, {"stiffness = -5"}),
      Of("damper", [](M m) { m->joints[1].passive[0].viscous = kNan; }, {"viscous = nan"}),
      Of("friction", [](M m) { m->joints[1].load_friction.coefficient = -0.1; },
         {"load_friction.coefficient = -0.1"}),
      Of("gravity", [](M m) { m->gravity_W.z() = kNan; }, {"gravity_W = (0, 0, nan)"}),
      Of("tolerance", [](M m) { m->tolerance = 1; }, {"tolerance = 1", "[0, 0.01]"}),
      Of("grasp's link", [](M m) { m->grasps[0].link = -1; }, {"grasps[0] 'handle'.link = -1"}),
      Of("grasp's axes", [](M m) { m->grasps[0].X_LG.R.setZero(); }, {"grasps[0]", "no rotation"}),
      Of("cuts", [](M m) { m->preferred_cuts = {4}; }, {"preferred_cuts = 4", "are 4"}),
      Of("loose link",
         [](M m) {
           m->links.push_back({"loose", {}, {}});
         },
         {"'loose'"}),
  };
}

std::vector<Malformed> Studies() {
  return {
      Of("drive's joint", [](S s) { s->drives[0].joint = FindJoint(s->mechanism, "motor"); },
         {"drives[0].joint = -1", "are 4"}),
      Of("drive's freedom", [](S s) { s->drives[0].freedom = 1; }, {"'main'", "revolute"}),
      Of("drive's law", [](S s) { s->drives[0].law = MotionLaw(); }, {"drives[0].law is empty"}),
      Of("law not finite", [](S s) { s->drives[0].law = MotionLaw::Uniform(0, kNan); },
         {"speed = nan"}),
      Of("no poses", [](S s) { s->times.clear(); }, {"no poses"}),
      Of("times", [](S s) { s->times[3] = s->times[2]; }, {"times[3] = 0.02 follows 0.02"}),
      Of("time nan", [](S s) { s->times[3] = kNan; }, {"times[3] = nan"}),
      Of("cycle", [](S s) { s->cycle = 0.1; }, {"cycle = 0.1", "0.35"}),
      Of("cycle nan", [](S s) { s->cycle = kNan; }, {"cycle = nan"}),
      Of("norm length", [](S s) { s->norm_length = -1; }, {"norm_length = -1"}),
      Of("drive and hand", [](S s) { s->hand = Hand(); }, {"not both"}),
      Of("hand's grasp",
         [](S s) {
           s->drives.clear();
           s->hand = Hand();
           s->hand->grasp = FindGrasp(s->mechanism, "knob");
         },
         {"hand.grasp = -1", "is 1"}),
      Of("hand's law",
         [](S s) {
           s->drives.clear();
           s->hand = HandDrive{0, {}};
         },
         {"hand.law is empty"}),
      Of("hand's stiffness",
         [](S s) {
           s->drives.clear();
           s->hand = Hand();
           s->hand->stiffness[4] = -1;
         },
         {"hand.stiffness[4] = -1"}),
      Of("load's link",
         [](S s) {
           s->external = {Push()};
           s->external[0].link = FindLink(s->mechanism, "wheel");
         },
         {"external[0].link = -1"}),
      Of("load without rows", [](S s) { s->external = {{.link = 1}}; },
         {"external[0]", "0 wrenches"}),
      Of("load of two lengths",
         [](S s) {
           s->external = {Push()};
           s->external[0].over = ExternalLoad::Over::kTime;
           s->external[0].wrenches.resize(2);
         },
         {"at", "1 rows", "2"}),
      Of("load that turns back",
         [](S s) {
           s->external = {Push()};
           s->external[0].over = ExternalLoad::Over::kTime;
           s->external[0].at = {0, 1, 0.5};
           s->external[0].wrenches.resize(3);
         },
         {"external[0].at[2] = 0.5 follows 1"}),
      Of("load nan",
         [](S s) {
           s->external = {Push()};
           s->external[0].wrenches[0].moment.x() = kNan;
         },
         {"external[0].wrenches[0]", "not finite"}),
      Of("load's point",
         [](S s) {
           s->external = {Push()};
           s->external[0].p_L.x() = kInfinity;
         },
         {"external[0].p_L"}),
      Of("load's period",
         [](S s) {
           s->external = {Push()};
           s->external[0].over = ExternalLoad::Over::kTime;
           s->external[0].at = {0, 1};
           s->external[0].wrenches.resize(2);
           s->external[0].period = 0.5;
         },
         {"external[0].period = 0.5"}),
      Of("short table",
         [](S s) {
           s->external = {Push()};
           s->external[0].over = ExternalLoad::Over::kTime;
           s->external[0].at = {0, 0.1};
           s->external[0].wrenches.resize(2);
         },
         {"'piston'", "covers 0 to 0.1"}),
      {"threads", [] { RunLoadStudy(Turning(), {.threads = 0}); }, {"threads is 0", "1..64"}},
      {"closure", [] { RunLoadStudy(Turning(), {.closure_tolerance = kNan}); }, {"nan"}},
      {"table's lengths",
       [] {
         MotionLaw::Table({0, 1}, {0});
       },
       {"2", "1"}},
      {"table's times",
       [] {
         MotionLaw::Table({0, 0}, {0, 1});
       },
       {"row 2"}},
  };
}

/// For calls that need a tree.
struct Made {
  KinematicTree tree = BuildKinematicTree(RequireAssembled(SliderCrank()).mechanism);
  VectorXd q = StartCoordinates(tree);
  GraspFrame grasp = GraspFrameOf(tree, 0);
  HandCoupling coupling = [] {
    HandCoupling spring;
    spring.stiffness.setConstant(100);
    spring.damping.setConstant(1);
    return spring;
  }();
  Vector6d stiffness = Vector6d::Ones();
};

Malformed With(std::string name, const std::function<void(Made)>& call,
               std::vector<std::string> says) {
  return {std::move(name), [call] { call(Made()); }, std::move(says)};
}

std::vector<Malformed> OfTrees() {
  const auto open = [](Made made) {
    made.q[0] += 0.1;
    return made.q;
  };
  const VectorXd two = VectorXd::Zero(2);
  return {
      {"kept joint", [] { BuildKinematicTree(SliderCrank(), {.keep = {-1}}); }, {"keep = -1"}},
      {"fixed joint",
       [] { AssembleMechanism(SliderCrank(), {.fixed_joints = {7}}); },
       {"fixed_joints = 7"}},
      With("coordinates",
           [two](Made m) {
             VectorXd q = two;
             (void)Assemble(m.tree, {}, &q);
           },
           {"Assemble: q has 2 entries", "3 coordinates"}),
      With("coordinate nan",
           [](Made m) {
             m.q[1] = kNan;
             (void)Assemble(m.tree, {}, &m.q);
           },
           {"q[1] = nan"}),
      With("tolerance", [](Made m) { (void)Assemble(m.tree, {.tolerance = 0}, &m.q); },
           {"tolerance is 0"}),
      With("fixed", [](Made m) { (void)Assemble(m.tree, {.fixed = {-1}}, &m.q); },
           {"fixed has -1", "0..2"}),
      With("mobility", [two](Made m) { AnalyseMobility(m.tree, two); }, {"2 entries"}),
      With("driven", [](Made m) { PartitionForDrives(m.tree, m.q, {3}); }, {"driven has 3"}),
      With("too many drives",
           [](Made m) {
             PartitionForDrives(m.tree, m.q, {0, 1});
           },
           {"mobility 1"}),
      With("velocity of no joint", [](Made m) { VelocityIndex(m.tree, -1, 0); }, {"joint = -1"}),
      With("velocity of no freedom", [](Made m) { VelocityIndex(m.tree, 0, 2); },
           {"'main'", "= 2"}),
      With("grasp", [](Made m) { GraspFrameOf(m.tree, FindGrasp(m.tree.mechanism, "knob")); },
           {"grasp = -1", "is 1"}),
      With("grasp's node",
           [](Made m) {
             InverseKinematics(m.tree, {99, {}});
           },
           {"node = 99"}),
      With("no stiffness",
           [](Made m) {
             InverseKinematicsOptions options;
             options.stiffness[5] = 1;
             InverseKinematics(m.tree, m.grasp, options);
           },
           {"stiffness"}),
      With("tracker's start", [two](Made m) { HandTracker(m.tree, m.grasp, two); }, {"2 entries"}),
      With("tracker's loops", [open](Made m) { HandTracker(m.tree, m.grasp, open(m)); },
           {"open by"}),
      With("tracker's steps", [](Made m) { HandTracker(m.tree, m.grasp, m.q, {.steps = 0}); },
           {"steps"}),
      With("modes' start", [two](Made m) { FindAssemblyModes(m.tree, {}, two); }, {"2 entries"}),
      With("modes' links", [](Made m) { FindAssemblyModes(m.tree, {.links = {-1}}, m.q); },
           {"links is -1"}),
      With("solver's start",
           [two](Made m) {
             InverseKinematics problem(m.tree, m.grasp);
             Solve(problem, PenaltyOptions(), two);
           },
           {"2", "3"}),
      With("step", [](Made m) { CoupledDynamics(m.tree, m.grasp, m.coupling, 0, m.q); },
           {"step = 0"}),
      With("step nan", [](Made m) { CoupledDynamics(m.tree, m.grasp, m.coupling, kNan, m.q); },
           {"step = nan"}),
      With("coupling",
           [](Made m) {
             m.coupling.stiffness[2] = -1;
             CoupledDynamics(m.tree, m.grasp, m.coupling, 1e-3, m.q);
           },
           {"stiffness = -1"}),
      With("open loops",
           [open](Made m) { CoupledDynamics(m.tree, m.grasp, m.coupling, 1e-3, open(m)); },
           {"open by", "Assemble"}),
      With("pose", [two](Made m) { CoupledDynamics(m.tree, m.grasp, m.coupling, 1e-3, two); },
           {"2 entries"}),
      With("held node",
           [](Made m) {
             HandDynamics(m.tree, {-7, {}}, m.stiffness, m.q);
           },
           {"node = -7"}),
      With("soft hand", [](Made m) { HandDynamics(m.tree, m.grasp, Vector6d::Zero(), m.q); },
           {"stiffness above zero"}),
      With("tick's grasp",
           [](Made m) { CoupledTick(m.tree, -1, m.q, 1e-3, {.coupling = m.coupling}); },
           {"grasp = -1"}),
      With("tick's scale",
           [](Made m) {
             CoupledTick(m.tree, 0, m.q, 1e-3, {.coupling = m.coupling, .scale = kNan});
           },
           {"scale", "nan"}),
      {"device", [] { SimulatedMaster({.period = -1}); }, {"period", "-1"}},
      {"encoder", [] { SimulatedMaster({.encoder_bits = 99}); }, {"encoder_bits", "99"}},
      {"no durations", [] { DutyCycle().Validate(); }, {"no poses"}},
      {"reliability", [] { BearingRequirements({.reliability = 100}).Validate(); }, {"100"}},
      {"file with nan",
       [] {
         Mechanism mechanism = SliderCrank();
         mechanism.links[1].mass_properties.mass = kNan;
         WriteMechanism(mechanism);
       },
       {"nan"}},
  };
}

void ExpectRefused(const std::vector<Malformed>& calls) {
  for (const Malformed& malformed : calls) {
    SCOPED_TRACE(malformed.name);
    try {
      malformed.call();
      ADD_FAILURE() << "is taken without a word";
    } catch (const std::invalid_argument& error) {
      for (const std::string& word : malformed.says) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << "'" << word << "' is not in: " << error.what();
      }
    } catch (const std::exception& error) {
      ADD_FAILURE() << "is no std::invalid_argument: " << error.what();
    }
  }
}

TEST(MalformedCalls, MechanismsAreRefusedByName) {
  ExpectRefused(Mechanisms());
}

TEST(MalformedCalls, StudiesAreRefusedByName) {
  ExpectRefused(Studies());
}

TEST(MalformedCalls, WhatGoesWithATreeIsRefusedByName) {
  ExpectRefused(OfTrees());
}

TEST(MalformedCalls, WhatTheyAreSpoiltFromIsSound) {
  EXPECT_NO_THROW(RunLoadStudy(Turning()));
  const Made made;
  EXPECT_NO_THROW(CoupledDynamics(made.tree, made.grasp, made.coupling, 1e-3, made.q));
  EXPECT_NO_THROW(HandTracker(made.tree, made.grasp, made.q));
}

TEST(MalformedCalls, FiguresThatOverflowAreRefused) {
  LoadStudy study = Turning();
  study.mechanism.links[2].mass_properties.mass = 1e308;  // its weight is beyond a double
  try {
    RunLoadStudy(study);
    ADD_FAILURE() << "is taken without a word";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("too large to be computed"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace vmech
