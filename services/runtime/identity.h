// The identity of a service, and the heap it uses, for tools that look at its process from outside:
// small texts in memory that /proc/PID/fd shows under names of their own. No flag holds the id that
// a world assigned, in containers process ids are all the same, and no allocator can be asked from
// outside; but a tool that may read a process's environment finds these, in whatever namespaces it
// runs. They end with the process, and no file stays behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "services/types/ids.h"

namespace giveway {

struct Identity {
  VehicleId vehicle = kNoVehicle;  // that the world gave; of a world none
  std::string participant;         // the first twelve bytes of its GUIDs, hexadecimal

  friend bool operator==(const Identity&, const Identity&) = default;
};

std::string ToText(const Identity& identity);
// Nothing if it is no such text.
std::optional<Identity> ParseIdentity(std::string_view text);

// From now on log lines name the vehicle: JSON by `"vehicle": 3`, text after the process's name.
void SetLogVehicle(VehicleId id);

// Of this process; a later call replaces it. Where the system gives no memory for it nothing is
// published: tools then know less, and nothing else depends on it.
void PublishIdentity(const Identity& identity);
// Of the process with this folder in /proc. Nothing if it publishes none, or may not be read.
std::optional<Identity> ReadIdentity(const std::filesystem::path& process);

// The same for the bytes of heap that this process uses now.
void PublishHeap(std::uint64_t bytes);
std::optional<std::uint64_t> ReadHeap(const std::filesystem::path& process);

}  // namespace giveway
