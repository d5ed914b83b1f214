#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/reactions/certainty.h"
#include "vmech/hw_interface/variation/design_path.h"
#include "vmech/kinematics/inverse/assembly_modes.h"

namespace vmech {

/// How a mechanism on a screen goes on by itself.
enum class ScreenMode {
  kFrozen,    ///< it stands still, whatever acts on it
  kHeld,      ///< a spring pulls one point of a link to where the mouse is
  kSwinging,  ///< it moves by its own weight, springs and inertia; nobody holds it
};

/// A mechanism on a screen, at a moment.
struct ScreenState {
  double time = 0;                        ///< that has passed for it [s]
  ScreenMode mode = ScreenMode::kFrozen;  ///< frozen, held or swinging
  std::vector<Posed> links;               ///< X_WL
  std::vector<double> coordinates;  ///< of the freedoms of all joints; a spherical joint has the
                                    ///< rotation vector
  std::vector<double> rates;        ///< of the same freedoms [m/s, rad/s]
  /// Of every joint, as JointSample; empty where it is frozen: then it is not said what holds it.
  std::vector<Wrenchd> wrenches;
  std::vector<JointCertainty> certainty;  ///< of these
  int link = -1;                          ///< where kHeld: the link, its point and the mouse
  Vector3d point = Vector3d::Zero(), target = Vector3d::Zero();  ///< in the world [m]
  Vector3d force = Vector3d::Zero();  ///< of the spring on the mechanism [N], world axes
  std::vector<int> at_limit;          ///< joints
  double closure = 0;    ///< loop errors that are left, lengths over the characteristic length
  bool stopped = false;  ///< the loops did not close where the last step led; it stood still
};

/// A point in the world that a link was drawn through, as a hand's motion.
struct DraggedPath {
  int link = -1;                    ///< index in Mechanism::links
  Vector3d p_L = Vector3d::Zero();  ///< the point by which it was held, in the link's frame
  VectorXd q;                       ///< of the tree, where it was grabbed
  std::vector<double> times;        ///< [s] from the grab on
  std::vector<Vector3d> points;     ///< of the link's point in the world [m]
};

/// A mechanism that a mouse takes by any point of a link. What moves it is CoupledDynamics, the
/// real-time path, with a point grasp on the picked point and the mouse as a hand without mass: a
/// spring so stiff that the weight of all links stretches it by no more than half a thousandth of
/// the characteristic length, critically damped against their mass, that slips beyond a hundred
/// times that. Everything is in SI units and world axes. Not for several threads at once.
class ScreenMechanism {
 public:
  static constexpr double kStep = 1e-3;  ///< [s]

  /// An assembled mechanism (AssembledMechanism::mechanism). Friction in proportion to a joint's
  /// load is left out, and springs and friction of joints that have to be cut: `notes` says so.
  explicit ScreenMechanism(Mechanism assembled);

  /// What is left out, for the user.
  const std::vector<std::string>& notes() const { return notes_; }
  const Mechanism& mechanism() const { return tree_->mechanism; }  ///< with its current design
  const KinematicTree& tree() const { return *tree_; }  ///< of the mechanism, at its current design
  const VectorXd& q() const { return dynamics_ ? dynamics_->q() : q_; }  ///< [nq], loops closed
  /// Time matters to it.
  bool moves() const { return mode_ != ScreenMode::kFrozen || (design_ && design_->moves()); }

  // Requests. All throw std::invalid_argument, naming the value, for what does not exist or is not
  // finite, and leave everything as it was.

  /// Takes hold of a link at a point p_L of it. Not of the ground.
  void Grab(int link, const Vector3d& p_L);
  /// Moves the hand to a point in the world. Without effect where nothing is held.
  void Drag(const Vector3d& p_W);
  /// The hand stops pulling. `keep`: it holds the point where that has come to, so that the spring
  /// carries what the mechanism puts on it and no more; else it opens, and the mechanism swings.
  void Release(bool keep);
  /// Moves by its own dynamics from now on. @throws std::invalid_argument if no link has a mass.
  void Swing();
  void Freeze();  ///< stands still from now on
  /// Back to the start pose, frozen. @throws std::runtime_error if the loops of a varied design do
  /// not close near it; then it stays where it is.
  void Reset();
  /// Turns or shifts one freedom of a joint as near to `value` as limits and loops let it, on the
  /// same assembly branch, and freezes. @throws std::runtime_error where it cannot move there.
  void Slide(int joint, int freedom, double value);
  /// The assembly modes at the closed pose q of the tree with as many coordinates as it is free to
  /// move held; searched for a second or so. From any thread.
  AssemblyModes FindModes(const VectorXd& q) const;
  /// Stands still at a closed pose of the tree.
  void GoTo(const VectorXd& q);

  /// Changes the mechanism to another design of the same sizes as time passes, a little at each
  /// step, wherever it is and whoever holds it; it need not move otherwise. Designs are those of a
  /// DesignGuide without hands; `start` is that which the mechanism had in the beginning.
  void VaryTo(const HeldDesign& start, const HeldDesign& design);
  /// Where it is on the way; null where nothing was varied.
  const DesignPath* design() const { return design_ ? &*design_ : nullptr; }
  double design_work() const { return design_work_; }  ///< of all changes [J]

  /// Lets time pass, a whole number of steps. @throws std::runtime_error if the motion came to
  /// numbers that are not finite; then it stands still.
  void Advance(int steps);

  ScreenState State() const;  ///< a copy of what is shown
  /// The mechanism with a closed pose of the tree as its start.
  Mechanism MechanismAt(const VectorXd& q) const;
  /// Since the last grab.
  const DraggedPath& path() const { return path_; }

 private:
  /// The mouse: it wants to be at `target`, and is at `at`, which follows without jumps.
  struct Hand {
    int link;
    Vector3d p_L, target, at;
  };

  void SetInMotion();
  bool Vary();
  void TakeDesign();
  std::vector<int> AllGrasps() const;
  HandCoupling MouseSpring() const;
  void StandAt(const VectorXd& q);
  GraspFrame FrameAt(int link, const Vector3d& p_L) const;
  MovingFrame MoveHand() noexcept;
  void Record();
  void CheckFreedom(int joint, int freedom) const;

  std::vector<std::string> notes_;
  std::unique_ptr<KinematicTree> tree_;
  VectorXd start_, q_;
  double mass_ = 0;  ///< of all that moves [kg]
  ScreenMode mode_ = ScreenMode::kFrozen;
  double time_ = 0;
  std::unique_ptr<CoupledDynamics> dynamics_;  ///< where it moves
  std::optional<Hand> hand_;
  bool stopped_ = false;
  std::optional<DesignPath> design_;
  double design_work_ = 0;
  DraggedPath path_;
  double path_time_ = 0;  ///< since the grab [s]
};

}  // namespace vmech
