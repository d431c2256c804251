// Broken invariants of a run, and what did not fit, as both reports print them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/types/counters.h"

namespace giveway::schema {
class Trust;
class Violations;
}  // namespace giveway::schema

namespace giveway {

// How often an invariant was broken, in the order they are printed.
struct BrokenInvariant {
  std::string name;
  std::uint32_t count = 0;
};

void SetViolations(const std::vector<BrokenInvariant>& violations, schema::Violations* message);
void SetTrust(const TrustCounters& counters, schema::Trust* message);

}  // namespace giveway
