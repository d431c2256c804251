// Which participant each session is of, and each vehicle's id with it: the one that asked first.
// The session goes to another only when its own has left or has been silent: it was restarted. A
// participant that knows the secret a session is made of may end it from anywhere. Bounded: the
// oldest sessions that have no place go first. Each call takes logarithmic time but Forget, which
// looks at every session without a place. Knows no DDS, has no clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "services/link/inbox/silence_limit.h"
#include "services/types/fleet_facts.h"
#include "services/types/time.h"

namespace giveway::link {

class SessionOwners {
 public:
  static constexpr std::size_t kMostSessions = 4096;
  static constexpr std::size_t kMostOfOne = 8;  // a process has one, or a test a few
  // A vehicle in the world sends a command a tick, once it has started; one that waits for a place,
  // or has just got one, asks again every second. The first is never less than a few ticks.
  static constexpr Nanoseconds kSilence = std::chrono::milliseconds(750);
  static constexpr Nanoseconds kSilenceBeforeCommands = std::chrono::seconds(3);

  explicit SessionOwners(Nanoseconds tick_period = Nanoseconds{0})
      : silence_(SilenceLimit(kSilence, tick_period)) {}

  enum class Verdict : std::uint8_t { kYes, kTooMany, kOfAnother };

  // Whether a participant may ask for a place, or leave, by this request. `left`: whether the
  // writer of this identity has. One that may is the session's owner from now on.
  Verdict MayAsk(const JoinRequest& request, std::uint64_t participant, std::uint64_t writer,
                 SteadyTime now, const std::function<bool(std::uint64_t writer)>& left);
  Verdict MayLeave(const JoinRequest& request, std::uint64_t participant);

  // The session has the vehicle's id, until Close.
  void Accept(VehicleId vehicle, const SessionId& session);
  void Close(VehicleId vehicle);
  // 0 where the vehicle is of none, or its owner is not known.
  std::uint64_t OwnerOf(VehicleId vehicle) const;
  // Its owner sent a command.
  void Heard(VehicleId vehicle, SteadyTime now);

  // Forgets sessions without a place whose writer `left`.
  void Forget(const std::function<bool(std::uint64_t writer)>& left);
  std::size_t Sessions() const { return sessions_.size(); }
  // The vehicles of a session; most often none or one. Valid until the next Accept or Close.
  const std::vector<VehicleId>& VehiclesOf(const SessionId& session) const;

 private:
  struct Owner {
    std::uint64_t participant = 0;
    std::uint64_t writer = 0;  // of its requests
    SteadyTime heard{0};
    bool commands = false;  // it sent a command since it asked
    bool over = false;      // it left; it may say so again
    std::uint64_t age = 0;  // 1, 2, 3 ... in the order in which sessions became known
  };
  using Known = std::map<SessionId, Owner>;

  void Count(const Owner& owner, int change);
  void Remove(Known::iterator known);
  void BoundSessions();
  bool HasPlace(const SessionId& session) const { return places_.contains(session); }
  // To be called before and after a session gets its first place, or loses its last.
  void Unlist(const SessionId& session);
  void List(const SessionId& session);

  const Nanoseconds silence_;
  Known sessions_;
  // Of sessions_, in the order in which they are to go: those without a place, then the others; the
  // oldest of each first.
  std::map<std::pair<bool, std::uint64_t>, SessionId> to_go_;
  std::unordered_map<std::uint64_t, std::size_t>
      counts_;  // of sessions_ that are not over, by participant
  std::unordered_map<VehicleId, SessionId> vehicles_;
  std::map<SessionId, std::vector<VehicleId>> places_;  // those of vehicles_, none is empty
  std::uint64_t last_age_ = 0;
};

}  // namespace giveway::link
