#pragma once

#include "vmech/dynamics/loads/load_study.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

// The numbers of a study, each by visit(number), in an order of their own; of const ones, too.

template <typename Vector, typename Visit>
void VisitVector(Vector& v, const Visit& visit) {
  for (auto& number : v) visit(number);
}

template <typename Design, typename Visit>
void VisitDesign(Design* design, const Visit& visit) {
  VisitVector(design->gravity_W, visit);
  for (auto& link : design->links) {
    visit(link.mass);
    VisitVector(link.p_LoLcm, visit);
    for (auto& number : link.I_Lcm.reshaped()) visit(number);
    for (auto& X : link.X_LA) {
      for (auto& number : X.R.reshaped()) visit(number);
      VisitVector(X.p, visit);
    }
  }
  for (auto& joint : design->joints) {
    visit(joint.pitch);
    for (auto& p : joint.passive) {
      for (auto* number : {&p.stiffness, &p.rest, &p.viscous, &p.coulomb}) visit(*number);
    }
    auto& f = joint.load_friction;
    for (auto* number : {&f.coefficient, &f.radius, &f.thrust_radius, &f.length, &f.width}) {
      visit(*number);
    }
  }
}

/// Of the table of an external load.
template <typename Table, typename Visit>
void VisitTable(Table* table, const Visit& visit) {
  VisitVector(table->p_L, visit);
  visit(table->period);
  for (auto& at : table->at) visit(at);
  for (auto& W : table->wrenches) {
    VisitVector(W.force, visit);
    VisitVector(W.moment, visit);
  }
}

}  // namespace vmech
