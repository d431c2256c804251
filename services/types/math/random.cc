#include "services/types/math/random.h"

#include "services/types/math/math.h"

namespace giveway {

Random::Random(std::uint64_t seed, std::uint64_t stream) : state_(seed) {
  state_ = Next() ^ (stream * 0xd1342543de82ef95ULL);
  state_ = Next();
}

std::uint64_t Random::Next() {
  state_ += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

double Random::Uniform(double low, double high) {
  const double unit = static_cast<double>(Next() >> 11) * 0x1p-53;
  return low + unit * (high - low);
}

double Random::Gaussian(double sigma) {
  const double u = 1 - Uniform(0, 1);  // never 0
  const double v = Uniform(0, 1);
  return sigma * Sqrt(-2 * Log(u)) * Cos(2 * kPi * v);
}

}  // namespace giveway
