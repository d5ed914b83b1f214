#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "support/examples.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// A shipped mechanism with as many drives as it has freedoms that move anything.
struct DrivenExample {
  struct Drive {
    const char* joint;
    double span;  ///< how far it goes in the study [rad] or [m]
  };
  const char* name;
  std::vector<Drive> drives;
  const char* loaded_link;
};
inline void PrintTo(const DrivenExample& example, std::ostream* out) {
  *out << example.name;
}
const std::vector<DrivenExample>& DrivenExamples();
const DrivenExample& FindDrivenExample(const std::string& name);

/// From the start values at growing speed through 25 poses, a constant wrench on the loaded link.
LoadStudy StudyOf(const Mechanism& mechanism, const DrivenExample& example);
LoadStudy StudyOf(const std::string& example);

/// Largest force of any joint [N] and largest moment [N m], the scale of rounding errors. A moment
/// counts at least the largest force on the characteristic length as its lever.
struct LoadScale {
  double force, moment;
};
LoadScale ScaleOf(const Mechanism& mechanism, const PoseLoads& pose);

/// Largest difference of two poses' joint wrenches, relative to the scale of the first.
double RelativeDifference(const Mechanism& mechanism, const PoseLoads& a, const PoseLoads& b);
double RelativeDifference(const Mechanism& mechanism, const PoseLoads& a,
                          const std::vector<Wrenchd>& b);
/// And of all poses of two studies.
double RelativeDifference(const Mechanism& mechanism, const LoadStudyResult& a,
                          const LoadStudyResult& b);

}  // namespace vmech
