// What people read of a sample: the words for its enumerators, and one line a sample with the
// fields that matter, headed by the vehicle it is about, as the lecture's consoles are. Pure.
#pragma once

#include <string>
#include <string_view>

#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/signal.h"

namespace giveway {

std::string_view Name(EventKind kind);
std::string_view Name(RunState state);
std::string_view Name(SignalPhase phase);
// 128 bits in hexadecimal.
std::string SessionText(const SessionId& session);
// "give_way 2".
std::string ReasonText(const Decision& decision);
// What a vehicle has counted about its peers and what its packet filter dropped, each kind with the
// id it was about last, as far as the status carries it, and the last event of all: "4 missed (last
// 9); last matched 2". "-" where there was nothing.
std::string EventsText(const VehicleStatus& status);

std::string ToLine(const ReceivedBeacon& received);
std::string ToLine(const VehicleStatus& status);
std::string ToLine(const Truth& truth);
std::string ToLine(const WorldEvent& event);
std::string ToLine(const RosterEntry& entry);
std::string ToLine(const SignalState& signal);
std::string ToLine(const RunFigures& figures);

}  // namespace giveway
