// What may stand where a user is typing: verbs, flags, values, and the names of what is shipped.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace giveway::fleetctl {

// `words` are those behind the program's name; the last is the one that is being typed, and may be
// empty. Words that start with it, sorted; none where a file is meant, or anything.
std::vector<std::string> Completions(const CLI::App& fleetctl,
                                     const std::vector<std::string>& words);

}  // namespace giveway::fleetctl
