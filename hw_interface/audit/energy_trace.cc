#include "vmech/hw_interface/audit/energy_trace.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/inverse/configuration_distance.h"

namespace vmech {

EnergyTrace::EnergyTrace(const KinematicTree& tree, double period, bool follows)
    : tree_(tree), period_(period), way_(VectorXd::Zero(tree.nv)), last_way_(way_) {
  balance_.follows = follows;
}

void EnergyTrace::Begin(const AuditedPose& now) {
  first_kinetic_ = now.kinetic;
  first_weight_ = now.weight;
}

void EnergyTrace::Add(const AuditedPose& before, const AuditedPose& now, const TracedStep& step) {
  balance_.hand += step.hand;
  balance_.throughput += step.throughput;
  balance_.constraint += step.constraint;
  balance_.kinetic = now.kinetic - first_kinetic_;
  balance_.weight = now.weight - first_weight_;
  last_way_.swap(way_);
  CoordinateDifference(tree_, before.q, now.q, &way_);
  if (balance_.follows) {
    AddFollowed(before, now, step);
  } else {
    AddStepped(before, now, step);
  }
  balance_.untraced = balance_.lost() - balance_.taken - balance_.withheld;
  balance_.untraced_most = std::max(balance_.untraced_most, std::abs(balance_.untraced));
}

/// The forces of both ends do their work along the way of the coordinates.
void EnergyTrace::AddFollowed(const AuditedPose& before, const AuditedPose& now,
                              const TracedStep& step) {
  const auto work = [&](VectorXd AuditedPose::*tau) {
    return 0.5 * (before.*tau + now.*tau).dot(way_);
  };
  const double on_inertia = work(&AuditedPose::inertial), on_springs = work(&AuditedPose::sprung);
  inertial_ += on_inertia;
  balance_.joints += on_springs;
  balance_.taken = inertial_ - balance_.kinetic;
  if (!step.faithful) {
    balance_.withheld += step.hand - (on_inertia + work(&AuditedPose::heavy) + on_springs);
  }
  const VectorXd change =
      (now.inertial + now.heavy + now.sprung) - (before.inertial + before.heavy + before.sprung);
  balance_.untraced_bound += 0.25 * change.cwiseAbs().dot((way_ - last_way_).cwiseAbs());
}

void EnergyTrace::AddStepped(const AuditedPose& before, const AuditedPose& now,
                             const TracedStep& step) {
  balance_.joints += step.joints;
  balance_.withheld -= step.corrected;
  double turn = 0, moving = 0;
  for (size_t i = 1; i < now.ws.nodes.size(); ++i) {
    const Screw dV = now.ws.nodes[i].V - before.ws.nodes[i].V;
    balance_.taken += 0.5 * Power(before.inertias.bodies[i] * dV, dV);
    turn = std::max(turn, period_ * Length(now.ws.nodes[i].V.angular));
    moving += std::abs(Power(now.momenta[i], now.ws.nodes[i].V));
  }
  // Ways are curved: a force along the way of a step does another work than along its velocities.
  balance_.untraced_bound += turn * (step.throughput + step.moved + turn * moving);
  if (step.paid) balance_.withheld = balance_.lost() - balance_.taken - balance_.untraced;
}

}  // namespace vmech
