// An observer at work: one loop reads the fleet and makes frames, the server's threads read what
// the loop left. Nothing in the fleet waits for either.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "services/link/observer_link.h"
#include "services/node/interface_check.h"
#include "services/observer/fleet/fleet_view.h"
#include "services/observer/fleet_metrics.h"
#include "services/observer/foxglove/foxglove_feed.h"
#include "services/observer/observer_flags.h"
#include "services/observer/ros2/ros2_publisher.h"
#include "services/observer/server/page_server.h"
#include "services/runtime/process.h"
#include "services/runtime/refusal_log.h"
#include "services/types/scenario.h"

namespace giveway {

class ObserverService {
 public:
  // Opens the port and joins the domain. Throws ServerError, LinkError, InputError.
  explicit ObserverService(const ObserverFlags& flags);
  ~ObserverService();

  // False where its network interface is another: it hears nothing until it is started again. A
  // loop that hangs ends the process, see Watchdog.
  bool Run(const StopSignal& stop);

 private:
  ObserverService(const ObserverFlags& flags, const std::optional<Scenario>& scenario);
  PageSources Sources(const ObserverFlags& flags, const std::optional<Scenario>& scenario);
  std::optional<PageAnswer> Get(const std::string& path, const ServerFigures& server);
  PageAnswer Metrics(const ServerFigures& server);
  PageAnswer Ready();
  bool Turn();
  void PublishRos2(const link::Observed& observed);
  void Publish(SteadyTime now);

  std::mutex mutex_;
  FleetView view_;                     // guarded by mutex_
  std::uint64_t refused_samples_ = 0;  // guarded by mutex_
  RefusalLog refusal_log_;             // of the loop
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::int64_t> turned_ns_;
  FrameBoard board_;
  link::ObserverLink link_;
  InterfaceCheck interface_check_{[this] { return link_.InterfaceChange(); }};
  std::optional<Ros2Publisher> ros2_;  // of the loop
  bool ros2_refusal_logged_ = false;
  std::unique_ptr<FoxgloveFeed> foxglove_;  // null where it was not asked for
  PageServer server_;  // last: its threads read all of the above, from its constructor on
};

}  // namespace giveway
