// Replaces driver.cc where libFuzzer drives: without a corpus it starts from our samples.
#include <algorithm>

#include "tests/fuzz/mutate.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  static const giveway::fuzz::Mutator mutator(1, giveway::fuzz::Samples());
  constexpr unsigned kOurs = 32;  // one in so many is ours
  if (size > 1 && seed % kOurs != 0) return LLVMFuzzerMutate(data, size, max_size);
  const giveway::fuzz::Input input = mutator.Make(seed / kOurs);
  const std::size_t bytes = std::min(input.size(), max_size);
  std::copy_n(input.begin(), bytes, data);
  return bytes;
}
