#include "services/health/health.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/runtime/json.h"

namespace giveway {
namespace {

std::string OldRanges(const VehicleHealth& vehicle, SteadyTime now) {
  if (vehicle.scanned == SteadyTime{0}) return "no ranges have come from the world yet";
  const Nanoseconds age = now - vehicle.scanned;
  if (age <= vehicle.ranges_age_limit) return {};
  return fmt::format("the ranges are {:.2f} s old, the limit is {:.2f} s: is the world alive?",
                     Seconds(age), Seconds(vehicle.ranges_age_limit));
}

// Before the run starts it waits for the whole fleet; later a missing peer is the fleet's problem,
// which a restart of this vehicle could not solve.
std::string TooFewPeers(const VehicleHealth& vehicle) {
  const std::uint32_t peers = std::max(vehicle.fleet_size, 1U) - 1;
  if (vehicle.run_state != RunState::kWaiting || vehicle.matched_peers >= peers) return {};
  return fmt::format("matched with {} of {} peers", vehicle.matched_peers, peers);
}

// Not in the world, whatever else; empty where it is.
std::string NotThere(const VehicleHealth& vehicle) {
  switch (vehicle.loop.stage) {
    case HealthStage::kStarting:
      if (vehicle.waits_for.View().empty()) return "starting: it has no participant yet";
      return fmt::format("starting: {}", vehicle.waits_for.View());
    case HealthStage::kJoining:
      if (vehicle.waits_for.View().empty()) {
        return "not joined: no answer from a world yet; is giveway-world running in this domain?";
      }
      return fmt::format("not joined: {}", vehicle.waits_for.View());
    case HealthStage::kLeaving:
      return "leaving: it was asked to stop, or to restart";
    case HealthStage::kUnderWay:
      break;
  }
  return {};
}

}  // namespace

ShortText::ShortText(std::string_view text)
    : length_(static_cast<std::uint8_t>(std::min(text.size(), bytes_.size()))) {
  std::copy_n(text.begin(), length_, bytes_.begin());
}

Reasons NotLive(const LoopHealth& loop, SteadyTime now) {
  const Nanoseconds limit = loop.stage == HealthStage::kStarting ? kStartLimit : kLoopSilenceLimit;
  const Nanoseconds silence = now - loop.turned;
  if (silence <= limit) return {};
  return {fmt::format("the control loop has been silent for {:.1f} s, the limit is {:.0f} s",
                      Seconds(silence), Seconds(limit))};
}

Reasons NotReady(const VehicleHealth& vehicle, SteadyTime now) {
  Reasons reasons = NotLive(vehicle.loop, now);
  const auto add = [&reasons](std::string reason) {
    if (!reason.empty()) reasons.push_back(std::move(reason));
  };
  add(NotThere(vehicle));
  if (vehicle.loop.stage != HealthStage::kUnderWay) return reasons;
  add(TooFewPeers(vehicle));
  add(OldRanges(vehicle, now));
  return reasons;
}

// A world that waits is ready: vehicles may join, and nothing needs to wait for it any longer.
Reasons NotReady(const WorldHealth& world, SteadyTime now) {
  Reasons reasons = NotLive(world.loop, now);
  if (!world.waits_for.View().empty()) {
    reasons.emplace_back(world.waits_for.View());
  } else if (world.loop.stage == HealthStage::kStarting) {
    reasons.emplace_back("starting: it has no participant yet");
  } else if (world.loop.stage == HealthStage::kLeaving || world.run_state == RunState::kEnded) {
    reasons.emplace_back("the run has ended");
  }
  return reasons;
}

std::string AsText(std::string_view what, const Reasons& reasons) {
  if (reasons.empty()) return fmt::format("{}\n", what);
  std::string text;
  for (const std::string& reason : reasons) text += fmt::format("not {}: {}\n", what, reason);
  return text;
}

std::string AsJson(std::string_view what, const Reasons& reasons) {
  Json json;
  json[std::string(what)] = reasons.empty();
  json["reasons"] = reasons;
  return JsonText(std::move(json)) + "\n";
}

}  // namespace giveway
