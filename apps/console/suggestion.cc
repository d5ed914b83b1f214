#include "vmech/apps/console/suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

std::vector<std::string> CommandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> OptionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool IsOption(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !ParseNumber(word);
}

/// The first option of a command line that the app does not have.
std::string SuggestOption(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<std::string> known = OptionsOf(app);
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (word == "--") break;
    if (!IsOption(word) || app.get_option_no_throw(name) != nullptr) continue;
    if (word[1] != '-' && app.get_option_no_throw(word.substr(0, 2)) != nullptr) continue;  // -qq
    return fmt::format("there is no option {}{}", Quoted(name), DidYouMean(name, known));
  }
  return "";
}

}  // namespace

std::string Suggestion(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return "";
  if (IsOption(words[0])) return SuggestOption(app, {words[0]});
  const std::vector<std::string> commands = CommandsOf(app);
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() != words[0]) continue;
    return SuggestOption(*command, {words.begin() + 1, words.end()});
  }
  const std::string hint = DidYouMean(words[0], commands);
  return fmt::format(
      "there is no command {}{}", Quoted(words[0]),
      hint.empty() ? fmt::format("; there are {}", fmt::join(commands, ", ")) : hint);
}

}  // namespace vmech
