#include "services/types/impairment.h"

namespace giveway {

ImpairmentCounters& ImpairmentCounters::operator+=(const ImpairmentCounters& more) {
  packets += more.packets;
  bytes += more.bytes;
  passed += more.passed;
  passed_bytes += more.passed_bytes;
  dropped_blackout += more.dropped_blackout;
  dropped_rate += more.dropped_rate;
  dropped_loss += more.dropped_loss;
  dropped_burst += more.dropped_burst;
  delayed += more.delayed;
  held_back += more.held_back;
  reordered += more.reordered;
  duplicated += more.duplicated;
  corrupted += more.corrupted;
  metered += more.metered;
  abandoned += more.abandoned;
  return *this;
}

}  // namespace giveway
