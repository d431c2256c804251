// Which participant each session is of, and each vehicle's id with it: the one that asked first.
// The session goes to another only when its own has left or has been silent: it was restarted. Who
// knows the secret that a session is made of may end it from anywhere. Bounded: the oldest sessions
// that have no place go first. Knows no DDS, has no clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <unordered_map>
#include <vector>

#include "services/types/fleet_facts.h"
#include "services/types/time.h"

namespace giveway::link {

class SessionOwners {
 public:
  static constexpr std::size_t kMostSessions = 4096;
  static constexpr std::size_t kMostOfOne = 8;  // a process has one, or a test a few
  // A vehicle in the world sends a command a tick; one that waits asks again every second.
  static constexpr Nanoseconds kSilence = std::chrono::milliseconds(750);
  static constexpr Nanoseconds kSilenceOfAWaiting = std::chrono::seconds(3);

  enum class Verdict : std::uint8_t { kYes, kTooMany, kOfAnother };

  // Whether a participant may ask for a place, or leave, by this request. `left`: whether the
  // writer of this identity has. One that may is the session's owner from now on.
  Verdict MayAsk(const JoinRequest& request, std::uint64_t participant, std::uint64_t writer,
                 SteadyTime now, const std::function<bool(std::uint64_t writer)>& left);
  Verdict MayLeave(const JoinRequest& request, std::uint64_t participant);

  // The session has the vehicle's id, until Close.
  void Accept(VehicleId vehicle, const SessionId& session);
  void Close(VehicleId vehicle) { vehicles_.erase(vehicle); }
  // 0 where the vehicle is of none, or its owner is not known.
  std::uint64_t OwnerOf(VehicleId vehicle) const;
  // Its owner sent a command.
  void Heard(VehicleId vehicle, SteadyTime now);

  // Forgets sessions without a place whose writer `left`.
  void Forget(const std::function<bool(std::uint64_t writer)>& left);
  std::size_t Sessions() const { return sessions_.size(); }
  // The vehicles of a session; most often none or one.
  std::vector<VehicleId> VehiclesOf(const SessionId& session) const;

 private:
  struct Owner {
    std::uint64_t participant = 0;
    std::uint64_t writer = 0;  // of its requests
    SteadyTime heard{0};
    bool over = false;  // it left; it may say so again
  };
  void Count(const Owner& owner, int change);
  void Remove(const SessionId& session);
  void BoundSessions();
  bool HasPlace(const SessionId& session) const;

  std::map<SessionId, Owner> sessions_;
  std::deque<SessionId> oldest_;  // of sessions_
  std::unordered_map<std::uint64_t, std::size_t>
      counts_;  // of sessions_ that are not over, by participant
  std::unordered_map<VehicleId, SessionId> vehicles_;
};

}  // namespace giveway::link
