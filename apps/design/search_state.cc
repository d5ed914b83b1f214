#include "vmech/apps/design/search_state.h"

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "vmech/apps/files/output_folder.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/studies/sha256.h"

namespace vmech {
namespace {

using Json = nlohmann::json;

constexpr size_t kMaxStateBytes = size_t{1} << 30;
constexpr const char* kRemedy = "remove it to begin anew, or give another folder with --out";

Json JsonOf(const EvaluatedDesign& design) {
  Json json{{"values", design.values}};
  if (!design.defined) return json;
  json["figures"] = design.figures;
  json["slopes"] = design.slopes;
  return json;
}

EvaluatedDesign DesignFrom(const Json& json) {
  EvaluatedDesign design{json.at("values"), json.contains("figures"), {}, {}};
  if (!design.defined) return design;
  design.figures = json.at("figures").get<std::vector<double>>();
  design.slopes = json.at("slopes").get<std::vector<std::vector<double>>>();
  return design;
}

/// Do the designs have the same numbers of values, figures and slopes?
bool AreOfOneForm(const std::vector<EvaluatedDesign>& designs) {
  size_t figures = 0;
  for (const EvaluatedDesign& design : designs) {
    if (design.values.size() != designs[0].values.size()) return false;
    if (!design.defined) continue;
    if (figures == 0) figures = design.figures.size();
    if (design.figures.size() != figures || design.slopes.size() != figures) return false;
    for (const std::vector<double>& slopes : design.slopes) {
      if (slopes.size() != design.values.size()) return false;
    }
  }
  return true;
}

}  // namespace

SearchState::SearchState(std::filesystem::path folder, const std::string& question)
    : folder_(std::move(folder)), digest_(Sha256(question)) {
  if (exists(folder_ / kFileName)) Read(ReadTextFile(folder_ / kFileName, kMaxStateBytes));
}

void SearchState::Read(const std::string& text) {
  const std::string file = (folder_ / kFileName).string();
  std::string digest;
  try {
    const Json json = Json::parse(text);
    digest = json.at("question");
    for (const Json& design : json.at("designs")) designs_.push_back(DesignFrom(design));
  } catch (const Json::exception&) {
    throw FileErrors(file, std::string("is damaged, or no search of vmech's; ") + kRemedy);
  }
  if (digest != digest_) {
    throw FileErrors(file, std::string("is the state of another search: the study, a file that it "
                                       "names, the options or vmech have changed; ") +
                               kRemedy);
  }
  if (!AreOfOneForm(designs_)) throw FileErrors(file, std::string("is damaged; ") + kRemedy);
}

void SearchState::Add(const EvaluatedDesign& design) {
  designs_.push_back(design);
  Json designs = Json::array();
  for (const EvaluatedDesign& known : designs_) designs.push_back(JsonOf(known));
  OutputFolder out(folder_);
  out.Write(kFileName, Json{{"question", digest_}, {"designs", designs}}.dump() + "\n");
  out.Commit();
}

void SearchState::Remove() {
  std::error_code ignored;  // it is not in the way of anything
  std::filesystem::remove(folder_ / kFileName, ignored);
}

}  // namespace vmech
