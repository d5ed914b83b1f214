#pragma once

#include <string>

#include "vmech/base/late_library.h"
#include "vmech/solvers/run.h"

namespace vmech {

/// The packages that have a library of their own.
inline constexpr const char* kPackages[] = {"ceres", "ipopt", "kinsol", "nlopt"};

/// What the library of a package holds for the options of a back end, as its variable vmech_solve.
template <typename Options>
using PackageFunction = Outcome (*)(CountedProblem& problem, const Options& options, VectorXd* x);

/// The back end in libvmech_<package>.so, which is loaded at the first call. Where it cannot be
/// loaded, a solve ends at once as kUnavailable and says what is missing; `debian` is the package
/// of Debian that vmech has to be built with for the library to be there.
template <typename Options>
class PackageSolver {
 public:
  PackageSolver(const std::string& package, const std::string& debian) : library_(package) {
    if (library_.loaded()) solve_ = library_.Variable<PackageFunction<Options>>("vmech_solve");
    why_not_ =
        library_.error() + "; it is there if vmech is built where " + debian + " is installed";
  }

  Outcome operator()(CountedProblem& problem, const Options& options, VectorXd* x) const {
    if (solve_ == nullptr) return {SolveStatus::kUnavailable, why_not_};
    return solve_(problem, options, x);
  }

 private:
  LateLibrary library_;
  PackageFunction<Options> solve_ = nullptr;
  std::string why_not_;
};

}  // namespace vmech
