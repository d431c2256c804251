// Profile files are written as Fast DDS 2.9 spells them. This says the same in the words of the
// release at hand, so that one file serves a fleet of both.
#pragma once

#include <string>

namespace giveway::link {

std::string InOwnSpelling(std::string profiles);

}  // namespace giveway::link
