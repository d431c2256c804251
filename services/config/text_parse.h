// What the protobuf text parser has to say about a text, as problems.
#pragma once

#include <string>
#include <vector>

#include "services/config/problem.h"

namespace giveway {

// Turns one message of the parser into a Problem. `unknown_field` distinguishes a tolerated unknown
// field from an error that stopped the parser. Lines and columns as the parser counts, from 0.
Problem ParserProblem(const std::string& file, const std::string& text, int line, int column,
                      const std::string& message, bool unknown_field);

}  // namespace giveway
