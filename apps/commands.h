#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmech/apps/ik.h"

namespace vmech {

/// What the vmech command returns to the shell.
enum ExitCode {
  kSuccess = 0,
  kBadUsage = 1,    ///< the command line
  kBadInput = 2,    ///< a file that cannot be read, or contradicts itself
  kNoSolution = 3,  ///< loops that do not close, motion that cannot be followed
  kNotMet = 4,      ///< done, but a joint has no bearing in the catalogue that meets what is asked
  kInternalError = 5  ///< a fault of vmech
};

struct CheckArguments {
  std::filesystem::path mechanism;
  bool json = false;
};
int RunCheck(const CheckArguments& arguments);

struct LoadsArguments {
  std::filesystem::path study;
  std::filesystem::path out;  ///< empty: "<study>-loads" in the current folder
  bool quiet = false;
  int threads = 0;  ///< 0: all processors
};
int RunLoads(const LoadsArguments& arguments);

struct CompareArguments {
  std::filesystem::path suite;
  std::vector<std::string> solvers;  ///< by name; empty: all
  std::filesystem::path out;         ///< empty: "<suite>-compare" in the current folder
  bool quiet = false;
  int jobs = 0;  ///< processes; 0: as many as there are processors
};
int RunCompare(const CompareArguments& arguments);

struct IkArguments {
  IkQuestion question;
  bool json = false;
};
int RunIk(const IkArguments& arguments);

}  // namespace vmech
