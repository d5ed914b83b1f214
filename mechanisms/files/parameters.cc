#include "vmech/mechanisms/files/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>
#include <vector>

namespace vmech {
namespace {

/// The expression in a node; none if it holds none, which is reported.
std::optional<PlacedExpression> ReadExpression(const Node& node, const CountingUnits& units) {
  if (node.kind() != Node::Kind::kScalar) {
    node.Error("expected a number or an expression, as in '3*crank'");
    return {};
  }
  try {
    return PlacedExpression{Expression(node.ScalarText()), units, PlaceOf(node)};
  } catch (const ExpressionError& error) {
    node.Error(
        fmt::format("expected a number, not {}: {}", Quoted(node.ScalarText()), error.what()));
  }
  return {};
}

}  // namespace

void ReadParameters(const Node& block, const CountingUnits& units, ParameterTable* table) {
  if (!block) return;
  for (const Node& entry : block.Map()) {
    const int known = table->Find(entry.key());
    const std::string defect = NameDefect(entry.key());
    if (known < 0 && !defect.empty()) {
      entry.KeyError(defect);
    } else if (std::optional<PlacedExpression> expression = ReadExpression(entry, units)) {
      if (known >= 0) {
        table->Set(known, std::move(*expression));
      } else {
        table->Declare(entry.key(), std::move(*expression));
      }
    }
  }
}

FileError PlaceOf(const Node& node) {
  return {node.document().name(), node.line(), node.column(), node.path(), ""};
}

std::string PlaceOf(const ParameterSetting& setting) {
  return fmt::format("--set {}={}", setting.name, setting.text);
}

void ApplySettings(std::span<const ParameterSetting> settings, const std::string& file,
                   const CountingUnits& units, ParameterTable* table) {
  std::vector<FileError> errors;
  for (const ParameterSetting& setting : settings) {
    const FileError place{PlaceOf(setting), 0, 0, "", ""};
    const int parameter = table->Find(setting.name);
    try {
      if (parameter >= 0) {
        table->Set(parameter, {Expression(setting.text), units, place});
        continue;
      }
      const std::vector<std::string> names = table->names();
      std::string hint = DidYouMean(setting.name, names);
      if (hint.empty() && !names.empty()) hint = fmt::format("; it has {}", fmt::join(names, ", "));
      errors.push_back({place.file, 0, 0, "",
                        fmt::format("{} has no parameter {}{}", file, Quoted(setting.name), hint)});
    } catch (const ExpressionError& error) {
      errors.push_back({place.file, 0, 0, "", error.what()});
    }
  }
  if (!errors.empty()) throw FileErrors(errors);
}

}  // namespace vmech
