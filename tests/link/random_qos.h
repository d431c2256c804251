// Random QoS as profile text, for tests that hold a prediction of services/qos against the library.
#pragma once

#include <cstdint>
#include <string>

#include "services/types/math/random.h"

namespace giveway::test {

// A writer profile NAME_writer and a reader profile NAME_reader that match about half of the time.
// Both can be made.
std::string RandomPair(const std::string& name, Random* random);

// Profiles of a writer and a reader that the library refuses to make about half of the time.
std::string RandomLimits(const std::string& name, Random* random);

std::string AsFile(const std::string& profiles);

}  // namespace giveway::test
