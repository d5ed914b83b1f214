#pragma once

#include <array>

#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Dry friction of a joint: what its sliding contacts can exert, and in which direction. The law of
/// every joint type is here and nowhere else. T: double, Lanes4 for four poses, or duals.
///
/// Each freedom i has a limit f_i = coulomb_i + mu N_i L_i [N] or [N m], with N the load of the
/// contact [N], mu the coefficient and L its lever (1 for a shift, a radius for a turn):
///
///   revolute     f = mu (r S(z) + r_t |F_z|)
///   prismatic    f = mu (S(z) + 2 |M_z| / b)
///   cylindrical  f = mu S(z) (1, r)
///   universal    f_i = mu (r S(a_i) + r_t |F.a_i|), a_1 = x of the first anchor, a_2 = y of the
///                second: two pins, each loaded by what lies across its own axis
///   spherical    f = mu r |F|
///   planar       f = mu |F_z| (1, 1, r)
///   screw        f = mu r S(z) + mu r (1 + t^2) |F_z| / (1 - mu t) raising, / (1 + mu t) lowering,
///                t = |pitch| / r the slope of the thread. The motor then exerts W r tan(l + phi)
///                raising and W r tan(l - phi) lowering, l = atan t, phi = atan mu [Shigley 8-2]
///
/// with S(a) the load of the supports of a pin, tube or slide along a at its second anchor: two at
/// +-l/2 carry F/2 +- (a x M)/l, and S is the sum of their magnitudes across a; without the length
/// l, S is the magnitude of F across a, and the couple M is not accounted for.
///
/// The freedoms of one contact slide together: friction opposes their sliding velocity as a vector,
///
///   F_i = -f_i^2 v_i / sqrt(sum_j (f_j v_j)^2),
///
/// which is mu N opposite to (v_x, v_y, r w) for a planar joint, and an ellipsoid of forces
/// sum (F_i / f_i)^2 = 1 for any limits [Goyal, Ruina and Papadopoulos 1991; Howe and Cutkosky
/// 1996]. Its power -sqrt(sum (f_j v_j)^2) is never positive. At rest friction is any force inside
/// the ellipsoid.

/// The freedoms [first, first + count) of a joint that slide together.
struct SlidingContact {
  int first = 0;  ///< of the joint's freedoms
  int count = 0;  ///< 1 to 3
};

/// The contacts of a joint: a universal joint has two, a weld none, the others one.
struct SlidingContacts {
  int count = 0;                                                   ///< 0 to 2
  std::array<SlidingContact, 2> contacts;                          ///< the first `count` of them
  const SlidingContact* begin() const { return contacts.data(); }  ///< as a range
  const SlidingContact* end() const { return contacts.data() + count; }  ///< behind the last
};
/// The contacts of a joint of a type.
SlidingContacts ContactsOf(JointType type);

/// The limits f of a joint that carries W_F (about M, axes of F) and moves at `rate`. Of a screw
/// the sense of the motion counts: it tells raising from lowering.
template <typename T>
Vector3<T> FrictionLimits(JointType type, const typename Design<T>::JointNumbers& numbers,
                          const Wrench<T>& W_F, const Vector3<T>& position, const Vector3<T>& rate);
/// The same for a joint of a mechanism, whose numbers are doubles.
Vector3d FrictionLimits(const Joint& joint, const Wrenchd& W_F, const Vector3d& position,
                        const Vector3d& rate);

/// The rates of a joint with those of contacts at rest made zero: a contact rests where all of it
/// is slower than `slowest` [rad/s], lengths divided by `length` [m].
template <typename T>
Vector3<T> SlidingRates(JointType type, const Vector3<T>& rate, double slowest, double length);

/// What friction exerts along each freedom of a joint that slides at `rate`, by the law above. Zero
/// where nothing slides.
template <typename T>
Vector3<T> SlidingFriction(JointType type, const Vector3<T>& limits, const Vector3<T>& rate);

/// Friction as the damper that it is at this speed, for steps that take it implicitly:
/// F_i = -c_i v_i with c_i = f_i^2 / max(|f v|, slow f_i), so that it grows in proportion to the
/// speed up to `slow` [m/s] or [rad/s]. `power` is |f v| of the contact.
inline double FrictionDamping(double limit, double power, double slow) {
  return limit == 0 ? 0.0 : limit * limit / (power > slow * limit ? power : slow * limit);
}

/// Does the thread of a screw lock under this load: is no torque enough to raise it
/// (lead angle + friction angle >= 90 degrees)?
bool ThreadLocks(const Joint& joint, const Wrenchd& W_F, double rate);
/// Is the friction angle of a screw no less than its lead angle, so that no axial force turns it?
bool IsSelfLocking(const Joint& joint);

/// A load of a joint with load-dependent friction for which the lengths that are given have no
/// formula.
struct UnaccountedLoad {
  const char* what = nullptr;  ///< "thrust"
  const char* unit = nullptr;  ///< "N"
  const char* key = nullptr;   ///< the key that accounts for it
  double size = 0;             ///< [N] or [N m]
};
/// At most two a joint; the rest has size 0.
std::array<UnaccountedLoad, 2> UnaccountedLoads(const Joint& joint, const Wrenchd& W_F,
                                                const Vector3d& position);

}  // namespace vmech
