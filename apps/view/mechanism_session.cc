#include "vmech/apps/view/mechanism_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/apps/view/json_text.h"
#include "vmech/apps/view/scene.h"
#include "vmech/kinematics/tree/link_poses.h"
#include "vmech/mechanisms/files/flow_map.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech {
namespace {

using Json = nlohmann::json;

constexpr double kLongestPause = 0.05;  // that is made up for [s]

int IntegerOf(const Json& request, const char* key) {
  if (request.contains(key) && request[key].is_number_integer()) return request[key].get<int>();
  throw std::invalid_argument(fmt::format("the request needs a whole number '{}'", key));
}

double NumberOf(const Json& request, const char* key) {
  if (request.contains(key) && request[key].is_number()) return request[key].get<double>();
  throw std::invalid_argument(fmt::format("the request needs a number '{}'", key));
}

Vector3d PointOf(const Json& request, const char* key) {
  const Json point = request.value(key, Json());
  const auto number = [](const Json& x) { return x.is_number(); };
  if (!point.is_array() || point.size() != 3 || !std::all_of(point.begin(), point.end(), number)) {
    throw std::invalid_argument(fmt::format("the request needs three numbers '{}'", key));
  }
  return {point[0].get<double>(), point[1].get<double>(), point[2].get<double>()};
}

std::string TextOf(const Json& request, const char* key) {
  if (request.contains(key) && request[key].is_string()) return request[key].get<std::string>();
  throw std::invalid_argument(fmt::format("the request needs a word '{}'", key));
}

Json ArrayOf(const Vector3d& v) {
  return {v[0], v[1], v[2]};
}

Json PosesOf(const std::vector<Posed>& links) {
  Json poses = Json::array();
  for (const Posed& link : links) poses.push_back(SevenOf(link));
  return poses;
}

Json WrenchesOf(const std::vector<Wrenchd>& wrenches) {
  Json all = Json::array();
  for (const Wrenchd& w : wrenches) {
    all.push_back({w.force[0], w.force[1], w.force[2], w.moment[0], w.moment[1], w.moment[2]});
  }
  return all;
}

Json CertaintyOf(const std::vector<JointCertainty>& joints) {
  Json all = Json::array();
  for (const JointCertainty& joint : joints) {
    Json words = Json::array();
    for (const Certainty verdict : joint) words.push_back(CertaintyWord(verdict));
    all.push_back(std::move(words));
  }
  return all;
}

const char* NameOf(ScreenMode mode) {
  switch (mode) {
    case ScreenMode::kFrozen:
      return "frozen";
    case ScreenMode::kHeld:
      return "held";
    case ScreenMode::kSwinging:
      return "swinging";
  }
  return "";
}

Json StateOf(const ScreenState& state) {
  Json json{{"time", state.time},
            {"mode", NameOf(state.mode)},
            {"poses", PosesOf(state.links)},
            {"coordinates", state.coordinates},
            {"rates", state.rates},
            {"wrenches", state.wrenches.empty() ? Json() : WrenchesOf(state.wrenches)},
            {"at_limit", state.at_limit},
            {"closure", state.closure},
            {"stopped", state.stopped}};
  if (!state.certainty.empty()) json["certainty"] = CertaintyOf(state.certainty);
  if (state.link >= 0) {
    json["hand"] = {{"link", state.link},
                    {"point", ArrayOf(state.point)},
                    {"target", ArrayOf(state.target)},
                    {"force", ArrayOf(state.force)}};
  }
  return json;
}

/// A dragged point as the table of a study's hand.
std::string MotionTable(const DraggedPath& path, const DisplayUnits& units) {
  std::string table = "t,x,y,z\n";
  for (size_t i = 0; i < path.times.size(); ++i) {
    const Vector3d p = path.points[i] / units.metres;
    table += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", path.times[i], p[0], p[1], p[2]);
  }
  return table;
}

/// A name that no grasp of the mechanism has.
std::string NewGraspName(const Mechanism& mechanism) {
  std::string name = "mouse";
  while (FindGrasp(mechanism, name) >= 0) name += "_";
  return name;
}

std::string MechanismText(const Mechanism& mechanism, const std::string& comment) {
  WriterOptions options;
  options.comment = comment;
  if (mechanism.units.length == "mm") options.units = FileUnits::kMillimetresDegrees;
  return WriteMechanism(mechanism, options);
}

}  // namespace

MechanismSession::MechanismSession(Mechanism assembled, std::filesystem::path file,
                                   std::function<std::string(const KinematicTree&)> page,
                                   std::unique_ptr<LiveDesign> design)
    : file_(std::move(file)),
      page_(std::move(page)),
      screen_(std::move(assembled)),
      design_(std::move(design)) {
  if (!design_ || !design_->any()) {
    design_.reset();
    return;
  }
  design_->Hold(screen_.tree(), {});
  first_design_ = design_->Start();
  design_values_ = design_->asked();
}

/// Sends the mechanism on its way to the design that is asked for.
void MechanismSession::LeadDesign() {
  if (!design_) return;
  const DesignPath* path = screen_.design();
  const bool under_way = path != nullptr && !path->arrived();
  const VectorXd q = screen_.q();
  const std::optional<HeldDesign> next =
      design_->Next({q, design_values_, !under_way, path != nullptr && path->stopped()});
  if (next) screen_.VaryTo(*first_design_, *next);
  changed_ = changed_ || design_->HasNews();
}

void MechanismSession::Run(double elapsed) {
  const std::scoped_lock lock(mutex_);
  pending_ = std::min(pending_ + elapsed, kLongestPause);
  const int steps = static_cast<int>(pending_ / ScreenMechanism::kStep);
  pending_ -= steps * ScreenMechanism::kStep;
  LeadDesign();
  if (!screen_.moves() || steps == 0) return;
  changed_ = true;
  try {
    screen_.Advance(steps);
  } catch (const std::exception& error) {
    note_ = error.what();
  }
  const DesignPath* path = screen_.design();
  if (path == nullptr || path->now().values == design_values_) return;
  design_values_ = path->now().values;
  modes_.clear();  // were those of another mechanism
  design_->Reshape(screen_.tree());
}

std::string MechanismSession::Page() {
  const std::scoped_lock lock(mutex_);
  return page_(screen_.tree());
}

std::string MechanismSession::Do(const Json& request) {
  const std::string what = request["do"];
  if (what == "modes") return FindModes();
  const std::scoped_lock lock(mutex_);
  changed_ = true;
  if (what == "save") return Save(TextOf(request, "what"));
  Act(request);
  if (request.contains("sent") && request["sent"].is_number())
    echo_ = request["sent"].get<double>();
  return "";
}

void MechanismSession::Act(const Json& request) {
  const std::string what = request["do"];
  const std::map<std::string, std::function<void()>> acts{
      {"grab", [&] { screen_.Grab(IntegerOf(request, "link"), PointOf(request, "point")); }},
      {"drag", [&] { screen_.Drag(PointOf(request, "to")); }},
      {"release", [&] { screen_.Release(request.value("keep", Json(true)) == Json(true)); }},
      {"slide",
       [&] {
         screen_.Slide(IntegerOf(request, "joint"), IntegerOf(request, "freedom"),
                       NumberOf(request, "value"));
       }},
      {"vary",
       [&] {
         if (!design_) throw std::invalid_argument("the file has no parameters to vary");
         design_->Ask(request);
       }},
      {"swing", [&] { screen_.Swing(); }},
      {"freeze", [&] { screen_.Freeze(); }},
      {"reset", [&] { screen_.Reset(); }},
      {"mode", [&] {
         const int index = IntegerOf(request, "index");
         if (index < 0 || index >= static_cast<int>(modes_.size())) {
           throw std::invalid_argument(
               fmt::format("there is no assembly mode {}; {} are known", index, modes_.size()));
         }
         screen_.GoTo(modes_[static_cast<size_t>(index)]);
       }}};
  const auto act = acts.find(what);
  if (act == acts.end()) throw std::invalid_argument("'" + what + "' is nothing that can be done");
  act->second();
}

void MechanismSession::LetGo() {
  const std::scoped_lock lock(mutex_);
  screen_.Freeze();
  changed_ = true;
}

/// The search takes a second or so, in which the mechanism can be moved.
std::string MechanismSession::FindModes() {
  VectorXd q;
  {
    const std::scoped_lock lock(mutex_);
    q = screen_.q();
  }
  const AssemblyModes found = screen_.FindModes(q);
  Json modes = Json::array();
  const std::scoped_lock lock(mutex_);
  modes_.clear();
  for (const AssemblyMode& mode : found.modes) {
    modes_.push_back(mode.q);
    modes.push_back({{"poses", PosesOf(LinkPoses(screen_.tree(), mode.q))}});
  }
  return JsonText(Json{{"modes", modes}, {"note", found.BriefReport()}});
}

std::string MechanismSession::Save(const std::string& what) const {
  Json files = Json::array();
  const std::string stem = file_.stem().string();
  const auto add = [&](const std::string& name, const std::string& text) {
    files.push_back({{"name", name}, {"text", text}});
  };
  if (what == "parameters") {
    if (!design_) throw std::invalid_argument("the file has no parameters to save");
    return design_->Saved(design_values_);
  }
  if (what == "mechanism") {
    add(stem + "-posed.yaml", MechanismText(screen_.MechanismAt(screen_.q()),
                                            fmt::format("{}, its start as it was on the screen.",
                                                        file_.filename().string())));
  } else if (what == "motion") {
    const DraggedPath& path = screen_.path();
    if (path.times.size() < 2) throw std::invalid_argument("no link has been dragged yet");
    Mechanism mechanism = screen_.MechanismAt(path.q);
    const std::string grasp = NewGraspName(mechanism);
    mechanism.grasps.push_back(
        {grasp, path.link, {Matrix3d::Identity(), path.p_L}, GraspKind::kPoint});
    const std::string name = stem + "-drag";
    add(name + ".yaml", MechanismText(mechanism, fmt::format("{}, held where the mouse took it.",
                                                             file_.filename().string())));
    add(name + ".csv", MotionTable(path, mechanism.units));
    add(name + "-study.yaml",
        fmt::format("vmech_study: \"1.0\"\nmechanism: {0}\nunits: {{length: {1}, angle: {2}}}\n"
                    "motion: {{grasp: {3}, table: {4}}}\n",
                    YamlWord(name + ".yaml"), mechanism.units.length, mechanism.units.angle, grasp,
                    YamlWord(name + ".csv")));
  } else {
    throw std::invalid_argument("'" + what +
                                "' cannot be saved; 'mechanism', 'motion' and 'parameters' can");
  }
  return JsonText(Json{{"save", what}, {"files", files}});
}

std::string MechanismSession::NewState() {
  {
    const std::scoped_lock lock(mutex_);
    if (!changed_) return "";
  }
  return State();
}

std::string MechanismSession::State() {
  const std::scoped_lock lock(mutex_);
  Json message{{"state", StateOf(screen_.State())}};
  message["state"]["rows"] = screen_.path().times.size();
  if (echo_) message["state"]["echo"] = *std::exchange(echo_, std::nullopt);
  if (!note_.empty()) message["note"] = std::exchange(note_, {});
  changed_ = false;
  if (!design_) return JsonText(message);
  message["state"]["design"] = design_->StateOf(design_values_, screen_.design_work());
  return design_->Told(JsonText(message));
}

}  // namespace vmech
