#include "vmech/apps/design/asked.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

std::optional<double> ReadNumber(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// The words before and after a sign; nothing if it is not there.
std::optional<std::pair<std::string, std::string>> Split(const std::string& words,
                                                         std::string_view sign) {
  const size_t at = words.find(sign);
  if (at == std::string::npos) return std::nullopt;
  return std::pair(words.substr(0, at), words.substr(at + sign.size()));
}

}  // namespace

StudyFile StudyAsked(const char* command, const std::filesystem::path& path,
                     const std::vector<std::string>& set) {
  return ReadWithSettings(set, [&](auto settings) {
    return ReadAs({command, {FileKind::kStudy}}, path,
                  [&](const std::filesystem::path& file) { return ReadStudy(file, settings); });
  });
}

int ThreadsAsked(int threads) {
  if (threads > 0) return threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
}

std::vector<StudyParameter> ParametersKnown(const StudyFile& file) {
  std::vector<StudyParameter> known = FileParametersOf(file);
  for (StudyParameter& dimension : DimensionsOf(file, true)) known.push_back(std::move(dimension));
  return known;
}

std::vector<StudyParameter> ParametersAsked(const StudyFile& file,
                                            const std::vector<std::string>& names) {
  if (names.empty()) {
    std::vector<StudyParameter> stated = FileParametersOf(file);
    return stated.empty() ? DimensionsOf(file, false) : stated;
  }
  const std::vector<StudyParameter> known = ParametersKnown(file);
  std::vector<StudyParameter> asked;
  for (const std::string& name : names) asked.push_back(FindParameter(known, name));
  return asked;
}

std::vector<Figure> FiguresAsked(const StudyFile& file, const StudyOutcome& outcome,
                                 const std::vector<std::string>& names) {
  std::vector<Figure> known = FiguresOf(file, outcome);
  if (names.empty()) return known;
  std::vector<Figure> asked;
  for (const std::string& name : names) asked.push_back(FindFigure(known, name));
  return asked;
}

DesignVariable VariableAsked(const std::vector<StudyParameter>& known, const std::string& words) {
  const auto sides = Split(words, "=");
  const auto bounds = sides ? Split(sides->second, "..") : std::nullopt;
  const auto lower = bounds ? ReadNumber(bounds->first) : std::nullopt;
  const auto upper = bounds ? ReadNumber(bounds->second) : std::nullopt;
  if (!lower || !upper) {
    throw OptionError(fmt::format(
        "--vary {}: give a parameter and two bounds, as --vary crank/pin.x=40..60", words));
  }
  return {FindParameter(known, sides->first), *lower, *upper};
}

DesignConstraint ConstraintAsked(const std::vector<Figure>& known, const std::string& words) {
  const auto most = Split(words, "<="), least = Split(words, ">=");
  const auto& sides = most ? most : least;
  const auto limit = sides ? ReadNumber(sides->second) : std::nullopt;
  if (!limit) {
    throw OptionError(
        fmt::format("--keep {}: give a figure and its limit, as --keep 'pin.life>=10000'", words));
  }
  return {FindFigure(known, sides->first), !most, *limit};
}

}  // namespace vmech
