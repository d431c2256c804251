// What a vehicle of this fleet can be at most, and where. A scenario with more is refused at start,
// for no peer would believe a beacon that claims it.
#pragma once

namespace giveway {

// ARIA's absolute limit for the platform is 2.2 m/s, 22.6 rad/s at the wheel; beyond that with some
// margin a sender is no vehicle of this fleet.
inline constexpr double kMaxWheel_rad_s = 30.0;
inline constexpr double kMaxSpeed_m_s = 2.5;

// The most vehicles of an open fleet at any one time; each of its scenario may be one of them.
inline constexpr int kMaxOpenFleet = 1024;

// No place of a world lies further from its origin along either axis.
inline constexpr double kMaxCoordinate_m = 100'000;

}  // namespace giveway
