// The command line of a program whose flags have twins in the environment: CLI11 splits it and
// prints the help. The values stay text: judging them is that of FlagValues, so that a flag and its
// twin are refused with the same words.
#pragma once

#include <CLI/CLI.hpp>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace giveway {

class CommandLine {
 public:
  // `version` is what --version prints, the footer what follows the flags in the help.
  CommandLine(const std::string& name, const std::string& description, const std::string& version,
              const std::string& footer);

  void Add(const std::string& flag, const std::string& value_name, const std::string& help);
  // Its value may be left out.
  void AddOptional(const std::string& flag, const std::string& value_name, const std::string& help);
  // It may have a value, as its twin has: --admin=false. The last one counts.
  void AddSwitch(const std::string& flag, const std::string& help);

  // The flags given and their values. Throws CLI::ParseError.
  std::map<std::string, std::string> Parse(int argc, const char* const* argv);
  // Prints help or version and gives 0, or what is wrong, with the flag that was probably meant,
  // and gives 2.
  int Exit(const CLI::ParseError& error);

 private:
  std::string Meant() const;

  CLI::App app_;
  std::list<std::pair<CLI::Option*, std::string>> options_;  // a list: CLI11 keeps references
  std::vector<CLI::Option*> switches_;
};

}  // namespace giveway
