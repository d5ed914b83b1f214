#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vmech/apps/ik/ik.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

/// In one word: what came of it.
std::string_view Verdict(const IkAnswer& answer) {
  switch (answer.summary.status) {
    case SolveStatus::kConverged:
      return answer.reached ? "reached" : "out of reach";
    case SolveStatus::kBiased:
      return answer.reached ? "reached" : "biased";
    case SolveStatus::kUnavailable:
      return "not available";
    default:
      return "not solved";
  }
}

std::string_view Explanation(const IkAnswer& answer) {
  if (answer.summary.status == SolveStatus::kBiased) {
    return "the nearest pose, with the loops open by what the penalty leaves";
  }
  if (!answer.summary.converged()) return "this is the best pose that was found";
  return answer.reached ? "the grasp is where the hand is"
                        : "the nearest pose that loops and limits allow";
}

std::string_view NameOf(IkBranch branch) {
  switch (branch) {
    case IkBranch::kSame:
      return "same";
    case IkBranch::kOther:
      return "other";
    case IkBranch::kUnknown:
      break;
  }
  return "unknown";
}

std::string_view Explanation(IkBranch branch) {
  switch (branch) {
    case IkBranch::kSame:
      return "that of the start: a hand that moves straight to the target leads here";
    case IkBranch::kOther:
      return "another than that of the start: a hand that moves straight to the target leads "
             "elsewhere";
    case IkBranch::kUnknown:
      break;
  }
  return "not known: a hand that moves straight to the target does not arrive";
}

std::string Vector(const Vector3d& v, double unit) {
  // What is rounding beside the largest component is shown as 0.
  const double negligible = 1e-12 * v.cwiseAbs().maxCoeff();
  std::string text;
  for (double x : v) {
    text +=
        fmt::format("{}{:.6g}", text.empty() ? "" : "  ", std::abs(x) > negligible ? x / unit : 0);
  }
  return text;
}

Vector3d RotationVector(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

std::string PoseLine(const IkAnswer& answer, const Posed& X) {
  std::string text = fmt::format("{} {}", Vector(X.p, answer.units.length), answer.length_unit);
  if (answer.grasp.kind == GraspKind::kPoint) return text + "\n";
  return text + fmt::format("   turned by  {} {}\n",
                            Vector(RotationVector(X.R), answer.units.angle), answer.angle_unit);
}

/// Coordinates of a tree joint in the units of the file, or "cut".
std::string JointValue(const IkAnswer& answer, size_t joint) {
  std::string text;
  for (const TreeNode& node : answer.tree.nodes) {
    if (node.joint != static_cast<int>(joint) || node.q < 0) continue;
    if (!text.empty()) text += ", ";
    const Joint& of = answer.tree.mechanism.joints[joint];
    if (FreedomsOf(of.type) > 1 && node.motion != NodeMotion::kSpherical) {
      text += NameOfFreedom(of.type, node.freedom) + " ";
    }
    const double value = answer.summary.x[node.q];
    if (node.motion == NodeMotion::kSpherical) {
      const auto q = answer.summary.x.segment<4>(node.q);
      text += fmt::format("quaternion {:.6f} {:.6f} {:.6f} {:.6f}", q[0], q[1], q[2], q[3]);
    } else if (node.motion == NodeMotion::kPrismatic) {
      text += fmt::format("{:.8g} {}", value / answer.units.length, answer.length_unit);
    } else {
      text += fmt::format("{:.8g} {}", value / answer.units.angle, answer.angle_unit);
    }
  }
  if (!text.empty()) return text;
  return answer.tree.placements[joint].tree_node < 0 ? "cut" : "-";
}

std::string JointLines(const IkAnswer& answer) {
  const std::vector<Joint>& joints = answer.tree.mechanism.joints;
  size_t width = 10;
  for (const Joint& joint : joints) width = std::max(width, joint.name.size());
  std::string text = "joints\n";
  for (size_t j = 0; j < joints.size(); ++j) {
    text += fmt::format("  {:<{}}  {}\n", joints[j].name, width, JointValue(answer, j));
  }
  if (answer.tree.loops.empty()) return text;
  text += "what closes the loops against the hand's pull (first link on second, its axes)\n";
  for (size_t l = 0; l < answer.tree.loops.size(); ++l) {
    const Wrenchd& w = answer.cut_wrenches[l];
    text += fmt::format("  {:<{}}  {} N   {} N m\n", joints[answer.tree.loops[l].joint].name, width,
                        Vector(w.force, 1), Vector(w.moment, 1));
  }
  return text;
}

std::string SolverLines(const IkAnswer& answer) {
  const Summary& s = answer.summary;
  return fmt::format(
      "solver      {}: {}, {} iterations, {} evaluations, {:.3g} ms\n"
      "            {}\n"
      "KKT error   {:.2g}\n",
      s.solver, NameOf(s.status), s.iterations, s.evaluations, 1e3 * s.seconds, s.message,
      s.kkt_error);
}

Json Numbers(const Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json PoseJson(const Posed& X) {
  const Eigen::Quaterniond q(X.R);
  return {{"position", Numbers(X.p)}, {"quaternion", {q.w(), q.x(), q.y(), q.z()}}};
}

/// "rz", or for a ball "qw".
std::string NameOfCoordinate(const Joint& joint, const TreeNode& node, int k) {
  constexpr const char* kQuaternion[] = {"qw", "qx", "qy", "qz"};
  if (node.motion == NodeMotion::kSpherical) return kQuaternion[k];
  return NameOfFreedom(joint.type, node.freedom);
}

}  // namespace

std::string TextReport(const IkAnswer& answer) {
  const Mechanism& m = answer.tree.mechanism;
  const bool rigid = answer.grasp.kind == GraspKind::kRigid;
  std::string text = fmt::format("{}, held at '{}' on {}, {}\n\n", m.name, answer.grasp.name,
                                 m.links[answer.grasp.link].name, rigid ? "rigid" : "point");
  text += fmt::format("verdict     {}: {}\n", Verdict(answer), Explanation(answer));
  text += "hand        " + PoseLine(answer, answer.X_WH);
  text += "grasp       " + PoseLine(answer, answer.X_WG);
  text += fmt::format("e1          {:.4g} {}", answer.e1.head<3>().norm() / answer.units.length,
                      answer.length_unit);
  if (rigid) {
    text += fmt::format(" and {:.4g} {}", answer.e1.tail<3>().norm() / answer.units.angle,
                        answer.angle_unit);
  }
  text += " from the grasp to the hand\n";
  if (!answer.tree.loops.empty()) {
    text += fmt::format("e2          {:.2g} {} and {:.2g} {} at most, open loops\n",
                        answer.open_length / answer.units.length, answer.length_unit,
                        answer.open_angle / answer.units.angle, answer.angle_unit);
  }
  text += SolverLines(answer);
  text += fmt::format("branch      {}\n", Explanation(answer.branch)) + JointLines(answer);
  const Vector6d& K = answer.stiffness;
  text += fmt::format("for a hand of {} N/m and {} N m/rad\n", Vector(K.head<3>(), 1),
                      Vector(K.tail<3>(), 1));
  for (const std::string& warning : answer.warnings) text += "warning: " + warning + "\n";
  return text;
}

std::string JsonReport(const IkAnswer& answer) {
  const Summary& s = answer.summary;
  const Mechanism& m = answer.tree.mechanism;
  Json json{
      {"mechanism", m.name},
      {"grasp", answer.grasp.name},
      {"kind", answer.grasp.kind == GraspKind::kRigid ? "rigid" : "point"},
      {"verdict", Verdict(answer)},
      {"reached", answer.reached},
      {"branch", NameOf(answer.branch)},
      {"solver", s.solver},
      {"status", NameOf(s.status)},
      {"message", s.message},
      {"iterations", s.iterations},
      {"evaluations", s.evaluations},
      {"seconds", s.seconds},
      {"hand", PoseJson(answer.X_WH)},
      {"grasp_pose", PoseJson(answer.X_WG)},
      {"e1",
       {{"position", Numbers(answer.e1.head<3>())}, {"rotation", Numbers(answer.e1.tail<3>())}}},
      {"e2", {{"length", answer.open_length}, {"angle", answer.open_angle}}},
      {"kkt_error", s.kkt_error},
      {"bias_bound", s.bias_bound},
      {"stiffness", std::vector<double>(answer.stiffness.begin(), answer.stiffness.end())}};
  for (size_t j = 0; j < m.joints.size(); ++j) {
    Json values = Json::array(), names = Json::array();
    for (const TreeNode& node : answer.tree.nodes) {
      if (node.joint != static_cast<int>(j) || node.q < 0) continue;
      const int count = node.motion == NodeMotion::kSpherical ? 4 : 1;
      for (int k = 0; k < count; ++k) values.push_back(s.x[node.q + k]);
      for (int k = 0; k < count; ++k) names.push_back(NameOfCoordinate(m.joints[j], node, k));
    }
    json["joints"].push_back({{"name", m.joints[j].name},
                              {"cut", answer.tree.placements[j].tree_node < 0},
                              {"coordinates", names},
                              {"values", values}});
  }
  json["loops"] = Json::array();
  for (size_t l = 0; l < answer.tree.loops.size(); ++l) {
    json["loops"].push_back({{"cut", m.joints[answer.tree.loops[l].joint].name},
                             {"force", Numbers(answer.cut_wrenches[l].force)},
                             {"moment", Numbers(answer.cut_wrenches[l].moment)}});
  }
  json["warnings"] = answer.warnings;
  return json.dump(2) + "\n";
}

}  // namespace vmech
