// Sends what Fast DDS logs to stderr (its default is stdout, where our JSON goes), errors only, and
// keeps the last of it so that a start-up error can quote the library's own words.
#pragma once

#include <functional>
#include <string>

namespace giveway::link {

// Takes the library's log over. Once a process; later calls do nothing.
void TakeOverLibraryLog();

// From now on each line is handed to `take` instead of being written to stderr; it is called on the
// library's log thread, and must not wait.
void SetLibraryLog(std::function<void(const std::string& line)> take);

// What the library complained about since the last call, one line each; empty if nothing. It was
// on stderr already.
std::string LibraryComplaints();

}  // namespace giveway::link
