#pragma once

#include <iterator>
#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "vmech/base/array_memory.h"
#include "vmech/base/pose.h"
#include "vmech/kinematics/motion/motion_law.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Motion of one link's drawing frame, world axes.
struct LinkMotion {
  Posed X_WL;                         ///< the frame's pose in the world
  Vector3d v = Vector3d::Zero();      ///< velocity of Lo [m/s]
  Vector3d w = Vector3d::Zero();      ///< angular velocity [rad/s]
  Vector3d a = Vector3d::Zero();      ///< acceleration of Lo [m/s^2]
  Vector3d alpha = Vector3d::Zero();  ///< angular acceleration [rad/s^2]
};

/// The motion that a motor prescribes, and the force that it takes.
struct DriveSample : MotionSample {
  double force = 0;  ///< along the freedom that it drives [N] or [N m]
};

/// The motion of a joint, and the wrench which its first link exerts on the second, about the
/// second anchor's origin, in the axes of the first anchor.
struct JointSample : Wrenchd {
  /// Coordinates of its freedoms, unwrapped [m] or [rad]; of a spherical joint the rotation vector.
  Vector3d position = Vector3d::Zero();
  /// Rates of these [m/s] or [rad/s]; of a spherical joint the angular velocity of the second
  /// anchor in the first, in axes of the second.
  Vector3d rate = Vector3d::Zero();
  Vector3d acceleration = Vector3d::Zero();  ///< d/dt of `rate`, from the loop equations
};

/// What the hand does to the mechanism at a pose.
struct HandLoad {
  Wrenchd wrench;    ///< w_d at Go, world axes
  double error = 0;  ///< distance that the hand is off the grasp frame [m]
};

/// What friction and idle freedoms make of a pose.
struct PoseState {
  double unresisted = 0;  ///< largest force along an idle freedom without inertia [N] or [N m]
  double along_idle = 0;  ///< largest that acts on one from outside and by friction [N] or [N m]
  /// Load-dependent friction has no equilibrium here: the mechanism locks itself. The joint
  /// wrenches are those of the last iteration.
  bool jammed = false;
  int locking_joint = -1;  ///< where jammed: the joint whose friction takes the most power
  /// The drive stands still and dry friction alone holds what it would have to hold.
  bool held_by_friction = false;
};

/// From a memory resource, but numbers start undefined: they are written once, when they are known.
template <typename T>
struct UndefinedStart : std::pmr::polymorphic_allocator<T> {
  using std::pmr::polymorphic_allocator<T>::polymorphic_allocator;
  /// The same allocator for another type, as the standard asks for.
  template <typename U>
  struct rebind {
    using other = UndefinedStart<U>;  ///< of allocators for another type
  };
  /// Leaves the number undefined.
  template <typename U>
  void construct(U* /*number*/) noexcept {}
  /// Copies a value, as other allocators do.
  template <typename U, typename Value>
  void construct(U* number, const Value& value) {
    *number = value;
  }
  /// A copy's memory is its own, from the heap.
  UndefinedStart select_on_container_copy_construction() const { return {}; }
};

/// The loads at every pose of a study, one array for each quantity with the pose as its first
/// index, so that a program can read a whole history, such as [poses, joints, 6], where it lies.
struct LoadArrays {
  /// Numbers in the order of their indices.
  using Array = std::vector<double, UndefinedStart<double>>;

  /// How many there are of everything.
  struct Shape {
    size_t poses = 0, drives = 0;  ///< of all poses; of joint drives alone
    std::vector<int> freedoms;     ///< of each joint
    size_t links = 0;              ///< 0 if their motion is not wanted
    bool has_hand = false;         ///< a hand drives
    bool has_pose_state = false;   ///< there may be something to say in PoseState
  };

  LoadArrays() = default;
  /// The numbers of the arrays are undefined, everything else has its defaults.
  explicit LoadArrays(const Shape& shape);

  size_t pose_count() const { return times.size(); }  ///< poses
  size_t drive_count = 0;                             ///< joint drives; a hand is none
  /// Joints of the mechanism, those that are cut included.
  size_t joint_count() const { return first_freedom.size() - 1; }
  /// Freedoms of all joints together.
  size_t freedom_count() const { return static_cast<size_t>(first_freedom.back()); }
  size_t link_count = 0;  ///< 0 if their motion was not wanted

  /// One joint at one pose.
  JointSample Joint(size_t pose, size_t joint) const;
  /// What a joint transmits at a pose, as JointSample.
  Wrenchd Wrench(size_t pose, size_t joint) const {
    const double* w = &wrenches[6 * (pose * joint_count() + joint)];
    return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
  }
  /// The motion that a drive prescribes at a pose, and the force that it takes.
  DriveSample Drive(size_t pose, size_t drive) const {
    const size_t at = pose * drive_count + drive;
    return {drives[at], drive_forces[at]};
  }

  ArrayMemory memory;                     ///< where the numbers lie
  std::vector<int> first_freedom{0};      ///< [joints + 1] where a joint's freedoms begin
  std::pmr::vector<double> times;         ///< [poses] [s]
  std::pmr::vector<MotionSample> drives;  ///< [poses, drives] what is prescribed
  Array drive_forces;                     ///< [poses, drives] [N], [N m]
  Array wrenches;                         ///< [poses, joints, fx fy fz mx my mz], as JointSample
  Array positions, rates, accelerations;  ///< [poses, freedoms], as JointSample
  Array powers;                           ///< [poses] power of the drives and the hand together [W]
  /// [poses] power in, less d/dt energy and losses, over the largest sum of the terms at any pose
  /// of the study.
  Array power_errors;
  Array power_error_scales;  ///< [poses] the sum of those terms [W]
  /// [poses] how far the drive is from losing its hold on the mechanism: sin^2 of an angle that is
  /// 0 at a dead centre (DependentSolver::smallest_pivot).
  Array smallest_pivots;
  Array closures;  ///< [poses] loop error that is left, dimensionless as LargestLoopError
  /// [poses, links], empty if LoadStudyOptions::link_motions is off.
  std::pmr::vector<LinkMotion> links;
  std::vector<HandLoad> hands;    ///< [poses], empty unless a hand drives
  std::vector<PoseState> states;  ///< [poses], empty where all would be PoseState()
};

/// The freedoms of each joint, as LoadArrays::Shape asks for them.
std::vector<int> FreedomsOfJoints(const Mechanism& mechanism);

/// Walks over what an object gives by its operator[].
template <typename Range>
class IndexIterator {
 public:
  using iterator_category = std::input_iterator_tag;  ///< each element is made anew
  using value_type = typename Range::value_type;      ///< what operator[] gives
  using difference_type = ptrdiff_t;                  ///< between two indices
  using pointer = void;                               ///< elements have no address
  using reference = value_type;                       ///< by value

  /// The range must outlive it.
  IndexIterator(const Range* range, size_t index) : range_(range), index_(index) {}
  value_type operator*() const { return (*range_)[index_]; }  ///< the element here
  /// Goes on to the next index.
  IndexIterator& operator++() {
    ++index_;
    return *this;
  }
  /// True at the same index; both are of the same range.
  bool operator==(const IndexIterator& other) const { return index_ == other.index_; }

 private:
  const Range* range_;
  size_t index_;
};

/// The joints at one pose.
class JointLoads {
 public:
  using value_type = JointSample;  ///< of the standard's containers

  JointLoads() = default;
  /// The arrays must outlive it.
  JointLoads(const LoadArrays* arrays, size_t pose) : arrays_(arrays), pose_(pose) {}
  /// Joints of the mechanism; 0 of JointLoads(), which looks at no pose.
  size_t size() const { return arrays_ == nullptr ? 0 : arrays_->joint_count(); }
  /// The joint with this index, in the mechanism's order.
  JointSample operator[](size_t joint) const { return arrays_->Joint(pose_, joint); }
  IndexIterator<JointLoads> begin() const { return {this, 0}; }     ///< at the first joint
  IndexIterator<JointLoads> end() const { return {this, size()}; }  ///< behind the last

 private:
  const LoadArrays* arrays_ = nullptr;
  size_t pose_ = 0;
};

/// The joint drives at one pose.
class DriveLoads {
 public:
  using value_type = DriveSample;  ///< of the standard's containers

  DriveLoads() = default;
  /// The arrays must outlive it.
  DriveLoads(const LoadArrays* arrays, size_t pose) : arrays_(arrays), pose_(pose) {}
  /// Joint drives; 0 if a hand drives.
  size_t size() const { return arrays_ == nullptr ? 0 : arrays_->drive_count; }
  /// The drive with this index, in the study's order.
  DriveSample operator[](size_t drive) const { return arrays_->Drive(pose_, drive); }
  IndexIterator<DriveLoads> begin() const { return {this, 0}; }     ///< at the first drive
  IndexIterator<DriveLoads> end() const { return {this, size()}; }  ///< behind the last

 private:
  const LoadArrays* arrays_ = nullptr;
  size_t pose_ = 0;
};

/// One pose of the study: a view that keeps the arrays alive which it looks into.
struct PoseLoads : PoseState {
  PoseLoads() = default;
  /// Shares the arrays, copies nothing.
  PoseLoads(std::shared_ptr<const LoadArrays> arrays, size_t pose);

  double time = 0;        ///< [s]
  DriveLoads drives;      ///< of each joint drive
  Wrenchd hand;           ///< w_d: what the hand does to the mechanism at Go, world axes
  double hand_error = 0;  ///< distance that the hand is off the grasp frame [m]
  JointLoads joints;      ///< of each joint of the mechanism
  std::span<const LinkMotion> links;  ///< empty if LoadStudyOptions::link_motions is off
  // As the arrays of these names.
  double power = 0, power_error = 0, power_error_scale = 0;  ///< as LoadArrays::powers etc.
  double smallest_pivot = 1;  ///< [-], as LoadArrays::smallest_pivots
  double closure = 0;         ///< [-], how far the loops are open

 private:
  std::shared_ptr<const LoadArrays> arrays_;
};

/// The poses of a study in their order.
class PoseSeries {
 public:
  using value_type = PoseLoads;  ///< of the standard's containers

  PoseSeries() : PoseSeries(std::make_shared<LoadArrays>()) {}
  /// Shares them.
  explicit PoseSeries(std::shared_ptr<const LoadArrays> arrays) : arrays_(std::move(arrays)) {}

  size_t size() const { return arrays_->pose_count(); }                ///< poses
  bool empty() const { return size() == 0; }                           ///< before a study has run
  PoseLoads operator[](size_t pose) const { return {arrays_, pose}; }  ///< in [0, size())
  PoseLoads front() const { return (*this)[0]; }                       ///< the study's start
  PoseLoads back() const { return (*this)[size() - 1]; }               ///< its end
  IndexIterator<PoseSeries> begin() const { return {this, 0}; }        ///< at the first pose
  IndexIterator<PoseSeries> end() const { return {this, size()}; }     ///< behind the last

  /// All of them, without a copy.
  const LoadArrays& arrays() const { return *arrays_; }

 private:
  std::shared_ptr<const LoadArrays> arrays_;  ///< never null
};

}  // namespace vmech
