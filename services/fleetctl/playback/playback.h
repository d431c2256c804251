// What `fleetctl replay` and `report` do with an MCAP recording: show the run on the page, with
// seek, pause and speed, or write that page to a file, for a report with the report open. Values
// in; the exit code out.
#pragma once

#include <cstdint>
#include <string>

namespace giveway::fleetctl {

struct PlaybackOptions {
  std::string file;
  std::string scenario;   // shows its walls; empty: none are shown
  std::string html_file;  // written instead of being served; empty: served
  bool report = false;    // the page opens with the report of the run; its file's name is printed
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;
};

// Whether playback can show the file, by its name.
bool IsMcapFile(const std::string& file);

// 0 shown until Ctrl-C, or written, also of a file that was cut off; 1 nothing in the file can be
// shown; 2 could not run, or the file is damaged: then it is shown up to there.
int RunPlayback(const PlaybackOptions& options);

}  // namespace giveway::fleetctl
