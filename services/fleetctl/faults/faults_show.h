// What `fleetctl faults` prints, as text. Pure.
#pragma once

#include <string>

#include "services/faults/expand.h"

namespace giveway::fleetctl {

// A fault file with `at` rules only; what was left out is a comment at its head.
std::string ExpansionFile(const faults::Expansion& expansion);
// A table, one line per fault, and what was left out.
std::string ExpansionText(const faults::Expansion& expansion);
// {"faults": [...], "left_out": [...]} with the names of idl/faults.proto.
std::string ExpansionJson(const faults::Expansion& expansion);

// The table of kinds.
std::string KindsText();
std::string KindsJson();

}  // namespace giveway::fleetctl
