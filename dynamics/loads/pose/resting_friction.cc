#include "vmech/dynamics/loads/pose/resting_friction.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/dynamics/loads/pose/contact_friction.h"
#include "vmech/dynamics/rigid_body/passive.h"

namespace vmech {
namespace {

constexpr int kReweighings = 40;
/// With one drive the weights are exact after two: one finds the sense of the motion, and with it
/// which way a thread is turned.
constexpr int kReweighingsOfOneDrive = 2;
/// So many passes of the friction iteration choose weights; then they stay, so that it settles.
/// Any weights hold exactly.
constexpr int kWeighingPasses = 10;

bool IsShift(const LoadModel& model, int v) {
  for (const TreeNode& node : model.tree.nodes) {
    if (node.v == v) return node.motion == NodeMotion::kPrismatic;
  }
  return false;
}

bool HandStands(const LoadModel& model, const Motion& motion, size_t pose) {
  Vector6d V = motion.hand[pose].V_WH;
  V.head<3>() /= model.tree.length;
  return V.cwiseAbs().maxCoeff() <= kRest * motion.speed;
}

/// The limits of a resting contact as the mechanism begins to move with `rate` times the creep.
Vector3d LimitsOf(const LoadModel& model, const RestingContact& contact, const VectorXd& rate,
                  const LoadWorkspace<double>& ws) {
  const Joint& joint = model.tree.mechanism.joints[contact.joint];
  const JointLoad<double>& load = ws.loads[contact.joint];
  return FrictionLimits(joint, load.W_F, load.position, contact.creep * rate);
}

/// y of the formula above for the weights that the contacts have.
VectorXd WeighedCreep(const VectorXd& needed, const std::vector<RestingContact>& contacts) {
  MatrixXd A = MatrixXd::Zero(needed.size(), needed.size());
  for (const RestingContact& contact : contacts) {
    if (contact.weight == 0) continue;
    A += contact.limited.transpose() * contact.limited / contact.weight;
  }
  return SolveSymmetric(A, needed);
}

/// Weights in proportion to |f_c n_c y|.
void Reweigh(const VectorXd& y, std::vector<RestingContact>* contacts) {
  double sum = 0;
  for (const RestingContact& contact : *contacts) sum += (contact.limited * y).norm();
  if (sum == 0) return;
  for (RestingContact& contact : *contacts) contact.weight = (contact.limited * y).norm() / sum;
}

/// The largest share of what it can exert that any contact would have to.
double LargestShare(const VectorXd& y, const std::vector<RestingContact>& contacts) {
  double share = 0;
  for (const RestingContact& contact : contacts) {
    if (contact.weight == 0) continue;
    share = std::max(share, (contact.limited * y).norm() / contact.weight);
  }
  return share;
}

/// Solves for ws->holding with weights that even out the shares. Returns the y by which the limits
/// were taken.
VectorXd ChooseWeights(const LoadModel& model, const VectorXd& needed, LoadWorkspace<double>* ws) {
  int reweighings = 0;
  if (needed.size() == 1) {
    reweighings = kReweighingsOfOneDrive;
  } else if (ws->holding_passes++ < kWeighingPasses) {
    reweighings = kReweighings;
  }
  VectorXd before;
  for (int i = 0; i <= reweighings; ++i) {
    before = ws->holding;
    for (RestingContact& contact : ws->resting) {
      contact.limited = LimitsOf(model, contact, -before, *ws).asDiagonal() * contact.creep;
    }
    ws->holding = WeighedCreep(needed, ws->resting);
    if (i < reweighings) Reweigh(ws->holding, &ws->resting);
  }
  return before;
}

/// The contacts of a joint that rest and would move with the creep. Rates of it that are rounding
/// are none.
void AddRestingContacts(const LoadModel& model, size_t j, LoadWorkspace<double>* ws) {
  const JointType type = model.tree.mechanism.joints[j].type;
  for (const SlidingContact& freedoms : ContactsOf(type)) {
    if (!ws->sliding[j].segment(freedoms.first, freedoms.count).isZero(0)) continue;
    RestingContact contact;
    contact.joint = static_cast<int>(j);
    contact.creep = Eigen::Matrix3Xd::Zero(3, ws->creep.cols());
    for (Eigen::Index k = 0; k < ws->creep.cols(); ++k) {
      const Vector3d& rate = ws->creep_rates[static_cast<size_t>(k) * ws->loads.size() + j];
      contact.creep.col(k).segment(freedoms.first, freedoms.count) =
          SlidingRates(type, rate, kRest, model.tree.length)
              .segment(freedoms.first, freedoms.count);
    }
    if (!contact.creep.isZero(0)) ws->resting.push_back(contact);
  }
}

}  // namespace

std::vector<int> StandingDrives(const LoadModel& model, const Motion& motion, size_t pose) {
  if (model.hand) {
    return HandStands(model, motion, pose) ? model.partition.driven : std::vector<int>();
  }
  std::vector<int> standing;
  for (size_t k = 0; k < model.drives.size(); ++k) {
    const int v = model.partition.driven[k];
    const double speed = motion.drives[pose * model.drives.size() + k].velocity;
    if (std::abs(speed) <= kRest * motion.speed * CreepSpeed(model, v)) standing.push_back(v);
  }
  return standing;
}

bool AnyStands(const LoadModel& model, const Motion& motion, size_t pose, int lanes) {
  for (int lane = 0; lane < lanes; ++lane) {
    if (!StandingDrives(model, motion, pose + lane).empty()) return true;
  }
  return false;
}

double CreepSpeed(const LoadModel& model, int v) {
  return IsShift(model, v) ? model.tree.length : 1;
}

template <typename T>
void FindContacts(const LoadModel& model, const Motion& motion, LoadWorkspace<T>* ws) {
  ws->resting.clear();
  ws->held_by_friction = false;
  ws->holding_passes = 0;
  for (size_t j = 0; j < ws->loads.size(); ++j) {
    const Joint& joint = model.tree.mechanism.joints[j];
    if (!HasDryFriction(joint)) continue;
    ws->sliding[j] =
        SlidingRates(joint.type, ws->loads[j].rate, kRest * motion.speed, model.tree.length);
    if constexpr (std::is_same_v<T, double>) AddRestingContacts(model, j, ws);
  }
  ws->holding.setZero(ws->creep.cols());
  for (RestingContact& contact : ws->resting) {
    contact.weight = 1 / static_cast<double>(ws->resting.size());
  }
}

void HoldByFriction(const LoadModel& model, LoadWorkspace<double>* ws) {
  const VectorXd needed = ws->creep.transpose() * (ws->tau - ws->passive);
  const VectorXd before = ChooseWeights(model, needed, ws);
  const VectorXd& y = ws->holding;
  const double share = LargestShare(y, ws->resting);
  VectorXd left = needed;
  for (const RestingContact& contact : ws->resting) {
    if (contact.weight == 0) continue;
    const Vector3d limits = LimitsOf(model, contact, -before, *ws);
    const Vector3d held = limits.asDiagonal() * contact.limited * y / contact.weight;
    ws->along[contact.joint] += held / std::max(share, 1.0);
    left -= contact.creep.transpose() * held;
  }
  ws->held_by_friction = share > kRest && share <= 1 && left.norm() <= kRest * needed.norm();
}

template void FindContacts<double>(const LoadModel&, const Motion&, LoadWorkspace<double>*);
template void FindContacts<Dual>(const LoadModel&, const Motion&, LoadWorkspace<Dual>*);
template void FindContacts<Taped4>(const LoadModel&, const Motion&, LoadWorkspace<Taped4>*);
template void FindContacts<Lanes4>(const LoadModel&, const Motion&, LoadWorkspace<Lanes4>*);

}  // namespace vmech
