// Which of the defects of mutants.txt a run has: read once, before the first vehicle. Included
// before everything else in the sources that are compiled with them.
#pragma once

#include <cstdlib>
#include <string_view>

namespace giveway {

inline bool IsMutant(std::string_view name) {
  static const char* const kMutant = std::getenv("GIVEWAY_MUTANT");
  return kMutant != nullptr && name == kMutant;
}

}  // namespace giveway
