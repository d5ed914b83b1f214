#include "vmech/studies/figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "vmech/dynamics/bearings/life_slope.h"
#include "vmech/dynamics/bearings/rating_life.h"
#include "vmech/dynamics/loads/load_peaks.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

constexpr std::array<const char*, 6> kComponents{"fx", "fy", "fz", "mx", "my", "mz"};

Dual Size(const Dual* v) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The moment about the axes that a joint does not leave free: without what its drive exerts.
Dual HeldMoment(JointType type, const Dual* moment) {
  const std::array<bool, 6>& free = FreedomsOfType(type).free;
  Dual held[3];
  for (int k = 0; k < 3; ++k) held[k] = free[3 + k] ? Dual(0) : moment[k];
  return Size(held);
}

/// From where a study wants a grasp at a pose.
Dual DistanceFromPath(const WantedPath& path, const LoadDerivatives& loads, size_t i) {
  const size_t grasps = loads.grasps.size() / loads.poses() / 3;
  const Dual* p = &loads.grasps[3 * (i * grasps + static_cast<size_t>(path.grasp))];
  const Vector3d& wanted = path.points[static_cast<size_t>(loads.pose_number(i))];
  const Dual d[] = {p[0] - wanted.x(), p[1] - wanted.y(), p[2] - wanted.z()};
  return Size(d);
}

/// pi/2 - mu, in degrees.
Dual TransmissionDeviation(const std::array<int, 4>& joints, const Mechanism& mechanism,
                           const LoadDerivatives& loads, size_t i) {
  constexpr double kDegree = std::numbers::pi / 180;
  PlanarLoop<Dual> loop;
  for (size_t k = 0; k < joints.size(); ++k) {
    const auto joint = static_cast<size_t>(joints[k]);
    const Dual* axis = &loads.axes[6 * (i * loads.joints() + joint)];
    loop.points[k] = Vector3<Dual>(axis[0], axis[1], axis[2]);
    loop.axes[k] = Vector3<Dual>(axis[3], axis[4], axis[5]);
    loop.turns[k] = mechanism.joints[joint].type == JointType::kRevolute;
  }
  return 90 - loop.TransmissionAngle() / kDegree;
}

/// What a figure is at one of the poses.
Dual ValueAt(const Figure& figure, const StudyFile& file, const LoadDerivatives& loads, size_t i) {
  const Mechanism& mechanism = file.study.mechanism;
  const auto index = static_cast<size_t>(figure.index);
  switch (figure.kind) {
    case FigureKind::kForce:
      return Size(&loads.wrenches[6 * (i * loads.joints() + index)]);
    case FigureKind::kMoment:
      return HeldMoment(mechanism.joints[index].type,
                        &loads.wrenches[6 * (i * loads.joints() + index) + 3]);
    case FigureKind::kDrive:
      return abs(loads.drive_forces[i * loads.drive_forces.size() / loads.poses() + index]);
    case FigureKind::kGroundForce:
      return Size(&loads.ground_forces[3 * i]);
    case FigureKind::kPathError:
      return DistanceFromPath(file.paths[index], loads, i);
    case FigureKind::kTransmission:
      return TransmissionDeviation(figure.loop, mechanism, loads, i);
    case FigureKind::kLife:
    case FigureKind::kMass:
      break;
  }
  return 0;
}

bool IsCourse(const Figure& figure) {
  return figure.kind != FigureKind::kLife && figure.kind != FigureKind::kMass;
}

/// What a figure is at every pose; empty for those that are no course.
std::vector<Dual> CourseOf(const Figure& figure, const StudyFile& file,
                           const LoadDerivatives& loads) {
  std::vector<Dual> course;
  if (!IsCourse(figure)) return course;
  for (size_t i = 0; i < loads.poses(); ++i) course.push_back(ValueAt(figure, file, loads, i));
  return course;
}

size_t LargestAt(const std::vector<Dual>& course) {
  return static_cast<size_t>(std::max_element(course.begin(), course.end()) - course.begin());
}

/// (mean of x^p)^(1/p), of numbers that are not negative.
Dual PowerMean(const std::vector<Dual>& course, double power) {
  const double largest = course[LargestAt(course)].value;
  if (largest == 0) return 0;
  Dual sum = 0;
  for (const Dual& x : course) sum += pow(x / largest, power);
  return largest * pow(sum / static_cast<double>(course.size()), 1 / power);
}

Dual Reduce(const std::vector<Dual>& course, const Figure& figure) {
  switch (figure.reduction) {
    case Reduction::kPeak:
      return course[LargestAt(course)];
    case Reduction::kSmoothPeak:
      return PowerMean(course, figure.power) *
             std::pow(static_cast<double>(course.size()), 1 / figure.power);
    case Reduction::kRms:
      return PowerMean(course, 2);
  }
  return 0;
}

Dual MassOf(const StudyFile& file, const StudyChange& change) {
  Dual mass = 0;
  for (size_t l = 0; l < change.design.links.size(); ++l) {
    if (static_cast<int>(l) != file.study.mechanism.ground) mass += change.design.links[l].mass;
  }
  return mass;
}

/// How long each pose stands for, as DutyCycle::duration.
std::vector<Dual> DurationsOf(const LoadStudy& study, const StudyChange& change,
                              const std::vector<Dual>& times) {
  const size_t poses = times.size();
  if (study.cycle > 0) {
    return std::vector<Dual>(poses, Dual(study.cycle, change.cycle) / static_cast<double>(poses));
  }
  if (poses == 1) return {Dual(1)};
  std::vector<Dual> durations(poses);
  for (size_t i = 1; i < poses; ++i) {
    const Dual half = 0.5 * (times[i] - times[i - 1]);
    durations[i - 1] += half;
    durations[i] += half;
  }
  return durations;
}

DutySlopes DutyOf(int joint, const StudyFile& file, const StudyChange& change,
                  const LoadDerivatives& loads) {
  const int turn = TurnAboutAxis(file.study.mechanism.joints[joint].type);
  const auto freedoms = static_cast<size_t>(loads.first_freedom.back());
  const auto at = static_cast<size_t>(loads.first_freedom[joint] + turn);
  DutySlopes duty;
  duty.duration = DurationsOf(file.study, change, loads.times);
  for (size_t i = 0; i < loads.poses(); ++i) {
    const Dual* w = &loads.wrenches[6 * (i * loads.joints() + static_cast<size_t>(joint))];
    duty.speed.push_back(loads.rates[i * freedoms + at]);
    duty.wrench.push_back({{w[0], w[1], w[2]}, {w[3], w[4], w[5]}});
  }
  return duty;
}

Dual LifeOf(const Figure& figure, const StudyFile& file, const StudyOutcome& outcome,
            const StudyChange& change, const LoadDerivatives& loads) {
  const auto at = static_cast<size_t>(figure.index);
  const BearingRequest& request = file.bearings[at];
  const DutySlopes duty = DutyOf(request.joint, file, change, loads);
  std::vector<BearingKind> kinds;
  std::vector<Dual> lives;
  const std::vector<BearingSelection>& selections = outcome.bearings[at].bearings.selections;
  for (size_t k = 0; k < selections.size(); ++k) {
    const Bearing& bearing = selections[k].best()->bearing;
    kinds.push_back(bearing.kind);
    lives.push_back(
        LifeHours(bearing, request.arrangement, k, duty, request.requirements.reliability));
  }
  return SystemLife(std::span<const Dual>(lives), WeibullSlope(kinds));
}

std::string NameWith(const std::string& name, const char* quantity) {
  return fmt::format("{}.{}", name, quantity);
}

void AddJointFigures(const StudyFile& file, const StudyOutcome& outcome,
                     std::vector<Figure>* figures) {
  constexpr double kNothing = 1e-9;  // of the largest force, and that at the characteristic length
  const Mechanism& mechanism = file.study.mechanism;
  const LoadPeaks peaks = FindPeaks(outcome.loads.poses.arrays());
  const double length = CharacteristicLength(mechanism);
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const std::string& name = mechanism.joints[j].name;
    const auto index = static_cast<int>(j);
    if (peaks.components[j].head<3>().norm() > kNothing * peaks.force) {
      figures->push_back(
          {FigureKind::kForce, index, Reduction::kPeak, NameWith(name, "force"), "N"});
    }
    Dual moment[3];
    for (int k = 0; k < 3; ++k) moment[k] = peaks.components[j][3 + k];
    if (HeldMoment(mechanism.joints[j].type, moment).value > kNothing * peaks.force * length) {
      figures->push_back(
          {FigureKind::kMoment, index, Reduction::kPeak, NameWith(name, "moment"), "N m"});
    }
  }
}

void AddDriveFigures(const StudyFile& file, std::vector<Figure>* figures) {
  for (size_t k = 0; k < file.study.drives.size(); ++k) {
    const JointDrive& drive = file.study.drives[k];
    const Joint& joint = file.study.mechanism.joints[drive.joint];
    const bool turns = IsRotation(joint.type, drive.freedom);
    figures->push_back({FigureKind::kDrive, static_cast<int>(k), Reduction::kPeak,
                        NameWith(NameOfFreedom(joint, drive.freedom), "drive"),
                        turns ? "N m" : "N"});
  }
}

void AddMotionFigures(const StudyFile& file, const StudyOutcome& outcome,
                      std::vector<Figure>* figures) {
  for (size_t i = 0; i < file.paths.size(); ++i) {
    const Grasp& grasp = file.study.mechanism.grasps[file.paths[i].grasp];
    figures->push_back({FigureKind::kPathError, static_cast<int>(i), Reduction::kPeak,
                        NameWith(grasp.name, "path"), "m"});
  }
  const auto transmission = FindTransmissionAngle(file.study, outcome.loads);
  if (!transmission) return;
  for (const double angle : transmission->angles) {
    if (!std::isfinite(angle)) return;
  }
  Figure figure{FigureKind::kTransmission, -1, Reduction::kPeak, "transmission", "deg"};
  figure.loop = transmission->joints;
  figures->push_back(std::move(figure));
}

void AddLifeFigures(const StudyFile& file, const StudyOutcome& outcome,
                    std::vector<Figure>* figures) {
  for (size_t i = 0; i < outcome.bearings.size(); ++i) {
    const JointBearings& bearings = outcome.bearings[i].bearings;
    const bool turns = bearings.rotation.rotation != Rotation::kStanding;
    if (!turns || !bearings.complete() || !std::isfinite(bearings.system_life_hours)) continue;
    const std::string& name = file.study.mechanism.joints[outcome.bearings[i].joint].name;
    figures->push_back(
        {FigureKind::kLife, static_cast<int>(i), Reduction::kPeak, NameWith(name, "life"), "h"});
  }
}

/// The components [first, last) of a joint that are open, in words.
void AddOpen(const StudyOutcome& outcome, size_t joint, size_t first, size_t last,
             std::vector<std::string>* open) {
  const JointCertainty verdicts = VerdictsThatMatter(outcome.loads, joint);
  for (size_t k = first; k < last; ++k) {
    if (verdicts[k] != Certainty::kCertain) open->emplace_back(kComponents[k]);
  }
}

}  // namespace

std::vector<Figure> FiguresOf(const StudyFile& file, const StudyOutcome& outcome) {
  std::vector<Figure> figures;
  AddJointFigures(file, outcome, &figures);
  AddDriveFigures(file, &figures);
  figures.push_back({FigureKind::kGroundForce, -1, Reduction::kPeak, "ground.force", "N"});
  AddMotionFigures(file, outcome, &figures);
  AddLifeFigures(file, outcome, &figures);
  figures.push_back({FigureKind::kMass, -1, Reduction::kPeak, "mass", "kg"});
  return figures;
}

Figure FindFigure(const std::vector<Figure>& known, const std::string& name) {
  constexpr std::string_view kRmsEnding = ".rms";
  const bool rms = name.ends_with(kRmsEnding);
  const std::string stem = rms ? name.substr(0, name.size() - kRmsEnding.size()) : name;
  std::vector<std::string> names;
  for (const Figure& figure : known) {
    if (figure.name == stem && (IsCourse(figure) || !rms)) {
      Figure found = figure;
      if (rms) found.reduction = Reduction::kRms;
      found.name = name;
      return found;
    }
    names.push_back(figure.name);
  }
  throw std::invalid_argument(
      fmt::format("the study has no figure '{}'; it has {}, and of courses also their .rms", name,
                  fmt::join(names, ", ")));
}

std::string NotDeterminedIn(const Figure& figure, const StudyFile& file,
                            const StudyOutcome& outcome) {
  std::vector<std::string> open;
  const auto index = static_cast<size_t>(figure.index);
  switch (figure.kind) {
    case FigureKind::kForce:
      AddOpen(outcome, index, 0, 3, &open);
      break;
    case FigureKind::kMoment:
      AddOpen(outcome, index, 3, 6, &open);
      break;
    case FigureKind::kLife:
      AddOpen(outcome, static_cast<size_t>(file.bearings[index].joint), 0, 5, &open);
      break;
    case FigureKind::kDrive:
      if (outcome.loads.drive_certainty[index] != Certainty::kCertain) open.emplace_back("drive");
      break;
    case FigureKind::kGroundForce:
    case FigureKind::kMass:
    case FigureKind::kPathError:
    case FigureKind::kTransmission:
      break;
  }
  return fmt::format("{}", fmt::join(open, ", "));
}

std::vector<size_t> PosesThatMatter(const Figure& figure, const StudyFile& file,
                                    const LoadDerivatives& all) {
  // Of the largest: what is lost in the sum of the powers.
  const double lost = std::pow(1e-19, 1 / figure.power);
  const std::vector<Dual> course = CourseOf(figure, file, all);
  std::vector<size_t> poses;
  if (figure.kind == FigureKind::kMass) return poses;
  const size_t peak = course.empty() ? 0 : LargestAt(course);
  for (size_t i = 0; i < all.poses(); ++i) {
    const bool whole = course.empty() || figure.reduction == Reduction::kRms;
    const bool near_peak =
        figure.reduction == Reduction::kSmoothPeak && course[i].value > lost * course[peak].value;
    if (whole || near_peak || i == peak) poses.push_back(i);
  }
  return poses;
}

Dual ValueOf(const Figure& figure, const StudyFile& file, const StudyOutcome& outcome,
             const StudyChange& change, const LoadDerivatives& loads) {
  if (figure.kind == FigureKind::kMass) return MassOf(file, change);
  if (figure.kind == FigureKind::kLife) return LifeOf(figure, file, outcome, change, loads);
  return Reduce(CourseOf(figure, file, loads), figure);
}

int PeakPose(const Figure& figure, const StudyFile& file, const LoadDerivatives& loads) {
  const std::vector<Dual> course = CourseOf(figure, file, loads);
  if (course.empty() || figure.reduction != Reduction::kPeak) return -1;
  return static_cast<int>(LargestAt(course));
}

}  // namespace vmech
