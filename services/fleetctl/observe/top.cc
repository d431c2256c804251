#include "services/fleetctl/observe/top.h"

#include <cstdio>
#include <exception>
#include <limits>

#include "services/fleetctl/observe/top_table.h"
#include "services/fleetctl/output/live_screen.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/link/observer_link.h"
#include "services/runtime/process.h"
#include "services/runtime/terminal_size.h"

namespace giveway::fleetctl {
namespace {

constexpr int kNoFleet = 1;
constexpr Nanoseconds kTableTurn = std::chrono::milliseconds(10);
constexpr Nanoseconds kFirstSamples = std::chrono::seconds(1);  // for discovery to find a vehicle
// Without a terminal nothing is cut.
constexpr TerminalSize kEndless{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};

class Top {
 public:
  explicit Top(const TopOptions& options)
      : options_(options),
        in_place_(IsTerminal() && !options.json && !options.once),
        observer_(LinkOptionsOf(options.where)),
        post_{options.where.domain, options.where.interface, options.where.area, SteadyNow()},
        screen_(in_place_) {}

  int Run() { return options_.once ? Once() : Live(); }

 private:
  int Once() {
    const SteadyTime end = post_.since + FromSeconds(options_.wait_s);
    while (!fleet_.IsSettled(SteadyNow()) && SteadyNow() < end) {
      if (Interrupts::Count() > 0) return 0;
      Turn();
    }
    if (fleet_.IsAnyHeard()) return ExitCodeOf(WriteStdout(Block()));
    if (options_.json) WriteStdout(Block());
    std::fprintf(stderr, "%s\n", NothingHeard(post_, SteadyNow()).c_str());
    return kNoFleet;
  }

  int Live() {
    while (Interrupts::Count() == 0) {
      Turn();
      const SteadyTime now = SteadyNow();
      if (!fleet_.IsAnyHeard() && now - post_.since < kFirstSamples) continue;
      if (!screen_.IsDue(now)) continue;
      if (in_place_) {
        screen_.Draw(TopLines(fleet_, post_, now, SizeOfTerminal()));
      } else if (const WriteResult result = WriteStdout(Block() + (options_.json ? "" : "\n"));
                 result != WriteResult::kWritten) {
        return ExitCodeOf(result);
      }
    }
    return 0;
  }

  void Turn() {
    SleepUntil(SteadyNow() + kTableTurn);
    const link::Observed observed = observer_.Take();
    fleet_.Fold(observed, SteadyNow());
  }

  std::string Block() const {
    if (options_.json) return TopJson(fleet_, post_, SteadyNow()) + "\n";
    std::string text;
    for (const std::string& line : TopLines(fleet_, post_, SteadyNow(), kEndless)) {
      text += line + "\n";
    }
    return text;
  }

  const TopOptions& options_;
  const bool in_place_;
  link::ObserverLink observer_;
  ListeningPost post_;
  FleetSnapshot fleet_;
  LiveScreen screen_;
};

}  // namespace

int RunTop(const TopOptions& options) {
  if (!HasStdout()) return 0;
  const Interrupts interrupts;
  return Top(options).Run();
}

}  // namespace giveway::fleetctl
