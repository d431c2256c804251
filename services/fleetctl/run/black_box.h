// The last seconds of a fleet as a page, written when a soak's promise is broken: what the vehicles
// did just before, with ranges and with which vehicle waits for which. Keeps a limited time of
// frames in memory; a thread of its own writes the files, because they may be large and must not
// stall the caller's loop.
#pragma once

#include <cstddef>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "services/link/observer_link.h"
#include "services/observer/capture/run_frames.h"
#include "services/observer/fleet/fleet_view.h"
#include "services/types/scenario.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class BlackBox {
 public:
  // `last`: how much of the run a page shows.
  BlackBox(const Scenario& scenario, std::filesystem::path folder, Nanoseconds last);

  void Fold(const link::Observed& observed, SteadyTime now);
  // Starts to write a page of what is in memory now.
  void Write();
  // Waits for the pages that are being written.
  void Finish();
  // The file of the n-th page, from 0, by its folder's name; empty until it is complete.
  std::string Written(std::size_t page) const;

 private:
  struct Page {
    std::string name;
    std::shared_future<bool> written;
  };

  const std::string scene_;
  const std::filesystem::path folder_;
  FleetView view_;
  RunFrames frames_;
  std::vector<Page> pages_;
  std::size_t number_ = 0;  // of the last page
};

}  // namespace giveway::fleetctl
