// Random numbers that repeat from a seed on any machine: SplitMix64 (Steele, Lea, Flood 2014) and
// distributions of our own, because the standard library's differ between implementations.
#pragma once

#include <cstdint>

namespace giveway {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  // A generator for `stream` of this seed: streams do not share numbers, so drawing more from one
  // vehicle's stream never moves another's.
  Random(std::uint64_t seed, std::uint64_t stream);

  std::uint64_t Next();
  // Uniform in [low, high).
  double Uniform(double low, double high);
  // Normal with mean 0 and the given standard deviation (Box-Muller, two uniforms a call).
  double Gaussian(double sigma);

 private:
  std::uint64_t state_;
};

}  // namespace giveway
