#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmech/studies/design.h"

namespace vmech {

/// What the command line asks of a study, by name.
/// @throws OptionError naming the option, the value and what would do; std::invalid_argument for
/// names that the study has not.

/// The study, for the command of this name, with the parameters that `set` sets.
StudyFile StudyAsked(const char* command, const std::filesystem::path& path,
                     const std::vector<std::string>& set);
/// One for each processor if none are asked for, at most 64.
int ThreadsAsked(int threads);
/// Those of the file's `parameters`, and all dimensions.
std::vector<StudyParameter> ParametersKnown(const StudyFile& file);
/// Without names those of the file's `parameters`, or all dimensions that are not zero.
std::vector<StudyParameter> ParametersAsked(const StudyFile& file,
                                            const std::vector<std::string>& names);
/// All if there are no names.
std::vector<Figure> FiguresAsked(const StudyFile& file, const StudyOutcome& outcome,
                                 const std::vector<std::string>& names);
/// "crank/pin.x=40..60".
DesignVariable VariableAsked(const std::vector<StudyParameter>& known, const std::string& words);
/// "pin.life>=10000".
DesignConstraint ConstraintAsked(const std::vector<Figure>& known, const std::string& words);

}  // namespace vmech
