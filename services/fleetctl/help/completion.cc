#include "services/fleetctl/help/completion.h"

#include <algorithm>
#include <array>
#include <regex>

#include "services/config/config_dir.h"
#include "services/fleetctl/help/verb_tree.h"

namespace giveway::fleetctl {
namespace {

// The folder with the shipped files that an argument may name; empty: none.
std::string FolderOf(const CLI::App& verb, const std::string& argument) {
  struct Row {
    const char* argument;
    const char* verb;  // empty: every verb
    const char* folder;
  };
  constexpr std::array kRows = {
      Row{"SCENARIO", "", "scenarios"}, Row{"--scenario", "", "scenarios"},
      Row{"--qos", "", "qos"},          Row{"--base", "", "qos"},
      Row{"--diff", "", "qos"},         Row{"PROFILE", "", "qos"},
      Row{"FILE", "check", "qos"},      Row{"FILE", "expand", "faults"},
      Row{"--faults", "", "faults"},    Row{"PLAN", "", "campaigns"}};
  for (const Row& row : kRows) {
    const bool is_verb = *row.verb == '\0' || verb.get_name() == row.verb;
    if (argument == row.argument && is_verb) return row.folder;
  }
  return "";
}

// "TEXT:{a,b}" is a or b.
std::vector<std::string> Members(const std::string& type_name) {
  static const std::regex kMembers(R"(\w+:\{(.*)\})");
  std::smatch part;
  std::vector<std::string> members;
  if (!std::regex_match(type_name, part, kMembers)) return members;
  std::string text = part[1];
  for (std::size_t comma = text.find(','); comma != std::string::npos; comma = text.find(',')) {
    members.push_back(text.substr(0, comma));
    text.erase(0, comma + 1);
  }
  members.push_back(text);
  return members;
}

std::vector<std::string> ValuesOf(const CLI::App& verb, const CLI::Option& option,
                                  const std::string& name) {
  const std::string folder = FolderOf(verb, name);
  return folder.empty() ? Members(option.get_type_name()) : ShippedNames(folder);
}

// The flag whose value the word is; null if it is not a value.
const CLI::Option* Awaiting(const CLI::App& verb, const std::string& before) {
  if (!before.starts_with("--")) return nullptr;
  const CLI::Option* option = verb.get_option_no_throw(before);
  return option != nullptr && option->get_type_size() != 0 ? option : nullptr;
}

std::vector<std::string> Candidates(const CLI::App& fleetctl,
                                    const std::vector<std::string>& words) {
  const CLI::App* verb = &fleetctl;
  std::string before;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    before = words[i];
    if (const CLI::App* next = FindVerb(*verb, words[i])) verb = next;
  }
  if (const CLI::Option* option = Awaiting(*verb, before)) {
    return ValuesOf(*verb, *option, before);
  }
  if (!words.empty() && words.back().starts_with("-")) return FlagNames(*verb);
  auto candidates = VerbNames(*verb);
  if (verb->get_name() == "help") candidates = VerbNames(fleetctl);
  for (const CLI::Option* option : verb->get_options({})) {
    if (!option->get_positional()) continue;
    const auto values = ValuesOf(*verb, *option, option->get_name(true, false));
    candidates.insert(candidates.end(), values.begin(), values.end());
  }
  return candidates;
}

}  // namespace

std::vector<std::string> Completions(const CLI::App& fleetctl,
                                     const std::vector<std::string>& words) {
  auto matching = Candidates(fleetctl, words);
  const std::string typed = words.empty() ? "" : words.back();
  std::erase_if(matching, [&](const std::string& word) { return !word.starts_with(typed); });
  std::ranges::sort(matching);
  matching.erase(std::unique(matching.begin(), matching.end()), matching.end());
  return matching;
}

}  // namespace giveway::fleetctl
