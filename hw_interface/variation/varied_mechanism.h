#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vmech/dynamics/in_hand/held_design.h"
#include "vmech/mechanisms/files/mechanism_source.h"

namespace vmech {

/// A number of a mechanism file's block `parameters` that a designer may move.
struct LiveParameter {
  std::string name, unit;       ///< as the file has them
  double value = 0;             ///< in the unit, as the file was read
  double lower = 0, upper = 0;  ///< between which it may be moved: half and twice the value, or one
                                ///< unit to either side of zero
};

/// A mechanism file that is read again for other values of its parameters.
class VariedMechanism {
 public:
  /// @throws FileErrors as ReadMechanism.
  VariedMechanism(const std::filesystem::path& file, std::span<const ParameterSetting> settings);

  /// Those whose value is a number, not a formula of others, and that change a number of the
  /// mechanism beside its start.
  const std::vector<LiveParameter>& parameters() const { return parameters_; }
  /// Their values, as the file was read.
  VectorXd values() const;
  /// The mechanism as its file has it, for these values. @throws FileErrors where it has none.
  Mechanism Read(const VectorXd& values);
  /// The same with its loops closed as near as can be to the closed pose q of `held`, which it may
  /// take the place of, and cut as that.
  /// @throws FileErrors; std::runtime_error saying why it cannot be assembled, or cannot take the
  /// place of the other while that is held.
  KinematicTree ReadAt(const VectorXd& values, const KinematicTree& held, const VectorXd& q);
  /// "crank = 0.6 m, rod = 1.2 m"
  std::string Words(const VectorXd& values) const;
  /// The values as settings of the file's parameters.
  std::vector<ParameterSetting> Settings(const VectorXd& values) const;
  /// The text of the file with these values where its own stand.
  /// @throws std::runtime_error where they cannot be put there.
  std::string TextWith(const VectorXd& values) const;

 private:
  bool Changes(Eigen::Index parameter);

  std::string text_;
  MechanismSource source_;
  std::vector<LiveParameter> parameters_;
};

/// Leads a mechanism that is held from the design that it has to the one that is asked for, some
/// way at a time, so that every stage is a mechanism of the file. Not for several threads at once.
class DesignGuide {
 public:
  /// Keeps references. `hands`: the grasps of the mechanism that hands hold, by index; designs have
  /// them first, then the others.
  DesignGuide(VariedMechanism* source, const KinematicTree& held, std::vector<int> hands);

  /// The design that the mechanism begins with.
  HeldDesign Start() const;
  /// @throws std::invalid_argument for a parameter that is not there and a value out of its bounds.
  void Ask(int parameter, double value);
  /// All as the file was read.
  void AskForStart();

  /// Where a mechanism is on its way.
  struct Progress {
    const VectorXd& q;       ///< closed pose
    const VectorXd& values;  ///< of the parameters
    bool arrived = true;     ///< at what Next has said last
    bool stopped = false;    ///< or where its loops do not close any further
  };
  /// The design to go to from there; none if it is on its way, or where it is asked to be.
  std::optional<HeldDesign> Next(const Progress& progress);

  const VectorXd& asked() const { return asked_; }  ///< values of the parameters
  /// Why it goes no further than it has come; empty: nothing is refused.
  const std::string& refusal() const { return refusal_; }

 private:
  HeldDesign DesignAt(const VectorXd& values, const VectorXd& q);

  VariedMechanism* source_;
  const KinematicTree& held_;
  std::vector<int> grasps_;
  VectorXd asked_;
  bool changed_ = false, under_way_ = false;
  std::string refusal_;
};

}  // namespace vmech
