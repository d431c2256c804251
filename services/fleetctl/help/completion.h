// Completes what a user is typing: verbs, flags, values, and the names of shipped files.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace giveway::fleetctl {

// `words` are those after the program's name; the last is the one being typed, and may be empty.
// Returns the words that start with it, sorted; none where a file or free text is expected.
std::vector<std::string> Completions(const CLI::App& fleetctl,
                                     const std::vector<std::string>& words);

}  // namespace giveway::fleetctl
