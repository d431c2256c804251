// The promises of a loaded scenario, written down a second time: idl/scenario.proto gives them to
// the author of a file, and every module behind config relies on them.
#pragma once

#include "services/types/scenario.h"

namespace giveway::fuzz {

void CheckScenario(const Scenario& scenario);

// Judged by the C library: the reader's own idea of UTF-8 is on trial here.
bool IsUtf8(const std::string& text);

}  // namespace giveway::fuzz
