#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vmech/studies/study.h"

namespace vmech {

/// A number by which a study can be varied.
struct StudyParameter {
  std::string name;  ///< "crank/pin.x", "coupler.mass", or of the files' block `parameters`
  std::string unit;  ///< "mm"
  double value = 0;  ///< in the unit
  double scale = 1;  ///< what a change is measured by: the value, or a length of the mechanism
  std::function<void(double value, StudyFile* file)> put;  ///< gives a study this value
};

/// The numbers of the mechanism itself, in the units of its file: mass and centre of gravity of
/// every link that has mass, and where its joints are made. Coordinates that are zero are left out
/// unless `zeros`.
std::vector<StudyParameter> DimensionsOf(const StudyFile& file, bool zeros);

/// The parameter of this name.
/// @throws std::invalid_argument naming those that there are.
StudyParameter FindParameter(const std::vector<StudyParameter>& known, const std::string& name);

}  // namespace vmech
