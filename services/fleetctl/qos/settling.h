// When a search may end: nothing more has been found for a while. Pure.
#pragma once

#include <cstddef>

#include "services/types/time.h"

namespace giveway::fleetctl {

class Settling {
 public:
  struct Patience {
    Nanoseconds quiet{0};      // without a further find
    Nanoseconds limit{0};      // since the start, in any case
    std::size_t at_least = 0;  // with fewer finds only the limit ends the search
  };

  Settling(const Patience& patience, SteadyTime start)
      : patience_(patience), start_(start), last_find_(start) {}

  // `found`: how many there are now. True once the search may end.
  bool Take(std::size_t found, SteadyTime now) {
    if (found != found_) last_find_ = now;
    found_ = found;
    if (now - start_ >= patience_.limit) return true;
    return found_ >= patience_.at_least && now - last_find_ >= patience_.quiet;
  }

 private:
  const Patience patience_;
  const SteadyTime start_;
  SteadyTime last_find_;
  std::size_t found_ = 0;
};

}  // namespace giveway::fleetctl
