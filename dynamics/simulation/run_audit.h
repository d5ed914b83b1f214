#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vmech/base/eigen.h"
#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/dynamics/simulation/simulation_result.h"

namespace vmech {

// What an integrator cannot see of a run: that the equations it was given keep energy, and that
// between two poses on the loops there may be none. States are those of EquationsOfMotion::Slopes.

/// Looks at the energy of a run, and at those of its steps that may lead past a pose at which loops
/// nearly lose rank: there two ways to move come close to each other, and a long step changes over.
class RunAudit {
 public:
  /// Keeps references.
  RunAudit(const SimulationOptions& options, EquationsOfMotion* equations);

  /// The next step begins with the state that was last evaluated.
  void Begin();
  /// May a step [s] to the pose that was last evaluated have led past such a pose?
  bool IsDoubtful(double step) const;
  /// Does a step stay on the loops all the way, but for a drift that the run leaves alone, and keep
  /// the balance of energy? `state_at` has the state at times within it.
  bool Holds(double from, double to, const VectorXd& start, double drift,
             const std::function<const double*(double)>& state_at);
  /// Does a way from one state to another keep the balance of energy?
  bool KeepsEnergy(double from, const double* start, double to, const double* end);
  /// Why energies at a time cannot be right: they miss more than `steps` steps of the tolerance
  /// explain. Empty if they are right.
  std::string DescribeImbalance(const EnergySample& sample, long steps);

  /// An integrator begins, at a time [s].
  void BeginAt(double time) { stood_ = crept_ = {0, time}; }
  /// Why it makes no sense to go on after so many of its steps: they are rounding of the time, or
  /// would not come to the end in a thousand times the steps that the run may take. Empty if it
  /// does.
  std::string DescribeCreeping(long steps, double time, double end);

  /// Contacts have changed, the last of them by the last of the events: why they lead nowhere,
  /// where they change and change again while no time passes. Empty if it does.
  std::string DescribeChatter(double time, const Simulation& simulation,
                              const std::vector<SimulationEvent>& events);

 private:
  struct Energy {
    double balance = 0;  ///< what is stored, less supplied, plus dissipated [J]
    double moving = 0;   ///< kinetic and in springs [J]
  };
  Energy EnergyAt(double time, const double* y);

  struct Milestone {
    long steps = 0;   ///< of the integrator
    double time = 0;  ///< that they led to [s]
  };

  const SimulationOptions& options_;
  EquationsOfMotion& equations_;
  const VectorXd unit_;    ///< [nv] a radian or a characteristic length
  double pivot_ = 1;       ///< at the beginning of a step
  double largest_ = 0;     ///< energy in play that there has been [J]
  VectorXd weighed_;       ///< the state that energy_ is of
  double weighed_at_ = 0;  ///< [s]
  Energy energy_;
  Milestone stood_, crept_;             ///< where DescribeCreeping looked last
  std::optional<double> first_weight_;  ///< energy [J]
  long changes_ = 0;                    ///< of contacts
  std::optional<double> changed_at_;    ///< when many of them had been [s]
};

}  // namespace vmech
