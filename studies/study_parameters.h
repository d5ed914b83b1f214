#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "vmech/studies/study.h"

namespace vmech {

/// A number of a study that can be varied.
struct StudyParameter {
  std::string name;  ///< "crank/pin.x", "coupler.mass", or of the files' block `parameters`
  std::string unit;  ///< "mm"
  double value = 0;  ///< in the unit
  double scale = 1;  ///< what a change is measured by: the value, or a length of the mechanism
  std::function<void(double value, StudyFile* file)> put;  ///< gives a study this value
  /// Of a block `parameters`: to put it reads the file anew, with those that were put before.
  bool from_file = false;
};

/// Gives the parameters of a study the values [parameters], those of its blocks `parameters` first.
void PutAll(const std::vector<StudyParameter>& parameters, std::span<const double> values,
            StudyFile* file);

/// The parameters of the blocks `parameters` of the study and its mechanism.
std::vector<StudyParameter> FileParametersOf(const StudyFile& file);

/// The numbers of the mechanism itself, in the units of its file: mass and centre of gravity of
/// every link that has mass, where its joints are made, and where a grasp is whose path the study
/// wants. Coordinates that are zero are left out unless `zeros`.
std::vector<StudyParameter> DimensionsOf(const StudyFile& file, bool zeros);

/// The parameter of this name.
/// @throws std::invalid_argument naming those that there are.
StudyParameter FindParameter(const std::vector<StudyParameter>& known, const std::string& name);

}  // namespace vmech
