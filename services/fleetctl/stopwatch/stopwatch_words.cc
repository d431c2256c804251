#include "services/fleetctl/stopwatch/stopwatch_words.h"

#include <array>
#include <charconv>

namespace giveway::fleetctl {
namespace {

struct Phrase {
  std::string_view text;
  WordKind kind;
  bool about_a_peer = true;
};

constexpr std::array<Phrase, 10> kPhrases = {{
    {"beacon_heard: vehicle ", WordKind::kBeaconHeard},
    {"beacon_stale: vehicle ", WordKind::kBeaconStale},
    {"beacon_left: vehicle ", WordKind::kBeaconLeft},
    {"deadline_missed: vehicle ", WordKind::kDeadlineMissed},
    {"liveliness_lost: vehicle ", WordKind::kLivelinessLost},
    {"liveliness_back: vehicle ", WordKind::kLivelinessBack},
    {"matched: vehicle ", WordKind::kMatched},
    {"unmatched: vehicle ", WordKind::kUnmatched},
    {"drill: the control loop hangs", WordKind::kHangs, false},
    {"impairment: blackouts are counted from here", WordKind::kBlackoutsCount, false},
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

std::optional<Word> WordOf(std::string_view line) {
  const auto steady_ns = NumberAt<std::int64_t>(Behind(line, "\"steady_ns\":"));
  const std::string_view text = Behind(line, "\"text\":\"");
  if (!steady_ns) return std::nullopt;
  for (const Phrase& phrase : kPhrases) {
    if (!text.starts_with(phrase.text)) continue;
    Word word{SteadyTime{*steady_ns}, phrase.kind};
    if (!phrase.about_a_peer) return word;
    const auto number = NumberAt<std::uint32_t>(text.substr(phrase.text.size()));
    if (!number) return std::nullopt;
    word.about = VehicleId{*number};
    return word;
  }
  return std::nullopt;
}

std::optional<Mechanism> MechanismOf(WordKind kind) {
  switch (kind) {
    case WordKind::kBeaconStale:
      return Mechanism::kBeaconAge;
    case WordKind::kDeadlineMissed:
      return Mechanism::kDeadline;
    case WordKind::kLivelinessLost:
      return Mechanism::kLiveliness;
    case WordKind::kUnmatched:
      return Mechanism::kLease;
    case WordKind::kBeaconLeft:
      return Mechanism::kGoodBye;
    default:
      return std::nullopt;
  }
}

void PeersHeard::Fold(VehicleId hearer, const Word& word) {
  if (word.about == kNobody) return;
  View& view = views_[hearer][word.about];
  switch (word.kind) {
    case WordKind::kBeaconHeard:
      view.fresh = true;
      break;
    case WordKind::kBeaconStale:
    case WordKind::kBeaconLeft:
      view.fresh = false;
      break;
    case WordKind::kLivelinessLost:
      view.alive = false;
      break;
    case WordKind::kLivelinessBack:
      view.alive = true;
      break;
    case WordKind::kMatched:
      ++view.writers;
      break;
    case WordKind::kUnmatched:
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

std::optional<std::pair<VehicleId, VehicleId>> PeersHeard::FirstDeaf(
    std::span<const VehicleId> fleet) const {
  for (const VehicleId hearer : fleet) {
    for (const VehicleId about : fleet) {
      if (hearer != about && !Hears(hearer, about)) return std::pair(hearer, about);
    }
  }
  return std::nullopt;
}

}  // namespace giveway::fleetctl
