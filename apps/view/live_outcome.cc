#include "vmech/apps/view/live_outcome.h"

#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "vmech/apps/view/json_text.h"
#include "vmech/studies/sensitivities.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

std::string Message(const char* state, const std::string& text, Json figures) {
  return JsonText(
      Json{{"outcome", {{"state", state}, {"text", text}, {"figures", std::move(figures)}}}});
}

Json Number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json SlopesOf(const Sensitivities& found, const FigureSlopes& figure) {
  Json by = Json::array();
  if (!figure.not_determined.empty()) return by;
  for (size_t i = 0; i < found.parameters.size(); ++i) {
    const double percent = figure.Elasticity(i, found.parameters[i]);
    by.push_back({{"parameter", found.parameters[i].name}, {"percent", Number(percent)}});
  }
  return by;
}

}  // namespace

struct LiveOutcome::Worker {
  Worker(std::filesystem::path study, std::vector<ParameterSetting> settings,
         std::vector<std::string> names)
      : path(std::move(study)), given(std::move(settings)), parameters(std::move(names)) {
    asked = given;
    thread = std::thread([this] { Run(); });
  }
  ~Worker() {
    {
      const std::scoped_lock lock(mutex);
      over = true;
    }
    wake.notify_all();
    thread.join();
  }

  void Run() {
    while (true) {
      std::vector<ParameterSetting> settings;
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [this] { return over || asked; });
        if (over) return;
        settings = *std::exchange(asked, std::nullopt);
        news = Message("computing", "", Json::array());
      }
      std::string message;
      try {
        message = Message("done", "", FiguresFor(settings));
      } catch (const std::exception& error) {
        message = Message("refused", error.what(), Json::array());
      }
      const std::scoped_lock lock(mutex);
      if (!asked) news = std::move(message);
    }
  }

  /// Bearings stay those that were chosen first: their lives are what a design changes.
  Json FiguresFor(const std::vector<ParameterSetting>& settings) {
    const StudyFile file = ReadStudy(path, settings);
    StudyOutcome outcome = RunStudy(file, {});
    if (!first) first = outcome;
    outcome.bearings = first->bearings;
    std::vector<StudyParameter> by;
    for (StudyParameter& known : FileParametersOf(file)) {
      if (std::find(parameters.begin(), parameters.end(), known.name) != parameters.end()) {
        by.push_back(std::move(known));
      }
    }
    const Sensitivities found =
        FindSensitivities(file, outcome, FiguresOf(file, outcome), std::move(by), {});
    Json figures = Json::array();
    for (size_t i = 0; i < found.figures.size(); ++i) {
      const FigureSlopes& figure = found.figures[i];
      if (before.size() < found.figures.size()) before.push_back(figure.value);
      figures.push_back({{"name", figure.figure.name},
                         {"unit", figure.figure.unit},
                         {"before", Number(before[i])},
                         {"now", Number(figure.value)},
                         {"open", figure.not_determined},
                         {"by", SlopesOf(found, figure)}});
    }
    return figures;
  }

  const std::filesystem::path path;
  const std::vector<ParameterSetting> given;
  const std::vector<std::string> parameters;
  std::optional<StudyOutcome> first;  // of the study as it was
  std::vector<double> before;         // its figures

  std::mutex mutex;
  std::condition_variable wake;
  std::optional<std::vector<ParameterSetting>> asked;
  std::string news;
  bool over = false;
  std::thread thread;
};

LiveOutcome::LiveOutcome(std::filesystem::path study, std::vector<ParameterSetting> settings,
                         std::vector<std::string> parameters)
    : worker_(
          std::make_unique<Worker>(std::move(study), std::move(settings), std::move(parameters))) {}

LiveOutcome::~LiveOutcome() = default;

void LiveOutcome::Ask(std::vector<ParameterSetting> settings) {
  std::vector<ParameterSetting> all = worker_->given;
  all.insert(all.end(), std::make_move_iterator(settings.begin()),
             std::make_move_iterator(settings.end()));
  {
    const std::scoped_lock lock(worker_->mutex);
    worker_->asked = std::move(all);
  }
  worker_->wake.notify_all();
}

std::string LiveOutcome::TakeNews() {
  const std::scoped_lock lock(worker_->mutex);
  return std::exchange(worker_->news, {});
}

}  // namespace vmech
