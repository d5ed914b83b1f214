// What a mechanism carries does not depend on how it is written down or computed.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

#include "driven_examples.h"
#include "free_bodies.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

constexpr double kSame = 1e-9;  // the promise of the project, relative

class EveryStudy : public testing::TestWithParam<DrivenExample> {
 protected:
  EveryStudy() : study_(StudyOf(GetParam().name)), result_(RunLoadStudy(study_)) {}

  /// Joints that can be cut alone: not driven, and on a loop.
  std::vector<int> AdmissibleCuts() const {
    std::vector<int> cuts;
    SpanningTreeOptions options;
    for (const JointDrive& drive : study_.drives) options.keep.push_back(drive.joint);
    for (int j = 0; j < static_cast<int>(study_.mechanism.joints.size()); ++j) {
      options.cut = {j};
      const std::vector<int> chosen = FindSpanningTree(study_.mechanism, options).cuts;
      if (std::find(chosen.begin(), chosen.end(), j) != chosen.end()) cuts.push_back(j);
    }
    return cuts;
  }

  LoadStudy study_;
  LoadStudyResult result_;
};

TEST_P(EveryStudy, IsTheSameWhereverItsLoopsAreCut) {
  const std::vector<int> cuts = AdmissibleCuts();
  EXPECT_EQ(cuts.empty(), result_.cut_joints.empty());
  for (const ReactionRule rule : {ReactionRule::kStiffness, ReactionRule::kMinimumNorm}) {
    study_.rule = rule;
    study_.mechanism.preferred_cuts.clear();
    const LoadStudyResult expected = RunLoadStudy(study_);
    for (const int cut : cuts) {
      study_.mechanism.preferred_cuts = {cut};
      const LoadStudyResult result = RunLoadStudy(study_);
      const std::string& name = study_.mechanism.joints[cut].name;
      EXPECT_NE(std::find(result.cut_joints.begin(), result.cut_joints.end(), name),
                result.cut_joints.end());
      EXPECT_LE(RelativeDifference(study_.mechanism, expected, result), kSame) << name;
      EXPECT_EQ(result.certainty, expected.certainty) << name;
    }
  }
}

/// Every moving link drawn in another frame, chosen at random.
LoadStudy Redrawn(LoadStudy study) {
  Random random(5);
  for (size_t i = 0; i < study.mechanism.links.size(); ++i) {
    if (static_cast<int>(i) == study.mechanism.ground) continue;
    const VectorXd axis = random.Vector(3), shift = random.Vector(3, 0.2);
    const Posed X{Eigen::AngleAxisd(random.Between(0, 3), Vector3d(axis.normalized())).matrix(),
                  shift};
    Link& link = study.mechanism.links[i];
    for (Anchor& anchor : link.anchors) anchor.X_LA = X * anchor.X_LA;
    MassProperties& mass = link.mass_properties;
    mass.p_LoLcm = X * mass.p_LoLcm;
    mass.I_Lcm = X.R * mass.I_Lcm * X.R.transpose();
    for (ExternalLoad& load : study.external) {
      if (load.link == static_cast<int>(i)) load.p_L = X * load.p_L;
    }
  }
  return study;
}

TEST_P(EveryStudy, IsTheSameInWhateverFramesItsLinksAreDrawn) {
  const LoadStudyResult result = RunLoadStudy(Redrawn(study_));
  EXPECT_LE(RelativeDifference(study_.mechanism, result_, result), kSame);
  EXPECT_EQ(result.certainty, result_.certainty);
}

/// The world turned about all of its axes, gravity and the loads with it.
LoadStudy Turned(LoadStudy study) {
  const Matrix3d R =
      Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.5, 0.7).normalized()).toRotationMatrix();
  Mechanism& mechanism = study.mechanism;
  for (Anchor& anchor : mechanism.links[mechanism.ground].anchors) {
    anchor.X_LA = Posed{R, Vector3d(0.1, 0.2, -0.3)} * anchor.X_LA;
  }
  mechanism.gravity_W = R * mechanism.gravity_W;
  for (ExternalLoad& load : study.external) {
    for (Wrenchd& W : load.wrenches) W = W.In(R.transpose());
  }
  return study;
}

TEST_P(EveryStudy, IsTheSameHoweverItStandsInTheWorld) {
  const LoadStudyResult result = RunLoadStudy(Turned(study_));
  EXPECT_LE(RelativeDifference(study_.mechanism, result_, result), kSame);
  EXPECT_EQ(result.certainty, result_.certainty);
}

/// A mechanism as a file, lengths and angles in units of the given size.
class FileWriter {
 public:
  FileWriter(const Mechanism& mechanism, const std::string& length, double metre,
             const std::string& angle, double radian)
      : mechanism_(mechanism), metre_(metre), radian_(radian) {
    out_.precision(17);
    out_ << "vmech: \"1.0\"\nname: " << mechanism.name << "\nunits: {length: " << length
         << ", angle: " << angle << "}\ngravity: " << Row(mechanism.gravity_W)
         << "\nground: " << mechanism.links[mechanism.ground].name << "\nlinks:\n";
    for (const Link& link : mechanism.links) Write(link);
    out_ << "joints:\n";
    for (const Joint& joint : mechanism.joints) Write(joint);
  }
  std::string text() const { return out_.str(); }

 private:
  template <typename List>
  static std::string Row(const List& list) {
    std::ostringstream row;
    row.precision(17);
    for (size_t i = 0; i < static_cast<size_t>(list.size()); ++i) {
      row << (i == 0 ? "[" : ", ") << list[i];
    }
    return row.str() + "]";
  }

  void Write(const Link& link) {
    const MassProperties& mass = link.mass_properties;
    const Matrix3d I = mass.I_Lcm * metre_ * metre_;
    out_ << "  " << link.name << ":\n    mass: " << mass.mass << "\n";
    if (mass.mass > 0) {
      out_ << "    center_of_gravity: " << Row(Vector3d(mass.p_LoLcm * metre_))
           << "\n    inertia: {about: center_of_gravity, xx: " << I(0, 0) << ", yy: " << I(1, 1)
           << ", zz: " << I(2, 2) << ", xy: " << I(0, 1) << ", xz: " << I(0, 2)
           << ", yz: " << I(1, 2) << "}\n";
    }
    out_ << "    anchors:\n";
    for (const Anchor& anchor : link.anchors) {
      out_ << "      " << anchor.name << ": {origin: " << Row(Vector3d(anchor.X_LA.p * metre_))
           << ", z: " << Row(Vector3d(anchor.X_LA.R.col(2)))
           << ", x: " << Row(Vector3d(anchor.X_LA.R.col(0))) << "}\n";
    }
  }

  double UnitOf(const Joint& joint) const {
    return joint.type == JointType::kPrismatic ? metre_ : radian_;
  }

  void Write(const Joint& joint) {
    std::vector<double> start = joint.start;
    if (joint.type != JointType::kSpherical) {
      for (double& value : start) value *= UnitOf(joint);
    }
    const auto name = [&](AnchorId id) {
      return mechanism_.links[id.link].name + "/" + mechanism_.anchor(id).name;
    };
    out_ << "  " << joint.name << ": {type: " << NameOf(joint.type) << ", connects: ["
         << name(joint.first) << ", " << name(joint.second) << "], start: " << Row(start);
    if (joint.stiffness) out_ << ", stiffness: " << Row(*joint.stiffness);
    if (FreedomsOf(joint.type) == 1) {
      const Passive& p = joint.passive[0];
      if (p.viscous > 0) out_ << ", viscous: " << p.viscous;
      if (p.stiffness > 0) {
        out_ << ", spring: {stiffness: " << p.stiffness << ", rest: " << p.rest * UnitOf(joint)
             << "}";
      }
    }
    out_ << "}\n";
  }

  const Mechanism& mechanism_;
  double metre_, radian_;
  std::ostringstream out_;
};

TEST_P(EveryStudy, IsTheSameInMillimetresAndDegrees) {
  constexpr double kDegreesPerRadian = 57.295779513082320877;
  const FileWriter file(study_.mechanism, "mm", 1000, "deg", kDegreesPerRadian);
  study_.mechanism = ParseMechanism(file.text(), "in mm and deg");
  const LoadStudyResult result = RunLoadStudy(study_);
  EXPECT_LE(RelativeDifference(study_.mechanism, result_, result), kSame);
  EXPECT_EQ(result.certainty, result_.certainty);
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryStudy, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

}  // namespace
}  // namespace vmech
