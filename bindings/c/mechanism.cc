#include <stdexcept>
#include <utility>

#include "handles.h"
#include "vmech/bindings/shared/parametric.h"
#include "vmech/bindings/shared/posed_mechanism.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/validity.h"

namespace vmech::c {
namespace {

void Take(ParametricMechanism read, vmech_mechanism* handle) {
  handle->mechanism = std::move(read.mechanism);
  handle->freedoms = NamesOfAllFreedoms(handle->mechanism);
  handle->parameters = std::move(read.parameters);
}

/// An x axis for a z axis alone.
Vector3d AnyAcross(const Vector3d& z) {
  Eigen::Index least = 0;
  z.cwiseAbs().minCoeff(&least);
  return Vector3d::Unit(least);
}

Posed PoseOfAnchor(const vmech_anchor& anchor) {
  const Vector3d z = VectorOf(anchor.z), x = VectorOf(anchor.x);
  Posed X;
  X.p = VectorOf(anchor.origin);
  if (!z.isZero(0)) {
    X.R = AxesFromZX(z, x.isZero(0) ? AnyAcross(z) : x);
  } else if (!x.isZero(0)) {
    X.R = AxesFromZX(Vector3d::UnitZ(), x);
  }
  return X;
}

AnchorId AddAnchor(const std::string& name, const vmech_anchor& anchor, Mechanism* mechanism) {
  Link& link = mechanism->links[anchor.link];
  link.anchors.push_back({name, PoseOfAnchor(anchor)});
  return {anchor.link, static_cast<int>(link.anchors.size()) - 1};
}

JointType TypeOf(vmech_joint_type type) {
  constexpr JointType kTypes[] = {
      JointType::kRevolute,  JointType::kPrismatic, JointType::kCylindrical, JointType::kScrew,
      JointType::kUniversal, JointType::kSpherical, JointType::kPlanar,      JointType::kWeld};
  RequireIndex("joint.type", type, std::size(kTypes));
  return kTypes[type];
}

void AddLink(const vmech_link& given, Mechanism* mechanism) {
  RequirePointer("link.name", given.name);
  const double* i = given.inertia;
  Link link{given.name, {given.mass, VectorOf(given.center), {}}, {}};
  link.mass_properties.I_Lcm << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  mechanism->links.push_back(std::move(link));
}

void AddJoint(const vmech_joint& given, Mechanism* mechanism) {
  RequirePointer("joint.name", given.name);
  RequireIndex("joint.first.link", given.first.link, mechanism->links.size());
  RequireIndex("joint.second.link", given.second.link, mechanism->links.size());
  const JointType type = TypeOf(given.type);
  const AnchorId first = AddAnchor(given.name, given.first, mechanism);
  const AnchorId second = AddAnchor(given.name, given.second, mechanism);
  Joint joint = MakeJoint(given.name, type, first, second);
  joint.pitch = given.pitch;
  if (given.start != nullptr) {
    joint.start.assign(given.start, given.start + CoordinatesOf(type));
    joint.start_given = true;
  }
  mechanism->joints.push_back(std::move(joint));
}

const std::string* NameOf(const vmech_mechanism& handle, vmech_item item, size_t index) {
  const Mechanism& m = handle.mechanism;
  switch (item) {
    case VMECH_LINKS:
      return index < m.links.size() ? &m.links[index].name : nullptr;
    case VMECH_JOINTS:
      return index < m.joints.size() ? &m.joints[index].name : nullptr;
    case VMECH_GRASPS:
      return index < m.grasps.size() ? &m.grasps[index].name : nullptr;
    case VMECH_FREEDOMS:
      return index < handle.freedoms.size() ? &handle.freedoms[index] : nullptr;
    default:
      return nullptr;
  }
}

bool Failed(const HandleState* handle) {
  return StatusOf(handle) != VMECH_OK;
}

}  // namespace
}  // namespace vmech::c

using namespace vmech::c;

vmech_mechanism* vmech_mechanism_open(const char* path) {
  return vmech_mechanism_open_with(path, nullptr);
}

vmech_mechanism* vmech_mechanism_open_with(const char* path, const vmech_read_options* options) {
  return Make<vmech_mechanism>([&](vmech_mechanism* handle) {
    RequirePointer("path", path);
    Take(vmech::ReadParametric(vmech::ReadTextFile(path), path, SettingsOf(options)), handle);
  });
}

vmech_mechanism* vmech_mechanism_parse(const char* text, const char* name) {
  return vmech_mechanism_parse_with(text, name, nullptr);
}

vmech_mechanism* vmech_mechanism_parse_with(const char* text, const char* name,
                                            const vmech_read_options* options) {
  return Make<vmech_mechanism>([&](vmech_mechanism* handle) {
    RequirePointer("text", text);
    RequirePointer("name", name);
    Take(vmech::ReadParametric(text, name, SettingsOf(options)), handle);
  });
}

vmech_status vmech_mechanism_parameter(const vmech_mechanism* mechanism, size_t index,
                                       vmech_parameter* parameter) {
  if (mechanism == nullptr) return VMECH_OUT_OF_MEMORY;
  return ParameterAt(mechanism, mechanism->parameters, index, parameter);
}

vmech_mechanism* vmech_mechanism_new(const char* name) {
  return Make<vmech_mechanism>([&](vmech_mechanism* handle) {
    RequirePointer("name", name);
    handle->mechanism.name = name;
  });
}

int32_t vmech_add_link(vmech_mechanism* mechanism, const vmech_link* link) {
  Do(mechanism, [&] { AddLink(Read("link", link), &mechanism->mechanism); });
  return Failed(mechanism) ? -1 : static_cast<int32_t>(mechanism->mechanism.links.size()) - 1;
}

int32_t vmech_add_joint(vmech_mechanism* mechanism, const vmech_joint* joint) {
  Do(mechanism, [&] {
    AddJoint(Read("joint", joint), &mechanism->mechanism);
    mechanism->freedoms = vmech::NamesOfAllFreedoms(mechanism->mechanism);
  });
  return Failed(mechanism) ? -1 : static_cast<int32_t>(mechanism->mechanism.joints.size()) - 1;
}

int32_t vmech_add_grasp(vmech_mechanism* mechanism, const char* name, const vmech_anchor* frame,
                        int32_t is_point) {
  Do(mechanism, [&] {
    RequirePointer("name", name);
    RequirePointer("frame", frame);
    vmech::RequireIndex("frame.link", frame->link, mechanism->mechanism.links.size());
    const vmech::GraspKind kind = is_point ? vmech::GraspKind::kPoint : vmech::GraspKind::kRigid;
    mechanism->mechanism.grasps.push_back({name, frame->link, PoseOfAnchor(*frame), kind});
  });
  return Failed(mechanism) ? -1 : static_cast<int32_t>(mechanism->mechanism.grasps.size()) - 1;
}

vmech_status vmech_set_gravity(vmech_mechanism* mechanism, const double gravity[3]) {
  return Do(mechanism, [&] {
    RequirePointer("gravity", gravity);
    mechanism->mechanism.gravity_W = VectorOf(gravity);
  });
}

size_t vmech_mechanism_count(const vmech_mechanism* mechanism, vmech_item item) {
  size_t count = 0;
  while (!Failed(mechanism) && NameOf(*mechanism, item, count) != nullptr) ++count;
  return count;
}

const char* vmech_mechanism_name(const vmech_mechanism* mechanism, vmech_item item, size_t index) {
  const std::string* name = Failed(mechanism) ? nullptr : NameOf(*mechanism, item, index);
  return name == nullptr ? nullptr : name->c_str();
}

int32_t vmech_mechanism_find(const vmech_mechanism* mechanism, vmech_item item, const char* name) {
  if (name == nullptr || Failed(mechanism)) return -1;
  for (size_t i = 0; const std::string* here = NameOf(*mechanism, item, i); ++i) {
    if (*here == name) return static_cast<int32_t>(i);
  }
  return -1;
}
