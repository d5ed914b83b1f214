#include "vmech/hw_interface/variation/varied_mechanism.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/files/file_errors.h"
#include "vmech/mechanisms/files/parameters.h"

namespace vmech {
namespace {

constexpr double kStage = 0.02;  // of the characteristic length: between stages that are read

std::string ValueText(double value, const std::string& unit) {
  return unit.empty() ? fmt::to_string(value) : fmt::format("{} {}", value, unit);
}

LiveParameter Movable(const StatedParameter& stated) {
  constexpr double kLeast = 0.5, kMost = 2;  // of the value
  const double value = stated.figure;
  if (value == 0) return {stated.name, stated.unit, 0, -1, 1};
  const auto [lower, upper] = std::minmax({kLeast * value, kMost * value});
  return {stated.name, stated.unit, value, lower, upper};
}

/// Where a line begins in a text; lines count from 1.
size_t BeginOfLine(const std::string& text, int line) {
  size_t at = 0;
  for (int i = 1; i < line; ++i) at = text.find('\n', at) + 1;
  return at;
}

}  // namespace

VariedMechanism::VariedMechanism(const std::filesystem::path& file,
                                 std::span<const ParameterSetting> settings)
    : text_(ReadTextFile(file)), source_(text_, file.string()) {
  ApplySettings(settings, file.string(), source_.units(), &source_.parameters());
  source_.Read();
  const ParameterTable& table = source_.parameters();
  for (const StatedParameter& stated : source_.stated()) {
    const PlacedExpression& holding = table.holding(table.Find(stated.name));
    if (holding.expression.names().empty()) parameters_.push_back(Movable(stated));
  }
  std::vector<LiveParameter> moving;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    if (Changes(static_cast<Eigen::Index>(i))) moving.push_back(parameters_[i]);
  }
  parameters_ = std::move(moving);
}

/// Does a parameter change more than where the mechanism starts?
bool VariedMechanism::Changes(Eigen::Index parameter) {
  constexpr double kSome = 1e-3;  // of the way to a bound
  const auto design = [this](const VectorXd& values) {
    const KinematicTree tree = BuildKinematicTree(Read(values));
    std::vector<int> grasps(tree.mechanism.grasps.size());
    std::iota(grasps.begin(), grasps.end(), 0);
    return HeldDesignOf(tree, grasps);
  };
  const VectorXd begin = values();
  VectorXd other = begin;
  other[parameter] +=
      kSome * (parameters_[static_cast<size_t>(parameter)].upper - begin[parameter]);
  const HeldDesign changed = design(other);
  return !HasSameNumbers(changed, design(begin));  // which the file is read with from here on
}

VectorXd VariedMechanism::values() const {
  VectorXd values(static_cast<Eigen::Index>(parameters_.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = parameters_[static_cast<size_t>(i)].value;
  }
  return values;
}

Mechanism VariedMechanism::Read(const VectorXd& values) {
  ApplySettings(Settings(values), source_.name(), source_.units(), &source_.parameters());
  return source_.Read();
}

KinematicTree VariedMechanism::ReadAt(const VectorXd& values, const KinematicTree& held,
                                      const VectorXd& q) {
  Mechanism mechanism = Read(values);
  mechanism.tolerance = held.mechanism.tolerance;
  if (mechanism.joints.size() == held.mechanism.joints.size()) SetStarts(held, q, &mechanism);
  for (size_t i = 0; i < mechanism.grasps.size() && i < held.mechanism.grasps.size(); ++i) {
    mechanism.grasps[i].kind = held.mechanism.grasps[i].kind;  // as the device that holds it can
  }
  AssembledMechanism assembled = AssembleMechanism(mechanism);
  if (!assembled.summary.closed) throw std::runtime_error(assembled.summary.message);
  KinematicTree tree =
      BuildKinematicTree(std::move(assembled.mechanism), {{}, held.spanning.cuts, {}});
  const std::string why = WhyNotInPlaceOf(held, tree);
  if (!why.empty()) throw std::runtime_error("while it is held this cannot be changed: " + why);
  return tree;
}

std::string VariedMechanism::Words(const VectorXd& values) const {
  std::string words;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    const double value = values[static_cast<Eigen::Index>(i)];
    words += fmt::format("{}{} = {:.4g}{}{}", i > 0 ? ", " : "", parameters_[i].name, value,
                         parameters_[i].unit.empty() ? "" : " ", parameters_[i].unit);
  }
  return words;
}

std::vector<ParameterSetting> VariedMechanism::Settings(const VectorXd& values) const {
  std::vector<ParameterSetting> settings;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    settings.push_back({parameters_[i].name,
                        ValueText(values[static_cast<Eigen::Index>(i)], parameters_[i].unit)});
  }
  return settings;
}

std::string VariedMechanism::TextWith(const VectorXd& values) const {
  std::string text = text_;
  const ParameterTable& table = source_.parameters();
  std::vector<std::pair<size_t, size_t>> places;  // where a parameter's value stands, and which
  for (size_t i = 0; i < parameters_.size(); ++i) {
    const PlacedExpression& declared = table.declared(table.Find(parameters_[i].name));
    size_t at = BeginOfLine(text, declared.place.line) + declared.place.column - 1;
    if (text[at] == '"' || text[at] == '\'') ++at;
    if (text.compare(at, declared.expression.text().size(), declared.expression.text()) != 0) {
      throw std::runtime_error(fmt::format("{}:{}: parameter '{}' cannot be written back here",
                                           source_.name(), declared.place.line,
                                           parameters_[i].name));
    }
    places.emplace_back(at, i);
  }
  std::sort(places.rbegin(), places.rend());  // from the end, so that places stay
  const std::vector<ParameterSetting> settings = Settings(values);
  for (const auto& [at, i] : places) {
    const size_t length = table.declared(table.Find(parameters_[i].name)).expression.text().size();
    text.replace(at, length, settings[i].text);
  }
  return text;
}

DesignGuide::DesignGuide(VariedMechanism* source, const KinematicTree& held, std::vector<int> hands)
    : source_(source), held_(held), grasps_(std::move(hands)), asked_(source->values()) {
  for (int i = 0; i < static_cast<int>(held.mechanism.grasps.size()); ++i) {
    if (std::find(grasps_.begin(), grasps_.end(), i) == grasps_.end()) grasps_.push_back(i);
  }
}

HeldDesign DesignGuide::Start() const {
  return HeldDesignOf(held_, grasps_, source_->values());
}

void DesignGuide::Ask(int parameter, double value) {
  const std::vector<LiveParameter>& known = source_->parameters();
  if (parameter < 0 || parameter >= static_cast<int>(known.size())) {
    throw std::invalid_argument(
        fmt::format("there is no parameter {}; there are {}", parameter, known.size()));
  }
  const LiveParameter& moved = known[static_cast<size_t>(parameter)];
  if (!(value >= moved.lower && value <= moved.upper)) {
    throw std::invalid_argument(fmt::format("{} = {} {} is not between {} and {}", moved.name,
                                            value, moved.unit, moved.lower, moved.upper));
  }
  asked_[parameter] = value;
  changed_ = true;
  refusal_.clear();
}

void DesignGuide::AskForStart() {
  asked_ = source_->values();
  changed_ = true;
  refusal_.clear();
}

HeldDesign DesignGuide::DesignAt(const VectorXd& values, const VectorXd& q) {
  return HeldDesignOf(source_->ReadAt(values, held_, q), grasps_, values);
}

std::optional<HeldDesign> DesignGuide::Next(const Progress& progress) {
  if (progress.stopped && under_way_ && !changed_) {
    refusal_ = fmt::format("the loops do not close beyond {} at this pose",
                           source_->Words(progress.values));
    asked_ = progress.values;
    under_way_ = false;
  }
  if (!changed_ && (!under_way_ || !progress.arrived)) return {};
  changed_ = false;
  under_way_ = asked_ != progress.values;
  if (!under_way_) return {};
  try {
    HeldDesign wanted = DesignAt(asked_, progress.q);
    const HeldDesign now = DesignAt(progress.values, progress.q);
    const double stages = WayBetween(held_, now, wanted) / (kStage * held_.length);
    if (stages <= 1) return wanted;
    return DesignAt(progress.values + (asked_ - progress.values) / std::ceil(stages), progress.q);
  } catch (const std::exception& error) {
    refusal_ = fmt::format("{} is refused: {}", source_->Words(asked_), error.what());
    asked_ = progress.values;
    under_way_ = false;
    return {};
  }
}

}  // namespace vmech
