#pragma once

#include <array>
#include <vector>

#include "vmech/base/tape/tape.h"
#include "vmech/dynamics/sensitivity/load_derivatives.h"
#include "vmech/studies/figures.h"

namespace vmech {

/// What a study comes to in one figure, with its derivatives by all that the figure is made of.
struct FigureValue {
  double value = 0;                 ///< in Figure::unit
  int pose = -1;                    ///< at which a peak is reached; -1 for what is no peak
  LoadRows<double> by_loads;        ///< at the poses on which the figure depends
  std::vector<double> by_times;     ///< [all poses]
  std::vector<double> by_masses;    ///< [links]
  double by_cycle = 0;              ///< by LoadStudy::cycle
  std::vector<double> by_requests;  ///< by RequestNumbers
};

/// The numbers on which figures depend and loads do not: of each of the bearings that are asked for
/// the positions and the reliability, of each path its points.
std::vector<double> RequestNumbers(const StudyFile& file);

/// Evaluates figures of a study on a tape, which gives their derivatives in one sweep.
class FigureValues {
 public:
  /// Keeps references; `loads` are those of all poses of the study. Bearings are
  /// those that `outcome` chose.
  FigureValues(const StudyFile& file, const StudyOutcome& outcome, const LoadRows<double>& loads);

  /// The derivatives only if they are asked for.
  FigureValue Of(const Figure& figure, bool with_derivatives);

 private:
  /// The variable of the tape that a number is.
  Taped Use(size_t number);
  Taped UseLoad(size_t number);
  template <size_t count>
  std::array<Taped, count> UseRow(size_t pose, size_t first);
  void Collect(FigureValue* value);
  void CollectLoads(FigureValue* value);

  Taped ValueAt(const Figure& figure, size_t pose);
  std::vector<Taped> CourseOf(const Figure& figure);
  Taped LifeOf(const Figure& figure);
  std::vector<Taped> Durations();

  const StudyFile& file_;
  const StudyOutcome& outcome_;
  const LoadRows<double>& loads_;
  const LoadLayout& layout_;
  /// What figures are made of beside loads: times, and from these places on the rest.
  std::vector<double> numbers_;
  size_t masses_ = 0, cycle_ = 0, requests_ = 0;
  std::vector<size_t> bearings_, paths_;  // where each of them has its requests
  TapeOf<double> tape_;
  /// A number that a figure is made of.
  struct Used {
    int variable;   // on the tape
    bool is_load;   // of loads_, else of numbers_
    size_t number;  // in these
    double by = 0;  // the figure's derivative
  };
  std::vector<Used> used_;  // in the order of the tape
};

/// The derivative of a figure by the parameter of `change`, but for what it owes to the loads.
/// `requests` are the slopes of RequestNumbers.
double SlopeBesideLoads(const FigureValue& figure, const StudyChange& change,
                        const std::vector<double>& requests);

}  // namespace vmech
