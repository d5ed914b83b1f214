#include "vmech/dynamics/loads/motion/freedom_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRounding = 1e-9;  // of a stroke, of a largest rate

bool Rotates(const LoadStudy& study, int joint, int freedom) {
  return FreedomsOfType(study.mechanism.joints[joint].type).rotates[freedom];
}

/// One freedom from pose to pose.
class Track {
 public:
  Track(const LoadStudy& study, const LoadStudyResult& result, int joint, int freedom)
      : study_(study),
        loads_(result.poses.arrays()),
        offset_(static_cast<size_t>(loads_.first_freedom[joint] + freedom)),
        rotates_(Rotates(study, joint, freedom)) {}

  size_t poses() const { return loads_.pose_count(); }
  /// Steps between poses, from the last to the first included where the motion is a cycle.
  size_t steps() const { return study_.cycle > 0 ? poses() : poses() - 1; }
  double time(size_t i) const {
    return i < poses() ? loads_.times[i] : loads_.times[i - poses()] + study_.cycle;
  }
  double rate(size_t i) const { return At(loads_.rates, i); }
  double acceleration(size_t i) const { return At(loads_.accelerations, i); }
  double position(size_t i) const {
    const double here = At(loads_.positions, i);
    if (i < poses() || !rotates_) return here;
    const double expected = position(i - 1) + rate(i - 1) * (time(i) - time(i - 1));
    return here + kTurn * std::round((expected - here) / kTurn);
  }

 private:
  double At(const LoadArrays::Array& array, size_t i) const {
    return array[i % poses() * loads_.freedom_count() + offset_];
  }

  const LoadStudy& study_;
  const LoadArrays& loads_;
  size_t offset_;
  bool rotates_;
};

/// Where the cubic between two poses turns back, p'(s) = a s^2 + b s + c = 0 with s from 0 to 1.
/// The rates have different signs.
Extreme TurnsBack(const Track& track, size_t i) {
  const double h = track.time(i + 1) - track.time(i);
  const double p = track.position(i), rise = track.position(i + 1) - p;
  const double m0 = h * track.rate(i), m1 = h * track.rate(i + 1);
  const double a = 3 * (m0 + m1) - 6 * rise, b = 6 * rise - 4 * m0 - 2 * m1, c = m0;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double q = -0.5 * (b + std::copysign(root, b));
  const double near = q == 0 ? 0 : c / q, far = a == 0 ? near : q / a;
  const double s = near >= 0 && near <= 1 ? near : std::clamp(far, 0.0, 1.0);
  const double value = p + s * (m0 + s * (0.5 * b + s * a / 3));
  return {value, track.time(i) + s * h};
}

/// Takes an extreme that is farther out by more than rounding.
void Widen(const Extreme& here, double rounding, FreedomRange* range) {
  if (here.value < range->least.value - rounding) range->least = here;
  if (here.value > range->greatest.value + rounding) range->greatest = here;
}

double LargestRate(const Track& track) {
  double largest = 0;
  for (size_t i = 0; i < track.poses(); ++i) largest = std::max(largest, std::abs(track.rate(i)));
  return largest;
}

/// How often a freedom turns back in a cycle.
int CountTurns(const Track& track) {
  const double still = kRounding * LargestRate(track);
  int turns = 0;
  double before = 0;
  for (size_t i = 0; i < 2 * track.poses(); ++i) {  // a round to know the sign before the first
    const double rate = track.rate(i);
    if (std::abs(rate) <= still) continue;
    if (i >= track.poses() && before * rate < 0) ++turns;
    before = rate;
  }
  return turns;
}

bool DriveIsUniform(const LoadStudyResult& result) {
  const auto& drives = result.poses.arrays().drives;
  const double speed = drives.front().velocity;
  return std::all_of(drives.begin(), drives.end(), [speed](const MotionSample& drive) {
    return std::abs(drive.velocity - speed) <= kRounding * std::abs(speed);
  });
}

bool IsOnGround(const Mechanism& mechanism, const Joint& joint) {
  return joint.first.link == mechanism.ground || joint.second.link == mechanism.ground;
}

/// Whole turns of the only drive in a cycle; 0 where that is not how the study moves.
int WholeTurns(const LoadStudy& study, const LoadStudyResult& result) {
  if (study.drives.size() != 1 || study.hand || study.cycle == 0 || result.poses.size() < 3) {
    return 0;
  }
  const JointDrive& drive = study.drives[0];
  if (!Rotates(study, drive.joint, drive.freedom) || !DriveIsUniform(result)) return 0;
  const double turns = std::abs(result.poses.arrays().drives[0].velocity) * study.cycle / kTurn;
  return std::abs(turns - std::round(turns)) < 1e-6 ? static_cast<int>(std::round(turns)) : 0;
}

}  // namespace

FreedomRange FindRange(const LoadStudy& study, const LoadStudyResult& result, int joint,
                       int freedom) {
  const Track track(study, result, joint, freedom);
  double least = track.position(0), greatest = least;
  for (size_t i = 1; i < track.poses(); ++i) {
    least = std::min(least, track.position(i));
    greatest = std::max(greatest, track.position(i));
  }
  const double rounding = kRounding * (greatest - least);
  FreedomRange range;
  range.least = range.greatest = {track.position(0), track.time(0)};
  range.largest_rate = LargestRate(track);
  for (size_t i = 0; i < track.poses(); ++i) {
    const double acceleration = std::abs(track.acceleration(i));
    range.largest_acceleration = std::max(range.largest_acceleration, acceleration);
    Widen({track.position(i), track.time(i)}, rounding, &range);
    if (i >= track.steps() || track.rate(i) * track.rate(i + 1) >= 0) continue;
    Widen(TurnsBack(track, i), rounding, &range);
  }
  return range;
}

std::optional<TimeRatio> FindTimeRatio(const LoadStudy& study, const LoadStudyResult& result,
                                       int joint) {
  const int turns = WholeTurns(study, result);
  const Joint& output = study.mechanism.joints[joint];
  if (turns == 0 || joint == study.drives[0].joint || FreedomsOf(output.type) != 1 ||
      !IsOnGround(study.mechanism, output)) {
    return {};
  }
  if (CountTurns(Track(study, result, joint, 0)) != 2 * turns) return {};
  const FreedomRange range = FindRange(study, result, joint, 0);
  const double turn_time = study.cycle / turns;
  const double grows = range.greatest.time - range.least.time;
  const double forward = (grows / turn_time - std::floor(grows / turn_time)) * kTurn;
  return TimeRatio{forward, kTurn - forward};
}

}  // namespace vmech
