#include "free_bodies.h"

#include <Eigen/Dense>

namespace vmech {
namespace {

Matrix6Xd Columns(std::initializer_list<int> units) {
  Matrix6Xd S = Matrix6Xd::Zero(6, static_cast<Eigen::Index>(units.size()));
  Eigen::Index k = 0;
  for (int unit : units) S(unit, k++) = 1;
  return S;
}

Matrix6Xd Freedoms(const Joint& joint, const Matrix3d& R_FM) {
  enum { kX, kY, kZ, kAboutX, kAboutY, kAboutZ };
  switch (joint.type) {
    case JointType::kRevolute:
      return Columns({kAboutZ});
    case JointType::kPrismatic:
      return Columns({kZ});
    case JointType::kCylindrical:
      return Columns({kZ, kAboutZ});
    case JointType::kScrew: {
      Matrix6Xd S = Columns({kAboutZ});
      S(kZ, 0) = joint.pitch;
      return S;
    }
    case JointType::kUniversal: {
      Matrix6Xd S = Columns({kAboutX, kAboutY});
      S.col(1) << Vector3d::Zero(), R_FM.col(1);
      return S;
    }
    case JointType::kSpherical:
      return Columns({kAboutX, kAboutY, kAboutZ});
    case JointType::kPlanar:
      return Columns({kX, kY, kAboutZ});
    case JointType::kWeld:
      break;
  }
  return Columns({});
}

/// Orthonormal complement of the freedoms: of power zero, as both are [linear; angular].
Matrix6Xd Held(const Matrix6Xd& freedoms) {
  if (freedoms.cols() == 0) return Matrix6d::Identity();
  const Eigen::JacobiSVD<MatrixXd> svd(freedoms, Eigen::ComputeFullU);
  return svd.matrixU().rightCols(6 - freedoms.cols());
}

MatrixXd Append(const MatrixXd& left, const MatrixXd& right) {
  MatrixXd both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

Posed AnchorInWorld(const Mechanism& mechanism, std::span<const LinkMotion> links, AnchorId id) {
  return links[id.link].X_WL * mechanism.anchor(id).X_LA;
}

}  // namespace

FreeJoint CutFree(const Mechanism& mechanism, std::span<const LinkMotion> links, int joint) {
  const Joint& j = mechanism.joints[joint];
  const Posed X_WF = AnchorInWorld(mechanism, links, j.first);
  const Posed X_WM = AnchorInWorld(mechanism, links, j.second);
  FreeJoint free{X_WF.R, X_WF.R.transpose() * X_WM.R, X_WF.p, X_WM.p, {}, {}};
  free.freedoms = Freedoms(j, free.R_FM);
  free.held = Held(free.freedoms);
  return free;
}

Vector6d RelativeTwist(const Mechanism& mechanism, std::span<const LinkMotion> links, int joint) {
  const Joint& j = mechanism.joints[joint];
  const FreeJoint free = CutFree(mechanism, links, joint);
  auto velocity = [&](const LinkMotion& link) -> Vector3d {
    return link.v + link.w.cross(free.p_WM - link.X_WL.p);
  };
  const LinkMotion &first = links[j.first.link], &second = links[j.second.link];
  Vector6d V;
  V << free.R_WF.transpose() * (velocity(second) - velocity(first)),
      free.R_WF.transpose() * (second.w - first.w);
  return V;
}

Vector3d CentreOfGravity(const Link& link, const LinkMotion& motion) {
  return motion.X_WL * link.mass_properties.p_LoLcm;
}

Wrenchd NeededWrench(const Mechanism& mechanism, const Link& link, const LinkMotion& motion) {
  const Vector3d r = CentreOfGravity(link, motion) - motion.X_WL.p;
  const Vector3d a = motion.a + motion.alpha.cross(r) + motion.w.cross(motion.w.cross(r));
  const Matrix3d I = motion.X_WL.R * link.mass_properties.I_Lcm * motion.X_WL.R.transpose();
  return {link.mass_properties.mass * (a - mechanism.gravity_W),
          I * motion.alpha + motion.w.cross(I * motion.w)};
}

Wrenchd LoadAbout(const ExternalLoad& load, const LinkMotion& motion, const Vector3d& p_W) {
  Wrenchd W = load.wrenches.front();
  if (load.axes == ExternalLoad::Axes::kLink) W = W.In(motion.X_WL.R.transpose());
  return W.ShiftedBy(motion.X_WL * load.p_L - p_W);
}

std::vector<Wrenchd> NeededOfJoints(const LoadStudy& study, const PoseLoads& pose) {
  const Mechanism& mechanism = study.mechanism;
  std::vector<Wrenchd> needed;
  for (size_t i = 0; i < mechanism.links.size(); ++i) {
    needed.push_back(NeededWrench(mechanism, mechanism.links[i], pose.links[i]));
  }
  for (const ExternalLoad& load : study.external) {
    const LinkMotion& motion = pose.links[load.link];
    needed[load.link] -=
        LoadAbout(load, motion, CentreOfGravity(mechanism.links[load.link], motion));
  }
  return needed;
}

EquilibriumProblem FormEquilibrium(const LoadStudy& study, const PoseLoads& pose) {
  const Mechanism& mechanism = study.mechanism;
  const int ground = mechanism.ground;
  auto row = [&](int link) { return 6 * (link < ground ? link : link - 1); };
  const Eigen::Index rows = 6 * (static_cast<Eigen::Index>(mechanism.links.size()) - 1);
  EquilibriumProblem problem;
  problem.A.resize(rows, 0);
  problem.b = VectorXd::Zero(rows);
  const std::vector<Wrenchd> needed = NeededOfJoints(study, pose);
  for (int i = 0; i < static_cast<int>(needed.size()); ++i) {
    if (i != ground) problem.b.segment<6>(row(i)) = needed[i].Stacked();
  }
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const FreeJoint joint = CutFree(mechanism, pose.links, static_cast<int>(j));
    MatrixXd on_links = MatrixXd::Zero(rows, 6);
    auto act_on = [&](int link, double sign) {
      if (link == ground) return;
      const Vector3d p_W = CentreOfGravity(mechanism.links[link], pose.links[link]);
      for (int k = 0; k < 6; ++k) {
        const Vector6d W_F = sign * Vector6d::Unit(k);
        const Wrenchd W{joint.R_WF * W_F.head<3>(), joint.R_WF * W_F.tail<3>()};
        on_links.block<6, 1>(row(link), k) += W.ShiftedBy(joint.p_WM - p_W).Stacked();
      }
    };
    act_on(mechanism.joints[j].second.link, 1);
    act_on(mechanism.joints[j].first.link, -1);
    Matrix6Xd driven(6, 0);
    for (const JointDrive& drive : study.drives) {
      if (drive.joint != static_cast<int>(j)) continue;
      driven = Append(driven, joint.freedoms.col(drive.freedom));
    }
    problem.first_column.push_back(static_cast<int>(problem.A.cols()));
    problem.wrenches.push_back(Append(joint.held, driven));
    problem.A = Append(problem.A, on_links * problem.wrenches.back());
    problem.joints.push_back(joint);
    problem.on_links.push_back(on_links);
    problem.driven.push_back(driven);
  }
  return problem;
}

std::vector<Wrenchd> JointWrenches(const EquilibriumProblem& problem, const VectorXd& x) {
  std::vector<Wrenchd> joints;
  for (size_t j = 0; j < problem.wrenches.size(); ++j) {
    const Vector6d W =
        problem.wrenches[j] * x.segment(problem.first_column[j], problem.wrenches[j].cols());
    joints.push_back({W.head<3>(), W.tail<3>()});
  }
  return joints;
}

}  // namespace vmech
