// The health of one service: its loop reports its state, the server's threads answer requests.
// Between the two is a board on which the loop never waits. If a loop that has started does not
// report for kWatchdogLimit, its process is ended.
#pragma once

#include <cstdint>
#include <optional>

#include "services/config/flags.h"
#include "services/health/health_board.h"
#include "services/health/health_metrics.h"
#include "services/health/health_server.h"
#include "services/runtime/process.h"
#include "services/runtime/watchdog.h"

namespace giveway {

template <typename Health>
class HealthService {
 public:
  // Does not serve where the flags name no port. Throws InputError.
  explicit HealthService(const ServiceFlags& flags) {
    if (flags.watchdog) watchdog_.emplace();
    Publish();
    if (flags.health_port == 0) return;
    server_.emplace(flags.health_address, static_cast<std::uint16_t>(flags.health_port),
                    HealthPages{.not_live = [this] { return WhyNotLive(); },
                                .not_ready = [this] { return WhyNotReady(); },
                                .metrics = [this] { return Metrics(); }});
  }

  // The loop's own; not visible to others before Publish.
  Health& Now() { return now_; }
  const Health& Now() const { return now_; }
  // Publishes it, as of a loop that turns. Never waits.
  void Publish() {
    now_.loop.turned = SteadyNow();
    ++now_.loop.turns;
    board_.Publish(now_);
    if (watchdog_) IsWatched(now_.loop.stage) ? watchdog_->Feed() : watchdog_->Rest();
  }

 private:
  // The clock is read last: what is on the board is never of the future.
  Reasons WhyNotLive() const {
    const Health seen = board_.Read();
    return NotLive(seen.loop, SteadyNow());
  }
  Reasons WhyNotReady() const {
    const Health seen = board_.Read();
    return NotReady(seen, SteadyNow());
  }
  std::string Metrics() const {
    const Health seen = board_.Read();
    return MetricsText(seen, ReadProcessFigures(), SteadyNow());
  }

  Health now_;
  HealthBoard<Health> board_;
  std::optional<Watchdog> watchdog_;
  std::optional<HealthServer> server_;  // last: gone before what it reads
};

}  // namespace giveway
