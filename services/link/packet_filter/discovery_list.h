// The parameter list that a discovery writer sends as its payload: what a participant, or one of
// its endpoints, says of itself. Whether the list ends where its payload ends, and the numbers and
// lengths that parameters state fit into them: Fast DDS takes memory for what is stated before it
// looks whether it is there. Formats: OMG RTPS 2.3, 9.6.2.2; DDS-Security 1.1, 7.2.
//
// What a list says is not judged here, and neither what DDS-Security encrypts, nor type
// information.
#pragma once

#include "services/link/packet_filter/rtps_bytes.h"
#include "services/types/figures/packet_counters.h"

namespace giveway::link {

// kNone if a submessage that is sound by itself (submessage_check.h) is not of a discovery writer,
// or its list is sound. `secured`: DDS-Security is on, and so lists may hold tokens.
PacketDrop CheckDiscovery(const Submessage& submessage, bool secured);

}  // namespace giveway::link
