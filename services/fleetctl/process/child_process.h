// One child process that cannot leak: started with its output through a pipe, polled and signalled
// by process id only, killed and reaped on destruction. It dies with its parent (parent-death
// signal). Whether an exit was expected is for the caller to decide.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "services/fleetctl/process/child_log.h"
#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {

// The operating system could not create the process or its pipe. Main exits with 2.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// For a process that was just forked: it is killed when its parent dies, whatever it is doing then,
// and exits at once if the parent has died already.
void DieWith(pid_t parent);

// How a process ended.
struct ProcessEnd {
  bool by_signal = false;
  int number = 0;  // the signal, or the exit code

  // The exit code of one that was reaped elsewhere; no process has it.
  static constexpr int kNotKnown = -1;

  friend bool operator==(const ProcessEnd&, const ProcessEnd&) = default;
};

// "exit code 2", "exit code not known" or "signal 9 (Killed)".
std::string Describe(ProcessEnd end);

// The folder of the fleet's programs: that of this executable.
std::filesystem::path ProgramFolder();

// The output of a child, in bytes.
struct OutputFlow {
  std::uint64_t read = 0;    // by this process, so far
  std::uint64_t unread = 0;  // in the pipe

  friend bool operator==(const OutputFlow&, const OutputFlow&) = default;
};

struct ChildCommand {
  std::string name;                // for messages: "vehicle 2"
  std::vector<std::string> words;  // the program's path, then its arguments
  std::string log_file;            // the child's output is copied here; empty: nowhere
  int kept_fd = -1;                // stays open in the child as descriptor 3; -1: none
  bool hands_on_lines = false;     // every line is kept for TakeLines
  // No GIVEWAY_ variable of this shell is passed on as a flag. Without this the log's format, the
  // world's threads and free partitions may be set by it; no other flag ever is.
  bool flags_only = false;
  // It handles SIGINT and SIGTERM, and lets them pass once it does (StopSignal): until then they
  // wait, as do those of HangSignal. Without this a stop that comes early ends it, as any program.
  bool handles_stops = false;
  // NAME=value each, in addition to what is passed on from this process's environment.
  std::vector<std::string> environment = {};
};

class ChildProcess {
 public:
  static constexpr std::size_t kLinesKept = 20;

  // Call from the main thread, or one that outlives the child: the parent-death signal is tied to
  // the thread that forks.
  explicit ChildProcess(const ChildCommand& command);  // Throws StartError.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Reads the child's output and checks whether it has ended. Never blocks.
  void Poll();
  // Whether any child of this process has ended and was not polled since.
  static bool AnyHasEnded();
  // Readable when there is output, for poll(2) of many children at once.
  int OutputDescriptor() const { return output_.Get(); }
  const std::optional<ProcessEnd>& End() const { return end_; }
  bool IsRunning() const { return !end_.has_value(); }
  // While this is off, its output stays in the pipe, which fills up. An exit is still noticed.
  void HearOutput(bool hear) { hears_ = hear; }
  OutputFlow Output() const;
  // Has no effect on a child that has ended: its id may belong to another process.
  void Signal(int signal_number);
  // SIGTERM, once: a second one would end a service before it has left gracefully.
  void AskToStop();

  const std::string& Name() const { return name_; }
  pid_t Pid() const { return pid_; }
  // The complete output lines since the last call, if the command asked for them.
  std::vector<std::string> TakeLines() { return std::exchange(lines_, {}); }
  // About its log, see ChildLog.
  std::vector<std::string> TakeLogComplaints() { return log_.TakeComplaints(); }
  // The last output lines of the child, oldest first.
  const std::deque<std::string>& LastLines() const { return last_lines_; }

 private:
  void ReadOutput();
  void KeepLines(const char* text, std::size_t size);

  std::string name_;
  pid_t pid_ = -1;
  FileDescriptor output_;
  ChildLog log_;
  bool hands_on_lines_;
  bool hears_ = true;
  std::uint64_t bytes_read_ = 0;
  bool asked_to_stop_ = false;
  std::optional<ProcessEnd> end_;
  std::string unfinished_line_;
  std::deque<std::string> last_lines_;
  std::vector<std::string> lines_;
};

}  // namespace giveway::fleetctl
