#include "vmech/studies/figure_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "vmech/dynamics/bearings/life_slope.h"
#include "vmech/dynamics/bearings/rating_life.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

/// pi/2 - mu, in degrees, of joints that are at `axes` (LoadLayout::axis).
Taped TransmissionDeviation(const std::array<int, 4>& joints, const Mechanism& mechanism,
                            const std::array<std::array<Taped, 6>, 4>& axes) {
  constexpr double kDegree = std::numbers::pi / 180;
  PlanarLoop<Taped> loop;
  for (size_t k = 0; k < joints.size(); ++k) {
    const auto joint = static_cast<size_t>(joints[k]);
    const std::array<Taped, 6>& axis = axes[k];
    loop.points[k] = Vector3<Taped>(axis[0], axis[1], axis[2]);
    loop.axes[k] = Vector3<Taped>(axis[3], axis[4], axis[5]);
    loop.turns[k] = mechanism.joints[joint].type == JointType::kRevolute;
  }
  return 90 - loop.TransmissionAngle() / kDegree;
}

size_t LargestAt(const std::vector<Taped>& course) {
  return static_cast<size_t>(std::max_element(course.begin(), course.end()) - course.begin());
}

/// (mean of x^p)^(1/p), of numbers that are not negative. What is lost in the rounding of the sum
/// is left out, up to `lost` of the largest term.
Taped PowerMean(const std::vector<Taped>& course, double power, double lost) {
  const double largest = course[LargestAt(course)].value;
  if (largest == 0) return 0;
  Taped sum = 0;
  for (const Taped& x : course) {
    if (std::pow(x.value / largest, power) >= lost) sum += pow(x / largest, power);
  }
  return largest * pow(sum / static_cast<double>(course.size()), 1 / power);
}

Taped Reduce(const std::vector<Taped>& course, const Figure& figure) {
  constexpr double kLost = 1e-19;
  switch (figure.reduction) {
    case Reduction::kPeak:
      return course[LargestAt(course)];
    case Reduction::kSmoothPeak:
      return PowerMean(course, figure.power, kLost) *
             std::pow(static_cast<double>(course.size()), 1 / figure.power);
    case Reduction::kRms:
      return PowerMean(course, 2, 0);
  }
  return 0;
}

}  // namespace

FigureValues::FigureValues(const StudyFile& file, const StudyOutcome& outcome,
                           const LoadRows<double>& loads)
    : file_(file), outcome_(outcome), loads_(loads), layout_(loads.layout) {
  numbers_ = file.study.times;
  masses_ = numbers_.size();
  for (const Link& link : file.study.mechanism.links) {
    numbers_.push_back(link.mass_properties.mass);
  }
  cycle_ = numbers_.size();
  numbers_.push_back(file.study.cycle);
  requests_ = numbers_.size();
  const std::vector<double> requests = RequestNumbers(file);
  numbers_.insert(numbers_.end(), requests.begin(), requests.end());
  size_t next = requests_;
  for (const BearingRequest& request : file.bearings) {
    bearings_.push_back(std::exchange(next, next + request.arrangement.positions.size() + 1));
  }
  for (const WantedPath& path : file.paths) {
    paths_.push_back(std::exchange(next, next + 3 * path.points.size()));
  }
}

Taped FigureValues::Use(size_t number) {
  const Taped variable = Taped::Variable(numbers_[number], &tape_);
  used_.push_back({variable.index, false, number});
  return variable;
}

Taped FigureValues::UseLoad(size_t number) {
  const Taped variable = Taped::Variable(loads_.numbers[number], &tape_);
  used_.push_back({variable.index, true, number});
  return variable;
}

template <size_t count>
std::array<Taped, count> FigureValues::UseRow(size_t pose, size_t first) {
  std::array<Taped, count> part;
  for (size_t k = 0; k < count; ++k) part[k] = UseLoad(pose * layout_.width() + first + k);
  return part;
}

FigureValue FigureValues::Of(const Figure& figure, bool with_derivatives) {
  tape_.Rewind(1);
  used_.clear();
  FigureValue value;
  Taped result;
  if (IsCourse(figure)) {
    const std::vector<Taped> course = CourseOf(figure);
    result = Reduce(course, figure);
    if (figure.reduction == Reduction::kPeak) value.pose = static_cast<int>(LargestAt(course));
  } else if (figure.kind == FigureKind::kLife) {
    result = LifeOf(figure);
  } else {
    for (size_t l = masses_; l < cycle_; ++l) {
      if (static_cast<int>(l - masses_) != file_.study.mechanism.ground) result += Use(l);
    }
  }
  value.value = result.value;
  if (!with_derivatives) return value;
  tape_.Seed(result.index, 1);
  for (auto used = used_.rbegin(); used != used_.rend(); ++used) {
    tape_.Sweep(used->variable + 1);
    used->by = tape_.Take(used->variable);
    tape_.Rewind(used->variable);
  }
  Collect(&value);
  return value;
}

void FigureValues::Collect(FigureValue* value) {
  std::vector<double> by(numbers_.size(), 0.0);
  for (const Used& used : used_) {
    if (!used.is_load) by[used.number] += used.by;
  }
  const auto part = [&](size_t from, size_t to) {
    return std::vector<double>(by.begin() + static_cast<ptrdiff_t>(from),
                               by.begin() + static_cast<ptrdiff_t>(to));
  };
  value->by_times = part(0, masses_);
  value->by_masses = part(masses_, cycle_);
  value->by_cycle = by[cycle_];
  value->by_requests = part(requests_, numbers_.size());
  CollectLoads(value);
}

/// Loads were used pose by pose.
void FigureValues::CollectLoads(FigureValue* value) {
  LoadRows<double>& by_loads = value->by_loads;
  by_loads.layout = layout_;
  std::vector<double> row(layout_.width());
  auto used = used_.begin();
  for (size_t pose = 0; pose < masses_; ++pose) {
    const size_t from = pose * row.size();
    std::fill(row.begin(), row.end(), 0.0);
    bool matters = value->by_times[pose] != 0;
    for (; used != used_.end() && (!used->is_load || used->number < from + row.size()); ++used) {
      if (!used->is_load) continue;
      row[used->number - from] += used->by;
      matters = matters || used->by != 0;
    }
    if (!matters) continue;
    by_loads.poses.push_back(pose);
    by_loads.numbers.insert(by_loads.numbers.end(), row.begin(), row.end());
  }
}

/// What a figure is at one of the poses.
Taped FigureValues::ValueAt(const Figure& figure, size_t pose) {
  const Mechanism& mechanism = file_.study.mechanism;
  const auto index = static_cast<size_t>(figure.index);
  switch (figure.kind) {
    case FigureKind::kForce:
      return VectorSize(UseRow<3>(pose, layout_.wrench(index)).data());
    case FigureKind::kMoment:
      return HeldMoment(mechanism.joints[index].type,
                        UseRow<3>(pose, layout_.wrench(index) + 3).data());
    case FigureKind::kDrive:
      return abs(UseRow<1>(pose, layout_.drive_force(index))[0]);
    case FigureKind::kGroundForce:
      return VectorSize(UseRow<3>(pose, layout_.ground_force()).data());
    case FigureKind::kPathError: {
      const auto grasp = static_cast<size_t>(file_.paths[index].grasp);
      std::array<Taped, 3> off = UseRow<3>(pose, layout_.grasp(grasp));
      for (size_t k = 0; k < 3; ++k) off[k] -= Use(paths_[index] + 3 * pose + k);
      return VectorSize(off.data());
    }
    case FigureKind::kTransmission: {
      std::array<std::array<Taped, 6>, 4> axes;
      for (size_t k = 0; k < axes.size(); ++k) {
        axes[k] = UseRow<6>(pose, layout_.axis(static_cast<size_t>(figure.loop[k])));
      }
      return TransmissionDeviation(figure.loop, mechanism, axes);
    }
    case FigureKind::kLife:
    case FigureKind::kMass:
      break;
  }
  return 0;
}

/// What a figure is at every pose.
std::vector<Taped> FigureValues::CourseOf(const Figure& figure) {
  std::vector<Taped> course;
  for (size_t i = 0; i < masses_; ++i) course.push_back(ValueAt(figure, i));
  return course;
}

/// How long each pose stands for, as DutyCycle::duration.
std::vector<Taped> FigureValues::Durations() {
  const size_t poses = masses_;
  const bool repeats = file_.study.cycle > 0;
  if (poses == 1) return {repeats ? Use(cycle_) : Taped(1)};
  std::vector<Taped> times, durations(poses);
  for (size_t i = 0; i < poses; ++i) times.push_back(Use(i));
  if (repeats) times.push_back(times[0] + Use(cycle_));
  for (size_t i = 1; i < times.size(); ++i) {
    const Taped half = 0.5 * (times[i] - times[i - 1]);
    durations[i - 1] += half;
    durations[i % poses] += half;
  }
  return durations;
}

Taped FigureValues::LifeOf(const Figure& figure) {
  const auto at = static_cast<size_t>(figure.index);
  const BearingRequest& request = file_.bearings[at];
  const auto joint = static_cast<size_t>(request.joint);
  const auto turn = static_cast<size_t>(TurnAboutAxis(file_.study.mechanism.joints[joint].type));
  DutySlopes duty;
  duty.duration = Durations();
  for (size_t i = 0; i < duty.duration.size(); ++i) {
    const std::array<Taped, 6> w = UseRow<6>(i, layout_.wrench(joint));
    duty.speed.push_back(UseRow<1>(i, layout_.rate(joint) + turn)[0]);
    duty.wrench.push_back({{w[0], w[1], w[2]}, {w[3], w[4], w[5]}});
  }
  ArrangementSlopes arrangement{{}, request.arrangement.locating, {}};
  size_t next = bearings_[at];
  for (size_t k = 0; k < request.arrangement.positions.size(); ++k) {
    arrangement.positions.push_back(Use(next++));
  }
  arrangement.reliability = Use(next);
  std::vector<BearingKind> kinds;
  std::vector<Taped> lives;
  const std::vector<BearingSelection>& selections = outcome_.bearings[at].bearings.selections;
  for (size_t k = 0; k < selections.size(); ++k) {
    const Bearing& bearing = selections[k].best()->bearing;
    kinds.push_back(bearing.kind);
    lives.push_back(LifeHours(bearing, arrangement, k, duty));
  }
  return SystemLife(std::span<const Taped>(lives), WeibullSlope(kinds));
}

std::vector<double> RequestNumbers(const StudyFile& file) {
  std::vector<double> numbers;
  for (const BearingRequest& request : file.bearings) {
    const std::vector<double>& positions = request.arrangement.positions;
    numbers.insert(numbers.end(), positions.begin(), positions.end());
    numbers.push_back(request.requirements.reliability);
  }
  for (const WantedPath& path : file.paths) {
    for (const Vector3d& point : path.points) {
      numbers.insert(numbers.end(), point.begin(), point.end());
    }
  }
  return numbers;
}

double SlopeBesideLoads(const FigureValue& figure, const StudyChange& change,
                        const std::vector<double>& requests) {
  double slope = std::inner_product(requests.begin(), requests.end(), figure.by_requests.begin(),
                                    figure.by_cycle * change.cycle);
  for (size_t l = 0; l < figure.by_masses.size(); ++l) {
    slope += figure.by_masses[l] * change.design.links[l].mass.slope;
  }
  const std::vector<double>& times = change.prescribed.times;
  for (size_t i = 0; i < times.size(); ++i) {
    slope += figure.by_times[change.pose_number(i)] * times[i];
  }
  return slope;
}

}  // namespace vmech
