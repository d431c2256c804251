// What Fast DDS logs, errors only: its default is stdout, where our JSON goes. It goes where the
// program says, and the last of it is kept so that a start-up error can quote the library's own
// words.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace giveway::link {

// Takes the library's log over. Once a process; later calls do nothing.
void TakeOverLibraryLog();

// From now on each line is handed to `take` instead of being written to stderr; it is called on the
// library's log thread, and must not wait. A line that the library repeats is handed on once in ten
// seconds.
void SetLibraryLog(std::function<void(const std::string& line)> take);

// What the library complained about since the last call, one line each; empty if nothing. It was
// sent on already.
std::string LibraryComplaints();

// How often the library said that it stops watching the deadlines of a reader. A reader of beacons
// continues by this vehicle's own clock.
std::uint32_t DeadlineWatchesLost();

}  // namespace giveway::link
