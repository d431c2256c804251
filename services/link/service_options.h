// What a service's link needs in addition to LinkOptions.
#pragma once

#include <chrono>

#include "services/types/time.h"

namespace giveway::link {

struct ServiceOptions {
  // Without it there is no endpoint that an order could reach.
  bool takes_orders = true;
  // From one tick of the world to the next: a world whose ticks come faster is not believed.
  Nanoseconds tick_period = std::chrono::milliseconds(1);
};

}  // namespace giveway::link
