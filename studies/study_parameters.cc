#include "vmech/studies/study_parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

constexpr const char* kAxes = "xyz";

/// The number of a mechanism that a parameter is.
using Number = std::function<double&(Mechanism*)>;

class Dimensions {
 public:
  Dimensions(const StudyFile& file, bool zeros)
      : mechanism_(file.study.mechanism), paths_(file.paths), zeros_(zeros) {}

  std::vector<StudyParameter> Run() {
    for (size_t l = 0; l < mechanism_.links.size(); ++l) {
      if (static_cast<int>(l) != mechanism_.ground) AddBody(l);
    }
    std::set<std::pair<int, int>> added;
    for (const Joint& joint : mechanism_.joints) {
      for (const AnchorId& id : {joint.first, joint.second}) {
        if (added.insert({id.link, id.anchor}).second) AddAnchor(id);
      }
    }
    for (const WantedPath& path : paths_) AddGrasp(path.grasp);
    return std::move(parameters_);
  }

 private:
  void AddGrasp(int grasp) {
    const Grasp& held = mechanism_.grasps[grasp];
    for (int k = 0; k < 3; ++k) {
      AddLength(fmt::format("{}.{}", held.name, kAxes[k]), held.X_LG.p[k],
                [grasp, k](Mechanism* m) -> double& { return m->grasps[grasp].X_LG.p[k]; });
    }
  }

  void AddBody(size_t l) {
    const Link& link = mechanism_.links[l];
    const MassProperties& body = link.mass_properties;
    if (body.mass == 0) return;
    Add(link.name + ".mass", "kg", 1, body.mass, body.mass,
        [l](Mechanism* m) -> double& { return m->links[l].mass_properties.mass; });
    for (int k = 0; k < 3; ++k) {
      AddLength(fmt::format("{}.center_of_gravity.{}", link.name, kAxes[k]), body.p_LoLcm[k],
                [l, k](Mechanism* m) -> double& { return m->links[l].mass_properties.p_LoLcm[k]; });
    }
  }

  void AddAnchor(const AnchorId& id) {
    const Anchor& anchor = mechanism_.anchor(id);
    const std::string name = fmt::format("{}/{}", mechanism_.links[id.link].name, anchor.name);
    for (int k = 0; k < 3; ++k) {
      AddLength(fmt::format("{}.{}", name, kAxes[k]), anchor.X_LA.p[k],
                [id, k](Mechanism* m) -> double& {
                  return m->links[id.link].anchors[id.anchor].X_LA.p[k];
                });
    }
  }

  void AddLength(const std::string& name, double value, const Number& number) {
    constexpr double kZero = 1e-12;  // of a length: what is left of a number that was rotated
    constexpr double kLeast = 0.01;  // of it: what a change of a number near zero is measured by
    const double length = CharacteristicLength(mechanism_);
    if (std::abs(value) <= kZero * length && !zeros_) return;
    Add(name, mechanism_.units.length, mechanism_.units.metres, value,
        std::max(std::abs(value), kLeast * length), number);
  }

  void Add(const std::string& name, const std::string& unit, double factor, double value,
           double scale, const Number& number) {
    const auto put = [number, factor](double figure, StudyFile* file) {
      number(&file->study.mechanism) = figure * factor;
    };
    parameters_.push_back({name, unit, value / factor, scale / factor, put, false});
  }

  const Mechanism& mechanism_;
  const std::vector<WantedPath>& paths_;
  bool zeros_;
  std::vector<StudyParameter> parameters_;
};

}  // namespace

void PutAll(const std::vector<StudyParameter>& parameters, std::span<const double> values,
            StudyFile* file) {
  for (const bool from_file : {true, false}) {
    for (size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].from_file == from_file) parameters[k].put(values[k], file);
    }
  }
}

std::vector<StudyParameter> FileParametersOf(const StudyFile& file) {
  std::vector<StudyParameter> parameters;
  for (const StatedParameter& stated : file.parameters) {
    const auto put = [name = stated.name, unit = stated.unit](double value, StudyFile* study) {
      std::vector<ParameterSetting> settings = study->settings;
      std::erase_if(settings, [&](const ParameterSetting& s) { return s.name == name; });
      settings.push_back({name, fmt::format("{} {}", value, unit)});
      *study = ReadStudy(study->path, settings);
    };
    const double scale = stated.figure != 0 ? std::abs(stated.figure) : 1;
    parameters.push_back({stated.name, stated.unit, stated.figure, scale, put, true});
  }
  return parameters;
}

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
