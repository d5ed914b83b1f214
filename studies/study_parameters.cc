#include "vmech/studies/study_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

namespace vmech {
namespace {

constexpr const char* kAxes = "xyz";

/// The number of a mechanism that a parameter is.
using Number = std::function<double&(Mechanism*)>;

class Dimensions {
 public:
  Dimensions(const StudyFile& file, bool zeros)
      : file_(std::make_shared<StudyFile>(file)), zeros_(zeros) {}

  std::vector<StudyParameter> Run() {
    const Mechanism& mechanism = file_->study.mechanism;
    for (size_t l = 0; l < mechanism.links.size(); ++l) {
      if (static_cast<int>(l) != mechanism.ground) AddBody(l);
    }
    std::set<std::pair<int, int>> added;
    for (const Joint& joint : mechanism.joints) {
      for (const AnchorId& id : {joint.first, joint.second}) {
        if (added.insert({id.link, id.anchor}).second) AddAnchor(id);
      }
    }
    return std::move(parameters_);
  }

 private:
  void AddBody(size_t l) {
    const Link& link = file_->study.mechanism.links[l];
    if (link.mass_properties.mass == 0) return;
    Add(link.name + ".mass", "kg", 1, link.mass_properties.mass,
        [l](Mechanism* m) -> double& { return m->links[l].mass_properties.mass; });
    for (int k = 0; k < 3; ++k) {
      AddLength(fmt::format("{}.center_of_gravity.{}", link.name, kAxes[k]),
                [l, k](Mechanism* m) -> double& { return m->links[l].mass_properties.p_LoLcm[k]; });
    }
  }

  void AddAnchor(const AnchorId& id) {
    const Mechanism& mechanism = file_->study.mechanism;
    const std::string name =
        fmt::format("{}/{}", mechanism.links[id.link].name, mechanism.anchor(id).name);
    for (int k = 0; k < 3; ++k) {
      AddLength(fmt::format("{}.{}", name, kAxes[k]), [id, k](Mechanism* m) -> double& {
        return m->links[id.link].anchors[id.anchor].X_LA.p[k];
      });
    }
  }

  void AddLength(const std::string& name, const Number& number) {
    const DisplayUnits& units = file_->study.mechanism.units;
    const double value = number(&file_->study.mechanism);
    const double length = CharacteristicLength(file_->study.mechanism);
    constexpr double kZero = 1e-12;  // of a length: what is left of a number that was rotated
    if (std::abs(value) <= kZero * length && !zeros_) return;
    Add(name, units.length, units.metres, std::max(std::abs(value), 0.01 * length), number);
  }

  void Add(const std::string& name, const std::string& unit, double factor, double scale,
           const Number& number) {
    const std::shared_ptr<StudyFile> file = file_;
    parameters_.push_back({name, unit, number(&file_->study.mechanism) / factor, scale / factor,
                           [file, number, factor](double value) {
                             StudyFile changed = *file;
                             number(&changed.study.mechanism) = value * factor;
                             return changed;
                           }});
  }

  std::shared_ptr<StudyFile> file_;
  bool zeros_;
  std::vector<StudyParameter> parameters_;
};

}  // namespace

std::vector<StudyParameter> DimensionsOf(const StudyFile& file, bool zeros) {
  return Dimensions(file, zeros).Run();
}

StudyParameter FindParameter(const std::vector<StudyParameter>& known, const std::string& name) {
  std::vector<std::string> names;
  for (const StudyParameter& parameter : known) {
    if (parameter.name == name) return parameter;
    names.push_back(parameter.name);
  }
  throw std::invalid_argument(
      fmt::format("there is no parameter '{}'; there are {}", name, fmt::join(names, ", ")));
}

}  // namespace vmech
