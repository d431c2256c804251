// A reservation scheme in order of arrival, after Dresner and Stone, "A Multiagent Approach to
// Autonomous Intersection Management" (JAIR 31, 2008): vehicles call ahead, one manager books the
// tiles of ground that a body covers, step by step in time, first come, first served. A baseline
// for measuring. Better off than theirs: all vehicles call at the start, plans are driven as
// booked, and instead of asking again after a refusal each is given the soonest passage there is,
// straight or round standing vehicles.
#pragma once

#include <optional>
#include <vector>

#include "services/types/scenario.h"
#include "tests/bench/baseline/arc_path.h"
#include "tests/bench/baseline/arrivals.h"
#include "tests/bench/baseline/detour.h"
#include "tests/bench/baseline/passage.h"
#include "tests/bench/baseline/pilot.h"
#include "tests/bench/baseline/tiles.h"

namespace giveway::bench {

struct ReservationSettings {
  double tile_m = 0.05;
  double margin_m = 0.1;  // that bodies keep from each other at least, shell to shell
};

class Reservation : public Pilot {
 public:
  explicit Reservation(const Scenario& scenario, const ReservationSettings& settings = {});

  void Drive(std::uint32_t tick, std::span<const Seen> fleet,
             std::span<WheelSpeeds> wheels) override;
  // Vehicles that no passage was found for: they stay where they are.
  std::size_t Refused() const;

 private:
  struct Member {
    VehicleOptions options;
    Pace pace;
    Arrival arrival;
    ArcPath path;
    std::optional<Passage> passage;
  };

  void ServeEveryone();
  void HoldBackThoseBehind(std::size_t ahead);
  bool MayAsk(const Member& member) const;
  // False: it stays where it stands.
  bool Serve(Member* member);
  // True if it arrives along the path by last_step at the latest; it takes the path then.
  bool Try(const ArcPath& path, Step last_step, Member* member) const;
  std::vector<Standing> StandingBeside(const Member& member) const;
  void Book(const Member& member);
  std::vector<Tile> TilesAt(const Member& member, double driven_m) const;
  double Radius(const Member& member) const;

  ReservationSettings settings_;
  Step last_step_;
  std::vector<Member> members_;
  TileBook book_;
};

}  // namespace giveway::bench
