#include "vmech/apps/view/live_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "vmech/apps/view/json_text.h"
#include "vmech/apps/view/scene.h"

namespace vmech {
namespace {

using Json = nlohmann::json;

Json ArrayOf(const VectorXd& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(value);
  return array;
}

std::vector<std::string> NamesOf(const std::vector<LiveParameter>& parameters) {
  std::vector<std::string> names;
  for (const LiveParameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

/// What a study has made of the free parameters of its mechanism.
std::vector<ParameterSetting> ValuesIn(const StudyFile& study) {
  const VariedMechanism alone(study.mechanism_path, {});
  std::vector<ParameterSetting> values;
  for (const StatedParameter& stated : study.parameters) {
    const auto same = [&](const LiveParameter& free) { return free.name == stated.name; };
    if (std::none_of(alone.parameters().begin(), alone.parameters().end(), same)) continue;
    values.push_back({stated.name, fmt::format("{} {}", stated.figure, stated.unit)});
  }
  return values;
}

}  // namespace

LiveDesign::LiveDesign(const std::filesystem::path& mechanism,
                       std::vector<ParameterSetting> settings)
    : file_(mechanism), source_(mechanism, settings), computed_(source_.values()) {}

LiveDesign::LiveDesign(const StudyFile& study) : LiveDesign(study.mechanism_path, ValuesIn(study)) {
  if (any() && !study.simulation && !study.history && !study.study.hand) {
    outcome_.emplace(study.path, study.settings, NamesOf(source_.parameters()));
  }
}

Json LiveDesign::Sliders() const {
  Json sliders = Json::array();
  for (const LiveParameter& parameter : source_.parameters()) {
    sliders.push_back({{"name", parameter.name},
                       {"unit", parameter.unit},
                       {"value", parameter.value},
                       {"lower", parameter.lower},
                       {"upper", parameter.upper}});
  }
  return sliders;
}

void LiveDesign::Hold(const KinematicTree& held, std::vector<int> hands) {
  guide_.emplace(&source_, held, std::move(hands));
}

void LiveDesign::Ask(const nlohmann::json& request) {
  const auto has = [&](const char* key, auto is) {
    return request.contains(key) && is(request[key]);
  };
  if (!has("parameter", [](const nlohmann::json& v) { return v.is_number_integer(); }) ||
      !has("value", [](const nlohmann::json& v) { return v.is_number(); })) {
    throw std::invalid_argument("the request needs a whole number 'parameter' and a 'value'");
  }
  guide_->Ask(request["parameter"].get<int>(), request["value"].get<double>());
}

std::optional<HeldDesign> LiveDesign::Next(const DesignGuide::Progress& progress) {
  std::optional<HeldDesign> next = guide_->Next(progress);
  const bool rests = !next && progress.arrived && progress.values != computed_;
  if (rests) {
    computed_ = progress.values;
    if (outcome_) outcome_->Ask(source_.Settings(computed_));
  }
  return next;
}

Json LiveDesign::StateOf(const VectorXd& values, double work) const {
  Json state{{"values", ArrayOf(values)}, {"asked", ArrayOf(guide_->asked())}, {"work", work}};
  if (!guide_->refusal().empty()) state["stopped"] = guide_->refusal();
  return state;
}

LiveDesign::News LiveDesign::Fresh(std::string members) {
  constexpr std::chrono::seconds kTold{2};
  return {std::move(members), std::chrono::steady_clock::now() + kTold};
}

void LiveDesign::Reshape(const KinematicTree& tree) {
  Scene scene;
  scene.title = tree.mechanism.name;
  scene.tree = &tree;
  shape_ = Fresh("\"scene\":" + SceneJson(scene));
}

bool LiveDesign::HasNews() {
  if (outcome_) {
    const std::string news = outcome_->TakeNews();
    if (!news.empty()) figures_ = Fresh(news.substr(1, news.size() - 2));
  }
  const auto now = std::chrono::steady_clock::now();
  return now < shape_.until || now < figures_.until;
}

std::string LiveDesign::Told(std::string message) {
  const auto now = std::chrono::steady_clock::now();
  std::string members;
  for (const News* news : {&shape_, &figures_}) {
    if (now < news->until) members += news->members + ",";
  }
  return message.insert(1, members);
}

std::string LiveDesign::Saved(const VectorXd& values) const {
  const Json file{{"name", file_.filename().string()}, {"text", source_.TextWith(values)}};
  return JsonText(Json{{"save", "parameters"}, {"files", Json::array({file})}});
}

}  // namespace vmech
