// What the packet filters of this process did. Knows no Fast DDS.
#pragma once

#include "services/types/figures/packet_counters.h"

namespace giveway::link {

// Of all participants together; services have one. Never waits.
PacketCounters PacketsOfProcess();

}  // namespace giveway::link
