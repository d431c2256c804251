#include "services/config/help/command_line.h"

#include <cstdio>
#include <iostream>
#include <memory>

#include "services/config/help/help_format.h"
#include "services/types/nearest_name.h"

namespace giveway {

CommandLine::CommandLine(const std::string& name, const std::string& description,
                         const std::string& version, const std::string& footer)
    : app_(description, name) {
  app_.set_version_flag("--version", version);
  app_.formatter(std::make_shared<HelpFormat>());
  app_.footer(footer);
}

void CommandLine::Add(const std::string& flag, const std::string& value_name,
                      const std::string& help) {
  auto& [option, value] = options_.emplace_back();
  option = app_.add_option(flag, value, help)->type_name(value_name);
}

void CommandLine::AddOptional(const std::string& flag, const std::string& value_name,
                              const std::string& help) {
  Add(flag, value_name, help);
  options_.back().first->expected(0, 1);
}

void CommandLine::AddSwitch(const std::string& flag, const std::string& help) {
  switches_.push_back(app_.add_flag(flag));
  switches_.back()->description(help);
}

std::map<std::string, std::string> CommandLine::Parse(int argc, const char* const* argv) {
  app_.parse(argc, argv);
  std::map<std::string, std::string> given;
  for (const auto& [option, value] : options_) {
    if (option->count() > 0) given.emplace(option->get_name(), value);
  }
  for (const CLI::Option* given_switch : switches_) {
    // "true", or what was written behind "=".
    if (given_switch->count() > 0) {
      given.emplace(given_switch->get_name(), given_switch->results().back());
    }
  }
  return given;
}

int CommandLine::Exit(const CLI::ParseError& error) {
  constexpr int kUsageError = 2;
  if (error.get_exit_code() == 0) {
    const int code = app_.exit(error);
    return std::cout.flush() ? code : kUsageError;  // a full disk
  }
  std::fprintf(stderr, "command line: %s%s; see %s --help\n", error.what(), Meant().c_str(),
               app_.get_name().c_str());
  return kUsageError;
}

// "; did you mean --domain", of the first unknown flag.
std::string CommandLine::Meant() const {
  std::vector<std::string> flags;
  for (const CLI::Option* option : app_.get_options({})) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  }
  for (const std::string& word : app_.remaining()) {
    if (word.starts_with("-")) return DidYouMean(word.substr(0, word.find('=')), flags);
  }
  return "";
}

}  // namespace giveway
