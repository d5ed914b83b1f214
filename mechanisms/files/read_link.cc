#include "vmech/mechanisms/files/read_link.h"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "vmech/mechanisms/direction.h"
#include "vmech/mechanisms/files/read_body.h"
#include "vmech/mechanisms/files/read_dh.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

enum class InertiaPoint { kCenterOfGravity, kOrigin };
enum class OffDiagonal { kMatrixElements, kProductsOfInertia };

/// The axes x, y, z of a map: z is exact, x is made orthogonal to it. y is a check only.
Matrix3d ReadAxes(const Node& map) {
  constexpr double kSquare = 1e-2;  // [rad] how far y may be from z cross x
  const Node z = map["z"], x = map["x"], y = map["y"];
  if (!z && !x && !y) return Matrix3d::Identity();
  if (!z || !x) {
    map.Error("axes need both 'z' and 'x'");
    return Matrix3d::Identity();
  }
  const Vector3d z_axis = z.Vector3(Vector3d::UnitZ()), x_axis = x.Vector3(Vector3d::UnitX());
  const bool no_z = z_axis == Vector3d::Zero(), no_x = x_axis == Vector3d::Zero();
  if (no_z) z.Error("the z axis has no length");
  if (no_x) x.Error("the x axis has no length");
  if (no_z || no_x) return Matrix3d::Identity();
  Matrix3d R = Matrix3d::Identity();
  try {
    R = AxesFromZX(z_axis, x_axis);
  } catch (const std::invalid_argument& defect) {
    x.Error(defect.what());
    return R;
  }
  if (!y) return R;
  const Vector3d y_axis = NearUnitLength(y.Vector3(R.col(1)));
  if (y_axis == Vector3d::Zero()) {
    y.Error("the y axis has no length");
  } else if (y_axis.dot(R.col(1)) < 0) {
    y.Error("the axes are left-handed; y must be z cross x, the opposite of this");
  } else if (y_axis.normalized().cross(R.col(1)).norm() > kSquare) {
    y.Error("y is not at right angles to z and x; leave it out, it is z cross x");
  }
  return R;
}

/// The inertia matrix as it is written, in the axes of the link, about the point it is written for;
/// not finite if a moment is missing or wrong.
Matrix3d ReadInertiaMatrix(const Node& node, const Units& units) {
  if (const Node principal = node["principal"]) {
    for (const char* key : {"xx", "yy", "zz", "xy", "xz", "yz", "off_diagonal"}) {
      if (const Node extra = node[key]) extra.KeyError("not used beside 'principal'");
    }
    const Node axes = node["axes"];
    if (axes) axes.CheckKeys({"z", "x"}, {"y"});
    const Vector3d moments = principal.Vector3(units.inertia, Vector3d::Constant(kUnknown));
    return RotatedInertia(ReadAxes(axes), moments.asDiagonal());
  }
  if (const Node axes = node["axes"]) axes.KeyError("used with 'principal' only");
  for (const char* key : {"xx", "yy", "zz"}) {
    if (!node[key]) node.KeyError(fmt::format("the key '{}' (or 'principal') is missing", key));
  }
  const OffDiagonal convention = node["off_diagonal"].Word<OffDiagonal>(
      {{"matrix_elements", OffDiagonal::kMatrixElements},
       {"products_of_inertia", OffDiagonal::kProductsOfInertia}},
      OffDiagonal::kMatrixElements);
  const double sign = convention == OffDiagonal::kMatrixElements ? 1 : -1;
  const auto moment = [&](const char* key) { return node[key].Number(units.inertia, kUnknown); };
  const auto off_diagonal = [&](const char* key) { return sign * node[key].Number(units.inertia); };
  return InertiaFromElements(moment("xx"), moment("yy"), moment("zz"), off_diagonal("xy"),
                             off_diagonal("xz"), off_diagonal("yz"));
}

Matrix3d ReadInertia(const Node& node, const Units& units, double mass, const Vector3d& p_LoLcm) {
  if (!node.CheckKeys(
          {}, {"about", "xx", "yy", "zz", "xy", "xz", "yz", "off_diagonal", "principal", "axes"})) {
    return Matrix3d::Zero();
  }
  const Matrix3d written = ReadInertiaMatrix(node, units);
  if (!written.allFinite()) return Matrix3d::Zero();
  const InertiaPoint about = node["about"].Word<InertiaPoint>(
      {{"center_of_gravity", InertiaPoint::kCenterOfGravity}, {"origin", InertiaPoint::kOrigin}},
      InertiaPoint::kCenterOfGravity);
  const Matrix3d I_Lcm = about == InertiaPoint::kOrigin
                             ? InertiaAboutCenterOfGravity(written, mass, p_LoLcm)
                             : written;
  const double scale = written.cwiseAbs().maxCoeff();
  if (mass == 0 && scale > 0) {
    node.KeyError("a link without mass has no inertia; give its mass");
  } else if (std::string defect = InertiaDefect(I_Lcm, scale); !defect.empty()) {
    node.KeyError(defect + "; check the units, 'about' and the sign of xy, xz, yz");
  }
  return I_Lcm;
}

MassProperties ReadMassProperties(const Node& link, const Units& units) {
  MassProperties properties;
  if (const Node mass = link["mass"]) properties.mass = mass.NonNegative(units.mass, 1);
  properties.p_LoLcm = link["center_of_gravity"].Vector3(units.length);
  if (const Node inertia = link["inertia"]) {
    properties.I_Lcm = ReadInertia(inertia, units, properties.mass, properties.p_LoLcm);
  }
  return properties;
}

/// The anchors of a link, of which one may be relative to another.
class AnchorReader {
 public:
  AnchorReader(std::vector<Node> nodes, const Units& units)
      : nodes_(std::move(nodes)), units_(units), states_(nodes_.size()) {
    for (const Node& node : nodes_) anchors_.push_back({node.key(), {}});
  }

  std::vector<Anchor> Read() {
    for (size_t i = 0; i < nodes_.size(); ++i) Visit(i);
    return std::move(anchors_);
  }

 private:
  enum class State { kNew, kOpen, kDone };

  void Visit(size_t i) {
    if (states_[i] != State::kNew) return;
    states_[i] = State::kOpen;
    const Node& node = nodes_[i];
    node.CheckName();
    if (node.CheckKeys({}, {"relative", "origin", "z", "x", "y", "dh"})) {
      anchors_[i].X_LA = ReadFrame(node, units_);
      if (const Node relative = node["relative"]) Move(relative, &anchors_[i].X_LA);
    }
    states_[i] = State::kDone;
  }

  void Move(const Node& relative, Posed* X) {
    const std::string name = relative.Text();
    std::vector<std::string> names;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      names.push_back(nodes_[i].key());
      if (nodes_[i].key() != name) continue;
      if (states_[i] == State::kOpen) {
        return relative.Error("the anchor would be relative to itself, by way of others or not");
      }
      Visit(i);
      *X = anchors_[i].X_LA * *X;
      return;
    }
    if (relative.kind() != Node::Kind::kScalar) return;
    relative.Error(
        fmt::format("the link has no anchor {}{}", Quoted(name), DidYouMean(name, names)));
  }

  std::vector<Node> nodes_;
  const Units& units_;
  std::vector<State> states_;
  std::vector<Anchor> anchors_;
};

/// Mass properties of the bodies of which a link is made.
MassProperties ReadBodies(const Node& node, const Link& link, const Units& units) {
  for (const char* key : {"mass", "center_of_gravity", "inertia"}) {
    if (const Node extra = node[key]) extra.KeyError("not used beside 'bodies', which give it");
  }
  std::vector<BodyNumbers<double>> bodies;
  for (const Node& body : node["bodies"].List()) {
    const BodyNumbers<double> in_itself = ReadBody(body, units);
    bodies.push_back(InFrame(ReadFrameOn(body, link, units), in_itself));
  }
  const BodyNumbers<double> whole = Composed(bodies);
  return {whole.mass, whole.p_cm, whole.I_cm};
}

}  // namespace

Posed ReadFrame(const Node& map, const Units& units) {
  if (const Node dh = map["dh"]) {
    for (const char* key : {"origin", "z", "x", "y"}) {
      if (const Node extra = map[key]) extra.KeyError("not used beside 'dh'");
    }
    return ReadDhRows(dh, units);
  }
  return {ReadAxes(map), map["origin"].Vector3(units.length)};
}

Posed ReadFrameOn(const Node& map, const Link& link, const Units& units) {
  const Posed X = ReadFrame(map, units);
  const Node relative = map["relative"];
  const std::string name = relative.Text();
  if (relative.kind() != Node::Kind::kScalar) return X;
  std::vector<std::string> names;
  for (const Anchor& anchor : link.anchors) {
    if (anchor.name == name) return anchor.X_LA * X;
    names.push_back(anchor.name);
  }
  relative.Error(fmt::format("link {} has no anchor {}{}", Quoted(link.name), Quoted(name),
                             DidYouMean(name, names)));
  return X;
}

Link ReadLink(const Node& node, const Units& units) {
  Link link;
  link.name = node.key();
  node.CheckName();
  if (!node.CheckKeys({"anchors"},
                      {"description", "mass", "center_of_gravity", "inertia", "bodies"})) {
    return link;
  }
  node["description"].Text();
  link.anchors = AnchorReader(node["anchors"].Map(), units).Read();
  link.mass_properties =
      node["bodies"] ? ReadBodies(node, link, units) : ReadMassProperties(node, units);
  return link;
}

}  // namespace vmech
