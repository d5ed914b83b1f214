// MuJoCo as a second opinion on exported models: it holds loops by stiff springs, so that it agrees
// with vmech to its softness and not to rounding.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <ostream>

#include "support/examples.h"
#include "support/temp_folder.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/exchange/mjcf.h"

namespace vmech {
namespace {

constexpr double kSoftLoop = 1e-4;  // of the characteristic length: what MuJoCo's springs give
/// Of the torque that holds the weight. MuJoCo's constraints carry at most 0.9999 of what rigid
/// ones would (solimp), whatever the step; measured: 3e-3 on a coupler that whirls.
constexpr double kSoftDrive = 5e-3;
constexpr double kSameMass = 1e-4;    // light links in place of massless ones
constexpr double kTextPoses = 1e-12;  // poses through decimals and quaternions, one step in

using Model = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using Data = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

Model Load(const Mechanism& mechanism) {
  const TempFolder folder;
  std::ofstream(folder / "model.xml") << WriteMjcf(mechanism).text;
  char error[1000] = "";
  mjModel* model = mj_loadXML((folder / "model.xml").c_str(), nullptr, error, sizeof error);
  EXPECT_NE(model, nullptr) << error;
  return {model, &mj_deleteModel};
}

Data DataOf(const Model& model) {
  return {mj_makeData(model.get()), &mj_deleteData};
}

/// The tree in which MuJoCo has the mechanism: joints that it does not know are cut.
KinematicTree TreeOf(const Model& model, const Mechanism& mechanism) {
  SpanningTreeOptions options;
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const char* name = mechanism.joints[j].name.c_str();
    if (mj_name2id(model.get(), mjOBJ_JOINT, name) < 0) {
      options.cut.push_back(static_cast<int>(j));
    }
  }
  return BuildKinematicTree(mechanism, options);
}

/// Its coordinates as ours: counted from zero instead of from the start.
VectorXd Coordinates(const Model& model, const Data& data, const KinematicTree& tree) {
  VectorXd q = StartCoordinates(tree);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    const int id =
        mj_name2id(model.get(), mjOBJ_JOINT, tree.mechanism.joints[node.joint].name.c_str());
    q[node.q] += data->qpos[model->jnt_qposadr[id]];
  }
  return q;
}

Posed PoseOfBody(const Model& model, const Data& data, const std::string& name) {
  const int id = mj_name2id(model.get(), mjOBJ_BODY, name.c_str());
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return {Eigen::Map<const Rows>(data->xmat + 9 * id),
          Eigen::Map<const Vector3d>(data->xpos + 3 * id)};
}

class MujocoModel : public testing::TestWithParam<std::string> {};

TEST_P(MujocoModel, LoadsWithTheMassAndTheStartPosesOfTheMechanism) {
  const Mechanism mechanism = Example(GetParam());
  const Model model = Load(mechanism);
  ASSERT_NE(model, nullptr);
  const Data data = DataOf(model);
  mj_forward(model.get(), data.get());
  const KinematicTree tree = BuildKinematicTree(mechanism);
  TreeWorkspace<double> ws(tree);
  const VectorXd q = StartCoordinates(tree);
  ForwardKinematics(tree, q.data(), &ws);
  double mass = 0;
  for (int i = 0; i < static_cast<int>(mechanism.links.size()); ++i) {
    if (i == mechanism.ground) continue;
    mass += mechanism.links[i].mass_properties.mass;
    const Posed X_WL = PoseInWorld(ws, tree.NodeOfLink(i), tree.X_node_link(i));
    const Posed theirs = PoseOfBody(model, data, mechanism.links[i].name);
    EXPECT_LT((theirs.p - X_WL.p).norm(), kTextPoses) << mechanism.links[i].name;
    EXPECT_LT((theirs.R - X_WL.R).norm(), kTextPoses) << mechanism.links[i].name;
  }
  EXPECT_NEAR(mj_getTotalmass(model.get()), mass, kSameMass * (1 + mass));
}

TEST_P(MujocoModel, IsInEquilibriumWithItsLoopsAtTheStart) {
  const Model model = Load(Example(GetParam()));
  ASSERT_NE(model, nullptr);
  const Data data = DataOf(model);
  mj_forward(model.get(), data.get());
  // Each row of <equality> begins at its rest: the anchors meet where the links are drawn.
  for (int i = 0; i < data->ne; ++i) EXPECT_NEAR(data->efc_pos[i], 0, kTextPoses) << "row " << i;
}

INSTANTIATE_TEST_SUITE_P(All, MujocoModel, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

/// A joint that closes a loop beside a slide along z, and how the body on both falls [m/s^2].
struct ClosingJoint {
  JointType type;
  double acceleration;
};
void PrintTo(const ClosingJoint& closing, std::ostream* out) {
  *out << NameOf(closing.type);
}

class MujocoLoop : public testing::TestWithParam<ClosingJoint> {};

TEST_P(MujocoLoop, LeavesTheFreedomsOfTheJointThatClosesIt) {
  constexpr double kSoft = 1e-3 * 9.81;
  const auto [type, acceleration] = GetParam();
  // x of the planar joint along the slide; the others along or about it.
  const bool planar = type == JointType::kPlanar;
  const Matrix3d axes =
      planar ? AxesFromZX(Vector3d::UnitX(), Vector3d::UnitZ()) : Matrix3d(Matrix3d::Identity());
  Mechanism mechanism;
  mechanism.name = "loop";
  mechanism.gravity_W = {0, 0, -9.81};
  const Anchor slide{"slide", Posed()}, other{"other", Posed{axes, Vector3d(0.5, 0, 0)}};
  mechanism.links.push_back(Link{"ground", MassProperties(), {slide, other}});
  mechanism.links.push_back(Link{"body", {2, {0.2, 0, 0}, Matrix3d::Identity()}, {slide, other}});
  mechanism.joints = {MakeJoint("slide", JointType::kPrismatic, {0, 0}, {1, 0}),
                      MakeJoint("other", type, {0, 1}, {1, 1})};
  if (type == JointType::kScrew) mechanism.joints[1].pitch = 0.01;
  const Model model = Load(mechanism);
  ASSERT_NE(model, nullptr);
  const Data data = DataOf(model);
  mj_forward(model.get(), data.get());
  const int id = mj_name2id(model.get(), mjOBJ_JOINT, "slide");
  ASSERT_GE(id, 0);
  EXPECT_NEAR(data->qacc[model->jnt_dofadr[id]], acceleration, kSoft);
}

INSTANTIATE_TEST_SUITE_P(All, MujocoLoop,
                         testing::Values(ClosingJoint{JointType::kRevolute, 0},
                                         ClosingJoint{JointType::kPrismatic, -9.81},
                                         ClosingJoint{JointType::kCylindrical, -9.81},
                                         ClosingJoint{JointType::kScrew, 0},
                                         ClosingJoint{JointType::kUniversal, 0},
                                         ClosingJoint{JointType::kSpherical, 0},
                                         ClosingJoint{JointType::kPlanar, -9.81},
                                         ClosingJoint{JointType::kWeld, 0}),
                         [](const auto& info) { return std::string(NameOf(info.param.type)); });

/// A mechanism with one freedom, let go at its start, and the joint that moves it.
struct Falling {
  const char* name;
  const char* joint;
};
void PrintTo(const Falling& falling, std::ostream* out) {
  *out << falling.name;
}

class MujocoMotion : public testing::TestWithParam<Falling> {
 protected:
  void SetUp() override {
    mechanism_ = Example(GetParam().name);
    // Friction would hold them, and MuJoCo has its own way with it.
    for (Joint& joint : mechanism_.joints) {
      for (Passive& passive : joint.passive) passive.coulomb = 0;
      joint.load_friction = {};
    }
    drive_ = FindJoint(mechanism_, GetParam().joint);
  }

  /// The force that the drive needs for a motion of its coordinate, at one instant.
  double DriveForce(double position, double velocity, double acceleration) const {
    LoadStudy study;
    study.mechanism = mechanism_;
    study.drives = {{drive_, 0, MotionLaw::Uniform(position, velocity, acceleration)}};
    study.times = {0};
    return RunLoadStudy(study).poses[0].drives[0].force;
  }

  Mechanism mechanism_;
  int drive_ = -1;
};

/// Smaller steps, and springs at the stiffest that these allow.
void Stiffen(mjModel* model) {
  model->opt.timestep = 1e-4;
  for (int i = 0; i < model->neq; ++i) model->eq_solref[i * mjNREF] = 2 * model->opt.timestep;
}

TEST_P(MujocoMotion, ClosesTheLoopsAndNeedsNoDriveByOurReckoning) {
  const Model model = Load(mechanism_);
  ASSERT_NE(model, nullptr);
  Stiffen(model.get());
  const Data data = DataOf(model);
  const KinematicTree tree = TreeOf(model, mechanism_);
  TreeWorkspace<double> ws(tree);
  const int id = mj_name2id(model.get(), mjOBJ_JOINT, GetParam().joint);
  ASSERT_GE(id, 0);
  const int q = model->jnt_qposadr[id], v = model->jnt_dofadr[id];
  const double start = mechanism_.joints[drive_].start[0];
  const double weight = std::abs(DriveForce(start, 0, 0));  // it takes this to hold it
  double moved = 0, largest_reversed = 0;
  for (int sample = 0; sample < 10; ++sample) {
    for (int step = 0; step < 400; ++step) mj_step(model.get(), data.get());  // 40 ms
    mj_forward(model.get(), data.get());
    const VectorXd coordinates = Coordinates(model, data, tree);
    ForwardKinematics(tree, coordinates.data(), &ws);
    LoopErrors(tree, &ws);
    EXPECT_LT(LargestLoopError(tree, ws), kSoftLoop) << "sample " << sample;
    const double position = start + data->qpos[q], velocity = data->qvel[v];
    EXPECT_LT(std::abs(DriveForce(position, velocity, data->qacc[v])), kSoftDrive * weight)
        << "sample " << sample;
    const double reversed = DriveForce(position, velocity, -data->qacc[v]);
    largest_reversed = std::max(largest_reversed, std::abs(reversed));
    moved = std::max(moved, std::abs(data->qpos[q]));
  }
  EXPECT_GT(largest_reversed, 0.5 * weight);  // the same motion with the wrong sign
  EXPECT_GT(moved, 0.1);                      // it did fall
}

INSTANTIATE_TEST_SUITE_P(All, MujocoMotion,
                         testing::Values(Falling{"four-bar", "main"},
                                         Falling{"slider-crank", "main"},
                                         Falling{"spherical-four-bar", "input"},
                                         Falling{"bennett", "input"}),
                         [](const auto& info) { return TestName(info.param.name); });

}  // namespace
}  // namespace vmech
