#pragma once

#include <memory>
#include <string>

#include "vmech/dynamics/loads/load_arrays.h"
#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/simulation_result.h"

namespace vmech {

/// Enters states into a result: closed, with accelerations, energies and the joints' wrenches.
class Recorder {
 public:
  /// Keeps references. The result gets room for all times of the simulation and one more.
  Recorder(const PreparedSimulation& prepared, const SimulationOptions& options,
           EquationsOfMotion* equations, SimulationResult* result);

  /// y [size of the equations] at a time, which is moved onto the loops.
  void Record(double time, double* y);
  /// The same where the equations hold all that there is at the time: pose, rates, accelerations,
  /// joints, forces. Of y the energies count.
  void Enter(double time, const double* y);
  /// Cuts the arrays to what was recorded, and judges the wrenches.
  void Finish();

 private:
  void RecordEnergies(const double* y);
  void RecordLoads(double time);
  void LeaveOut(size_t pose);
  void JudgeLoads();
  bool FrictionFollowsTheRule() const;
  bool HeldMoreThanOnce() const;
  void DoubtAll(const std::string& why);

  const PreparedSimulation& prepared_;
  const SimulationOptions& options_;
  EquationsOfMotion& equations_;
  SimulationResult& result_;
  std::shared_ptr<LoadArrays> arrays_;
  double first_energy_ = 0;
};

}  // namespace vmech
