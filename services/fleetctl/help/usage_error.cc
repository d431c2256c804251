#include "services/fleetctl/help/usage_error.h"

#include <vector>

#include "services/fleetctl/help/verb_tree.h"
#include "services/types/nearest_name.h"

namespace giveway::fleetctl {
namespace {

const CLI::App& Deepest(const CLI::App& app) {
  const auto named = app.get_subcommands();
  return named.empty() ? app : Deepest(*named.front());
}

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string NamedVerb(const CLI::App& fleetctl) {
  const auto named = fleetctl.get_subcommands();
  return fleetctl.get_name() + (named.empty() ? "" : " " + NamedVerb(*named.front()));
}

std::string ExplainUsageError(const CLI::App& fleetctl, const CLI::ParseError& error) {
  const CLI::App& verb = Deepest(fleetctl);
  const auto verbs = VerbNames(verb);
  for (const std::string& word : verb.remaining()) {
    if (!word.starts_with("-")) {
      if (verbs.empty()) continue;
      return "there is no verb '" + word + "'" + DidYouMean(word, verbs) +
             "\nverbs: " + Listed(verbs);
    }
    const std::string flag = word.substr(0, word.find('='));
    return NamedVerb(fleetctl) + " has no flag " + flag + DidYouMean(flag, FlagNames(verb));
  }
  if (!verbs.empty()) return "a verb is missing\nverbs: " + Listed(verbs);
  return error.what();
}

}  // namespace giveway::fleetctl
