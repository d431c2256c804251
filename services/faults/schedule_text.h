// A list of faults as text: a line each for people, and the protobuf text that reads back as the
// same list, number for number. Pure.
#pragma once

#include <string>

#include "services/faults/fault.h"

namespace giveway::faults {

// The shortest decimal that is read as this very number, without an exponent where it has a usual
// size.
std::string NumberText(double value);
// As NumberText, of a time that is no longer than milliseconds.
std::string SecondsText(double time_s);
// "probability=0.2 delay_s=0.05"; empty of none.
std::string ParametersText(const Parameters& parameters);
// "12.5 s for 2 s: vehicle 3: loss probability=0.2".
std::string Line(const Fault& fault);

// Of a fault file with `at` rules only, see idl/faults.proto. Not empty without faults: an empty
// file is refused.
std::string AsTextproto(const Schedule& schedule);

}  // namespace giveway::faults
