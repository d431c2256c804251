// Mutates samples at random. An input follows from the seed and its number alone, so any one of a
// run can be reproduced without the ones before it.
#pragma once

#include <cstdint>
#include <vector>

#include "services/types/math/random.h"
#include "tests/fuzz/target.h"

namespace giveway::fuzz {

inline constexpr std::size_t kMaxInputBytes = 64U << 10U;

class Mutator {
 public:
  Mutator(std::uint64_t seed, std::vector<Input> samples);
  // The input of this number; the first ones are the samples themselves.
  Input Make(std::uint64_t number) const;

 private:
  std::uint64_t seed_;
  std::vector<Input> samples_;
};

}  // namespace giveway::fuzz
