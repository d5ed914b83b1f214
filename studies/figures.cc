#include "vmech/studies/figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "vmech/dynamics/loads/load_peaks.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

constexpr std::array<const char*, 6> kComponents{"fx", "fy", "fz", "mx", "my", "mz"};

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
    const double moment = HeldMoment(mechanism.joints[j].type, &peaks.components[j][3]);
    if (moment > kNothing * peaks.force * length) {
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

bool IsCourse(const Figure& figure) {
  return figure.kind != FigureKind::kLife && figure.kind != FigureKind::kMass;
}

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

}  // namespace vmech
