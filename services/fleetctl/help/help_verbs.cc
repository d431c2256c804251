#include "services/fleetctl/help/help_verbs.h"

#include <cstdio>
#include <memory>
#include <vector>

#include "services/fleetctl/help/completion.h"
#include "services/fleetctl/help/verb_tree.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/types/nearest_name.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kHelpFooter = R"(
Examples
  fleetctl help
  fleetctl help run
  fleetctl help qos check

Exit code: 0 shown, 2 there is no such verb, or stdout did not take it.
)";

constexpr const char* kCompletionFooter = R"(
Prints what bash needs to complete verbs, flags and the names of scenarios, QoS sets, fault files
and campaigns. An installed Giveway has it in share/bash-completion already.

Examples
  source <(fleetctl completion bash)

Exit code: 0 shown, 2 an unknown shell, or stdout did not take it.
)";

constexpr const char* kBashScript =
    R"(# Completion of fleetctl for bash: fleetctl itself says the words.
_fleetctl() {
  local IFS=$'\n'
  # shellcheck disable=SC2207  # a word a line
  COMPREPLY=($("$1" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
}
complete -o default -F _fleetctl fleetctl
)";

// The exit code.
int Show(const std::string& text) {
  if (PrintAll(text)) return 0;
  std::fprintf(stderr, "fleetctl: stdout did not take all of it\n");
  return kCouldNotRun;
}

int ShowHelp(const CLI::App& fleetctl, const std::vector<std::string>& words) {
  const CLI::App* app = &fleetctl;
  std::string name = app->get_name();
  for (const std::string& word : words) {
    const CLI::App* verb = FindVerb(*app, word);
    if (verb == nullptr) {
      std::fprintf(stderr, "fleetctl: there is no verb '%s'%s\n", word.c_str(),
                   DidYouMean(word, VerbNames(*app)).c_str());
      return kCouldNotRun;
    }
    app = verb;
    name += " " + word;
  }
  // App::help() would explain the verb that was parsed, which is this one.
  return Show(app->get_formatter()->make_help(app, name, CLI::AppFormatMode::Normal));
}

void AddHelp(CLI::App* fleetctl, int* exit_code) {
  const auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* verb = fleetctl->add_subcommand("help", "Explain a verb, examples first");
  verb->footer(kHelpFooter);
  verb->add_option("VERB", *words, "Such as run, or qos check");
  verb->callback([=] { *exit_code = ShowHelp(*fleetctl, *words); });
}

void AddCompletion(CLI::App* fleetctl, int* exit_code) {
  CLI::App* verb = fleetctl->add_subcommand("completion", "Print the completion of a shell");
  verb->footer(kCompletionFooter);
  // Only checked: there is one to choose.
  verb->add_option("SHELL")->description("bash")->required()->check(CLI::IsMember({"bash"}));
  verb->callback([exit_code] { *exit_code = Show(kBashScript); });
  // Used by the shell: prints the words that may replace the last one.
  CLI::App* words = fleetctl->add_subcommand("complete", "")->group("")->prefix_command();
  words->set_help_flag();
  words->callback([=] {
    std::string lines;
    for (const std::string& word : Completions(*fleetctl, words->remaining())) lines += word + "\n";
    *exit_code = Show(lines);
  });
}

}  // namespace

void AddHelpVerbs(CLI::App* fleetctl, const std::string& version, int* exit_code) {
  AddHelp(fleetctl, exit_code);
  AddCompletion(fleetctl, exit_code);
  CLI::App* verb = fleetctl->add_subcommand("version", "Print the version, and Fast DDS's");
  verb->footer("\nExamples\n  fleetctl version\n");
  verb->callback([version, exit_code] { *exit_code = Show(version + "\n"); });
}

}  // namespace giveway::fleetctl
