// Walks the tree of verbs that CLI11 holds. Header only.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace giveway::fleetctl {

// The verbs for users; those without a group are for programs.
inline std::vector<const CLI::App*> ShownVerbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

inline std::vector<std::string> VerbNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : ShownVerbs(app)) names.push_back(verb->get_name());
  return names;
}

// The verb of that name; null if there is none.
inline const CLI::App* FindVerb(const CLI::App& app, const std::string& name) {
  for (const CLI::App* verb : ShownVerbs(app)) {
    if (verb->get_name() == name) return verb;
  }
  return nullptr;
}

// "--name" of every flag, former names included.
inline std::vector<std::string> FlagNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options({})) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

}  // namespace giveway::fleetctl
