// What the page draws of one moment, as compact JSON: a frame. A fleet of 200 takes some 25 kB. For
// programs there is fleet_json.h, in the names of fleet.idl.
//
//   {"at_ms":…,            the observer's steady clock
//    "world":{"epoch":…,"state":"running","time_ms":…,"fleet_size":…,"heard":…,
//             "age_ms":…},
//    "vehicles":[[…],…],   whole numbers, a row a vehicle; the columns are kVehicleColumns
//    "ranges":{"7":[…16]}, mm from the transducer; -1 clear, -2 no data
//    "signals":[[id,x1,y1,x2,y2,phase,to_change_ms],…],
//    "events":[{…},…]}     the newest, in the names of fleet.idl; the page knows which it has
//
// Lengths are millimetres, angles milliradians, times milliseconds, areas square millimetres; -1
// where a value of them does not exist. Pure.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "services/observer/fleet/fleet_view.h"
#include "services/types/time.h"

namespace giveway {

inline constexpr std::array<std::string_view, 25> kVehicleColumns{
    "id",          "x",          "y",        "heading",    "speed",
    "hearing",     "mode",       "rule",     "peer",       "gives_way_to",
    "blocked_by",  "beacon_age", "nearest",  "estimate_x", "estimate_y",
    "xx",          "xy",         "yy",       "radius",     "reaction",
    "peers_heard", "arrived",    "toward_x", "toward_y",   "has_body"};

// Of a fleet larger than this the ranges stay out: a client gets at most 300 kB/s.
inline constexpr std::size_t kMostWithRanges = 200;

// Many enough that a client which misses frames misses no event.
inline constexpr std::size_t kEventsInFrame = 24;

std::string FrameJson(const FleetView& view, SteadyTime now,
                      std::size_t most_events = kEventsInFrame);

}  // namespace giveway
