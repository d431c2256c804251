#include "services/fleetctl/stopwatch/stopwatch_log_events.h"

#include <array>
#include <charconv>

namespace giveway::fleetctl {
namespace {

struct Phrase {
  std::string_view text;
  LogEventKind kind;
  bool about_a_peer = true;
};

constexpr std::array<Phrase, 10> kPhrases = {{
    {"beacon_heard: vehicle ", LogEventKind::kBeaconHeard},
    {"beacon_stale: vehicle ", LogEventKind::kBeaconStale},
    {"beacon_left: vehicle ", LogEventKind::kBeaconLeft},
    {"deadline_missed: vehicle ", LogEventKind::kDeadlineMissed},
    {"liveliness_lost: vehicle ", LogEventKind::kLivelinessLost},
    {"liveliness_back: vehicle ", LogEventKind::kLivelinessBack},
    {"matched: vehicle ", LogEventKind::kMatched},
    {"unmatched: vehicle ", LogEventKind::kUnmatched},
    {"drill: the control loop hangs", LogEventKind::kHangs, false},
    {"impairment: blackouts are counted from here", LogEventKind::kBlackoutsCount, false},
}};

// The text after `name`, as the log writes it; empty if it is not in the line.
std::string_view Behind(std::string_view line, std::string_view name) {
  const std::size_t at = line.find(name);
  return at == std::string_view::npos ? std::string_view() : line.substr(at + name.size());
}

template <typename Number>
std::optional<Number> NumberAt(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end == text.data()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<LogEvent> LogEventOf(std::string_view line) {
  const auto steady_ns = NumberAt<std::int64_t>(Behind(line, "\"steady_ns\":"));
  const std::string_view text = Behind(line, "\"text\":\"");
  if (!steady_ns) return std::nullopt;
  for (const Phrase& phrase : kPhrases) {
    if (!text.starts_with(phrase.text)) continue;
    LogEvent event{SteadyTime{*steady_ns}, phrase.kind};
    if (!phrase.about_a_peer) return event;
    const auto number = NumberAt<std::uint32_t>(text.substr(phrase.text.size()));
    if (!number) return std::nullopt;
    event.about = VehicleId{*number};
    return event;
  }
  return std::nullopt;
}

std::optional<Mechanism> MechanismOf(LogEventKind kind) {
  switch (kind) {
    case LogEventKind::kBeaconStale:
      return Mechanism::kBeaconAge;
    case LogEventKind::kDeadlineMissed:
      return Mechanism::kDeadline;
    case LogEventKind::kLivelinessLost:
      return Mechanism::kLiveliness;
    case LogEventKind::kUnmatched:
      return Mechanism::kLease;
    case LogEventKind::kBeaconLeft:
      return Mechanism::kLeaveNotice;
    default:
      return std::nullopt;
  }
}

void PeersHeard::Fold(VehicleId hearer, const LogEvent& event) {
  if (event.about == kNoVehicle) return;
  View& view = views_[hearer][event.about];
  switch (event.kind) {
    case LogEventKind::kBeaconHeard:
      view.fresh = true;
      break;
    case LogEventKind::kBeaconStale:
    case LogEventKind::kBeaconLeft:
      view.fresh = false;
      break;
    case LogEventKind::kLivelinessLost:
      view.alive = false;
      break;
    case LogEventKind::kLivelinessBack:
      view.alive = true;
      break;
    case LogEventKind::kMatched:
      ++view.writers;
      break;
    case LogEventKind::kUnmatched:
      // Nothing more is reported of a writer that is gone: the next one starts alive.
      view.alive = true;
      if (view.writers > 0) --view.writers;
      break;
    default:
      break;
  }
}

void PeersHeard::Restart(VehicleId hearer) { views_.erase(hearer); }

bool PeersHeard::Hears(VehicleId hearer, VehicleId about) const {
  const auto views = views_.find(hearer);
  if (views == views_.end()) return false;
  const auto view = views->second.find(about);
  return view != views->second.end() && view->second.writers == 1 && view->second.fresh &&
         view->second.alive;
}

std::optional<std::pair<VehicleId, VehicleId>> PeersHeard::FirstUnheard(
    std::span<const VehicleId> fleet) const {
  for (const VehicleId hearer : fleet) {
    for (const VehicleId about : fleet) {
      if (hearer != about && !Hears(hearer, about)) return std::pair(hearer, about);
    }
  }
  return std::nullopt;
}

}  // namespace giveway::fleetctl
