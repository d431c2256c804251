// What of a request is looked at before it is answered. A page of another site may have a browser
// ask this server by a name that leads here (DNS rebinding): then the Host header has that name.
// Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/types/ids.h"

namespace giveway {

// True for an address in numbers, localhost, and the names given, each with or without a port.
bool IsOwnHost(std::string_view host, const std::vector<std::string>& names);

// The id at the end of /api/v1/vehicles/7; nothing for anything else.
std::optional<VehicleId> VehicleOfPath(std::string_view rest);

}  // namespace giveway
