#include "vmech/apps/modes/modes_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "vmech/base/text/number_text.h"
#include "vmech/dynamics/loads/pose/joint_load.h"
#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/csv_table.h"

namespace vmech {
namespace {

using Complex = std::complex<double>;

/// Of a number of which one part is rounding beside the other.
constexpr double kRounding = 1e-9;

/// A freedom of a joint, and what each mode makes of it.
struct ShapeRow {
  std::string name;
  bool rotates = true;
  std::vector<Complex> entries;
};

/// Rates of all joints as the tree moves by v.
std::vector<JointLoad<double>> RatesOf(const KinematicTree& tree, const VectorXd& v,
                                       TreeWorkspace<double>* ws) {
  std::vector<JointLoad<double>> joints(tree.mechanism.joints.size());
  ForwardVelocities(tree, v.data(), ws);
  JointRates(tree, *ws, v.data(), &joints);
  return joints;
}

std::vector<ShapeRow> ShapesOf(const Modes& modes) {
  const std::vector<Joint>& joints = modes.tree.mechanism.joints;
  std::vector<ShapeRow> rows;
  for (const Joint& joint : joints) {
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      rows.push_back({NameOfFreedom(joint, k), FreedomsOfType(joint.type).rotates[k], {}});
    }
  }
  TreeWorkspace<double> ws(modes.tree);
  EvaluatePose(modes.tree, modes.q, &ws);
  for (const Mode& mode : modes.modes) {
    const auto real = RatesOf(modes.tree, mode.shape.real(), &ws);
    const auto imaginary = RatesOf(modes.tree, mode.shape.imag(), &ws);
    size_t row = 0;
    for (size_t j = 0; j < joints.size(); ++j) {
      for (int k = 0; k < FreedomsOf(joints[j].type); ++k) {
        rows[row++].entries.emplace_back(real[j].rate[k], imaginary[j].rate[k]);
      }
    }
  }
  return rows;
}

/// Coordinates of the equilibrium; what is no more than rounding beside a radian, or beside the
/// mechanism's length, is zero.
std::string PoseLines(const Mechanism& mechanism) {
  constexpr double kNothing = 1e-14;
  const double length = CharacteristicLength(mechanism);
  std::string text;
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      const double size = FreedomsOfType(joint.type).rotates[k] ? 1 : length;
      const double q = std::abs(joint.start[k]) > kNothing * size ? joint.start[k] : 0;
      text += fmt::format("  {:<24} {}\n", NameOfFreedom(joint, k),
                          FormatCoordinate(mechanism.units, joint, k, q));
    }
  }
  return text;
}

std::string StabilityLine(const Modes& modes) {
  switch (modes.stability) {
    case Stability::kStable:
      return "stable: pushed a little, it comes back or swings about it\n";
    case Stability::kUnstable:
      return "unstable: pushed ever so little, it leaves it\n";
    case Stability::kNeutral:
      break;
  }
  return "neutral, as far as can be told: some motion has no more than 10⁻⁹ of the largest "
         "stiffness and damping, which may be none or very little\n";
}

bool IsZero(const Mode& mode) {
  return mode.eigenvalue == 0.0;
}

std::string Behaviour(const Mode& mode) {
  if (IsZero(mode)) return "moves off or stays: no more than 10⁻⁹ of the largest, or none";
  const double rate = mode.eigenvalue.real();
  const std::string time = FormatSignificant(std::numbers::ln2 / std::abs(rate), 4);
  if (mode.frequency > 0) {
    if (std::abs(rate) <= kRounding * std::abs(mode.eigenvalue)) return "swings";
    return rate < 0 ? fmt::format("swings, and halves in {} s", time)
                    : fmt::format("swings ever farther, and doubles in {} s", time);
  }
  return rate < 0 ? fmt::format("creeps back, and halves in {} s", time)
                  : fmt::format("runs away, and doubles in {} s", time);
}

std::string EigenvalueText(const Complex& value) {
  if (value == 0.0) return "0";
  const std::string real = FormatSignificant(value.real(), 5);
  if (value.imag() == 0) return real;
  const std::string imaginary = FormatSignificant(value.imag(), 5) + "i";
  if (std::abs(value.real()) <= kRounding * std::abs(value)) return "±" + imaginary;
  return real + " ± " + imaginary;
}

std::string ModeLines(const Modes& modes) {
  std::string text = fmt::format("\n{:<6} {:>14} {:>14}  {:<24} {}\n", "mode", "frequency [Hz]",
                                 "damping ratio", "eigenvalue [1/s]", "what it does");
  for (size_t i = 0; i < modes.modes.size(); ++i) {
    const Mode& mode = modes.modes[i];
    text += fmt::format("{:<6} {:>14} {:>14}  {:<24} {}\n", i + 1,
                        mode.frequency > 0 ? FormatSignificant(mode.frequency, 6) : "–",
                        IsZero(mode) ? "–" : FormatSignificant(mode.damping_ratio, 4),
                        EigenvalueText(mode.eigenvalue), Behaviour(mode));
  }
  return text;
}

/// A part of the largest, and how far it is behind it where the freedoms do not move together.
std::string EntryText(Complex entry) {
  constexpr double kSmallest = 5e-5;
  if (std::abs(entry) < kSmallest) return "0";
  if (std::abs(entry.imag()) < kSmallest) return FormatNumber(entry.real(), 4);
  return fmt::format("{} ∠ {}°", FormatNumber(std::abs(entry), 4),
                     FormatNumber(180 / std::numbers::pi * std::arg(entry), 0));
}

std::string ShapeLines(const Modes& modes) {
  constexpr size_t kAtOnce = 5;
  const std::vector<ShapeRow> rows = ShapesOf(modes);
  std::string text = fmt::format(
      "\nshapes: how far the joints move at once, the largest in the tree 1; angles in rad, "
      "lengths in parts of {} {}\n",
      FormatShort(modes.tree.length / modes.tree.mechanism.units.metres, 6),
      modes.tree.mechanism.units.length);
  for (size_t first = 0; first < modes.modes.size(); first += kAtOnce) {
    const size_t last = std::min(first + kAtOnce, modes.modes.size());
    text += fmt::format("  {:<24}", "");
    for (size_t i = first; i < last; ++i)
      text += fmt::format(" {:>16}", fmt::format("mode {}", i + 1));
    text += "\n";
    for (const ShapeRow& row : rows) {
      text += fmt::format("  {:<24}", row.name);
      for (size_t i = first; i < last; ++i) {
        const double unit = row.rotates ? 1 : modes.tree.length;
        text += fmt::format(" {:>16}", EntryText(row.entries[i] / unit));
      }
      text += "\n";
    }
  }
  return text;
}

bool IsOutside(const Joint& joint, int k) {
  constexpr double kAtLimit = 1e-9;
  return joint.start[k] < joint.lower[k] - kAtLimit || joint.start[k] > joint.upper[k] + kAtLimit;
}

}  // namespace

std::string ModesText(const Modes& modes, const Mechanism& mechanism) {
  std::string text =
      fmt::format("{}: static equilibrium\n{}", mechanism.name, PoseLines(mechanism));
  if (modes.freedoms.empty()) return text + "nothing can move: there are no modes\n";
  text += fmt::format("  {} N or N m are left along a free motion\n",
                      FormatSignificant(modes.residual, 2));
  return text + StabilityLine(modes) + ModeLines(modes) + ShapeLines(modes);
}

std::string ModesTable(const Modes& modes) {
  const std::vector<ShapeRow> rows = ShapesOf(modes);
  std::string text = "mode,frequency,damping_ratio,real,imaginary";
  for (const ShapeRow& row : rows) {
    text += "," + CsvCell(row.name + ".real") + "," + CsvCell(row.name + ".imaginary");
  }
  text += "\n";
  for (size_t i = 0; i < modes.modes.size(); ++i) {
    const Mode& mode = modes.modes[i];
    text += fmt::format("{},{},{},{},{}", i + 1, mode.frequency, mode.damping_ratio,
                        mode.eigenvalue.real(), mode.eigenvalue.imag());
    for (const ShapeRow& row : rows) {
      text += fmt::format(",{},{}", row.entries[i].real(), row.entries[i].imag());
    }
    text += "\n";
  }
  return text;
}

std::vector<std::string> ModesWarnings(const Modes& modes, const Mechanism& mechanism) {
  std::vector<std::string> warnings = modes.warnings;
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kSpherical) continue;
    for (int k = 0; k < FreedomsOf(joint.type); ++k) {
      if (!IsOutside(joint, k)) continue;
      warnings.push_back(fmt::format(
          "'{}' is at {}, outside its limits, which are not looked at: the mechanism stops there "
          "before it is at this equilibrium",
          NameOfFreedom(joint, k), FormatCoordinate(mechanism.units, joint, k, joint.start[k])));
    }
  }
  if (HasDryFriction(mechanism)) {
    warnings.push_back(
        "dry friction is left out: it can hold the mechanism beside this pose, and ends what "
        "swings");
  }
  return warnings;
}

}  // namespace vmech
