#include "vmech/apps/drawing/sheet.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

using plot::Point;

constexpr double kMargin = 64;      // around the pivots, for symbols and names
constexpr double kTallest = 420;    // from the highest pivot to the lowest
constexpr double kOnePlace = 1e-9;  // [m]

bool AreOnePlace(const std::vector<Vector3d>& places) {
  return std::all_of(places.begin(), places.end(),
                     [&](const Vector3d& p) { return (p - places.front()).norm() < kOnePlace; });
}

struct Box {
  Point least{INFINITY, INFINITY}, greatest{-INFINITY, -INFINITY};

  void Add(const Point& p) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    greatest = {std::max(greatest.x, p.x), std::max(greatest.y, p.y)};
  }
  double width() const { return std::max(0.0, greatest.x - least.x); }
  double height() const { return std::max(0.0, greatest.y - least.y); }
};

}  // namespace

Sheet::Sheet(const KinematicTree& tree)
    : mechanism(tree.mechanism), X_WL(LinkPoses(tree)), view(ViewOf(mechanism, X_WL)) {
  FitIn(0.25 * tree.length);
}

Point Sheet::At(const Vector3d& p_W) const {
  return {origin.x + scale * view.right.dot(p_W), origin.y - scale * view.up.dot(p_W)};
}

Vector3d Sheet::AnchorInWorld(AnchorId id) const {
  return X_WL[id.link] * mechanism.anchor(id).X_LA.p;
}

Vector3d Sheet::GraspInWorld(const Grasp& grasp) const {
  return X_WL[grasp.link] * grasp.X_LG.p;
}

Vector3d Sheet::AxisInWorld(const Joint& joint) const {
  return X_WL[joint.first.link].R * mechanism.anchor(joint.first).X_LA.R.col(2);
}

Point Sheet::Direction(const Vector3d& axis_W) const {
  return {view.right.dot(axis_W), -view.up.dot(axis_W)};
}

std::vector<Vector3d> Sheet::PlacesOf(int link) const {
  std::vector<Vector3d> places;
  for (const Joint& joint : mechanism.joints) {
    for (const AnchorId id : {joint.first, joint.second}) {
      if (id.link == link) places.push_back(AnchorInWorld(id));
    }
  }
  if (link == mechanism.ground || !AreOnePlace(places)) return places;
  for (const Grasp& grasp : mechanism.grasps) {
    if (grasp.link == link) places.push_back(GraspInWorld(grasp));
  }
  const MassProperties& mass = mechanism.links[link].mass_properties;
  if (AreOnePlace(places) && mass.mass > 0) places.push_back(X_WL[link] * mass.p_LoLcm);
  return places;
}

/// The largest scale at which everything has room, but what is smaller than `least_extent` [m] is
/// not blown up.
void Sheet::FitIn(double least_extent) {
  Box box;
  const auto add = [&](const Vector3d& p) { box.Add({view.right.dot(p), -view.up.dot(p)}); };
  for (int link = 0; link < static_cast<int>(mechanism.links.size()); ++link) {
    for (const Vector3d& place : PlacesOf(link)) add(place);
  }
  for (const Grasp& grasp : mechanism.grasps) add(GraspInWorld(grasp));
  if (std::isinf(box.least.x)) box.Add({0, 0});
  const double room = width - 2 * kMargin;
  scale = std::min(room / std::max(box.width(), least_extent),
                   kTallest / std::max(box.height(), least_extent));
  origin = {width / 2 - scale * 0.5 * (box.least.x + box.greatest.x),
            top + kMargin - scale * box.least.y};
  bottom = top + 2 * kMargin + scale * box.height();
}

}  // namespace vmech
