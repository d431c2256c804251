#include "services/fleetctl/observe/listen.h"

#include <cstdio>
#include <exception>

#include "services/fleetctl/observe/top_table.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/link/observer_link.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr int kNothingHeard = 1;
constexpr Nanoseconds kListenTurn = std::chrono::milliseconds(5);
constexpr Nanoseconds kHintAfter = std::chrono::seconds(5);

class Listening {
 public:
  explicit Listening(const ListenOptions& options)
      : options_(options),
        observer_(LinkOptionsOf(options.where)),
        post_{options.where.domain, options.where.interface, options.where.area, SteadyNow()} {}

  int Run() {
    while (Interrupts::Count() == 0 && !IsOver()) {
      SleepUntil(SteadyNow() + kListenTurn);
      const WriteResult result = WriteNew();
      if (result != WriteResult::kWritten) return ExitCodeOf(result);
      HintIfQuiet();
    }
    if (heard_ > 0 || Interrupts::Count() > 0) return 0;
    PrintReason();
    return kNothingHeard;
  }

 private:
  Nanoseconds Since() const { return SteadyNow() - post_.since; }

  bool IsOver() const {
    if (options_.count && heard_ >= *options_.count) return true;
    return options_.duration_s && Seconds(Since()) >= *options_.duration_s;
  }

  WriteResult WriteNew() {
    const link::Observed observed = observer_.Take();
    fleet_.Fold(observed, SteadyNow());
    std::string text;
    for (const std::string& line : SampleLines(observed, options_.filter, Seconds(Since()))) {
      if (options_.count && heard_ >= *options_.count) break;
      text += line + "\n";
      ++heard_;
    }
    return text.empty() ? WriteResult::kWritten : WriteStdout(text);
  }

  void HintIfQuiet() {
    if (heard_ > 0 || hinted_ || Since() < kHintAfter) return;
    hinted_ = true;
    PrintReason();
  }

  void PrintReason() const {
    if (!fleet_.IsAnyHeard()) {
      std::fprintf(stderr, "%s\n", NothingHeard(post_, SteadyNow()).c_str());
      return;
    }
    std::fprintf(stderr,
                 "a fleet is there, but nothing was received on %s for %.1f s%s; "
                 "--area and --qos must be the fleet's: fleetctl why says what does not match\n",
                 std::string(Name(options_.filter.topic)).c_str(), Seconds(Since()),
                 options_.filter.vehicles.empty() ? "" : " of the vehicles asked for");
  }

  const ListenOptions& options_;
  link::ObserverLink observer_;
  ListeningPost post_;
  FleetSnapshot fleet_;  // only for better error messages
  std::uint64_t heard_ = 0;
  bool hinted_ = false;
};

}  // namespace

int RunListen(const ListenOptions& options) {
  if (!HasStdout()) return 0;
  const Interrupts interrupts;
  return Listening(options).Run();
}

}  // namespace giveway::fleetctl
