#pragma once

#include <string>
#include <vector>

#include "vmech/studies/figures.h"
#include "vmech/studies/study_parameters.h"

namespace vmech {

/// How derivatives of a study are computed.
struct SensitivityOptions {
  int threads = 1;            ///< >= 1; the result does not depend on it
  bool undetermined = false;  ///< also of figures that statics does not determine, by the rule
};

/// A figure of the study with its derivatives.
struct FigureSlopes {
  Figure figure;               ///< which one
  double value = 0;            ///< in figure.unit
  int pose = -1;               ///< index of the pose at which a peak is reached; -1: it is no peak
  std::string not_determined;  ///< components that statics leaves open; then there are no slopes
  /// [parameters] d figure / d parameter in their units; NaN where the parameter has none.
  std::vector<double> slopes;

  /// By how many percent the figure changes for one percent of the parameter; NaN if it has no
  /// slope.
  double Elasticity(size_t parameter, const StudyParameter& of) const;
};

/// Derivatives of figures of a study by parameters.
struct Sensitivities {
  std::vector<StudyParameter> parameters;  ///< in the order of their declaration
  std::vector<std::string> refusals;  ///< [parameters] why there is no derivative; mostly empty
  std::vector<FigureSlopes> figures;  ///< in the order of the summary
};

/// Exact derivatives of what a study comes to by the parameters.
/// @throws std::invalid_argument for a simulation, a hand as the drive or the rule `paper_joint`;
/// what the study itself throws.
Sensitivities FindSensitivities(const StudyFile& file, const StudyOutcome& outcome,
                                std::vector<Figure> figures, std::vector<StudyParameter> parameters,
                                const SensitivityOptions& options = {});

}  // namespace vmech
