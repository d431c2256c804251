#include "services/fleetctl/tune/tune_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>

#include "services/types/math/random.h"

namespace giveway::fleetctl {
namespace {

constexpr char kWriter[] = "fleet_beacon_writer";
constexpr char kReader[] = "fleet_beacon_reader";

// Requested deadlines in periods, the most significant first. Losses cause silences of whole
// periods, so all limits between two multiples are equivalent; the exact value matters only if
// beacons are late.
constexpr std::array<double, 9> kDeadlines = {3.8, 3.3, 2.6, 4.6, 3.5, 5.6, 2.3, 4.3, 1.6};
constexpr std::size_t kQuickDeadlines = 4;
// With retransmissions a limit just below a whole number of periods costs less: the loop cycle
// before acts.
constexpr double kEarlyDeadline = 2.8;
constexpr double kLongLease = 8;   // periods
constexpr double kShortLease = 4;  // periods

Nanoseconds Periods(double count, Nanoseconds tick) {
  const double ms = Milliseconds(tick) * count;
  return Nanoseconds{static_cast<std::int64_t>(ms + 0.5) *
                     1'000'000};  // the resolution of the library's timers
}

// Offered must not exceed requested, or they do not match.
BeaconQos WithDeadline(BeaconQos qos, Nanoseconds requested) {
  qos.requested = requested;
  qos.offered = std::min(qos.offered, requested);
  return qos;
}

BeaconQos WithLease(BeaconQos qos, Nanoseconds lease) {
  qos.lease = lease;
  return qos;
}

BeaconQos WithReliable(BeaconQos qos, bool reliable) {
  qos.reliable = reliable;
  return qos;
}

BeaconQos WithDepth(BeaconQos qos, std::int64_t depth) {
  qos.depth = depth;
  return qos;
}

std::string NameOf(const BeaconQos& qos, const BeaconQos& base) {
  std::string name = fmt::format("d{:.0f}_l{:.0f}_{}_h{}", Milliseconds(qos.requested),
                                 Milliseconds(qos.lease), qos.reliable ? "re" : "be", qos.depth);
  if (qos.offered != base.offered) name += fmt::format("_o{:.0f}", Milliseconds(qos.offered));
  return name;
}

class Candidates {
 public:
  explicit Candidates(const BeaconQos& base) : base_(base) { all_.push_back({"base", base}); }

  void Add(const BeaconQos& qos) {
    if (std::ranges::find(all_, qos, &TuneCandidate::qos) != all_.end()) return;
    all_.push_back({NameOf(qos, base_), qos});
  }
  std::vector<TuneCandidate> Take(std::size_t most) {
    if (all_.size() > most) all_.resize(std::max<std::size_t>(1, most));
    return std::move(all_);
  }

 private:
  BeaconQos base_;
  std::vector<TuneCandidate> all_;
};

std::int64_t Count(Nanoseconds duration) { return duration.count(); }

bool IsFinite(const qos::Profile& profile, qos::Policy policy) {
  return profile.Number(policy) != qos::kInfinite;
}

}  // namespace

std::string WhyNotTunable(const qos::ProfileSet& base) {
  const qos::Profile* writer = base.Find(qos::Owner::kWriter, kWriter);
  const qos::Profile* reader = base.Find(qos::Owner::kReader, kReader);
  if (writer == nullptr || reader == nullptr) {
    return fmt::format("has no profiles {} and {}", kWriter, kReader);
  }
  for (const qos::Policy policy : {qos::Policy::kDeadline, qos::Policy::kLease}) {
    if (IsFinite(*writer, policy) && IsFinite(*reader, policy)) continue;
    return fmt::format("gives fleet/beacon no {}: there is nothing to tune from",
                       qos::Info(policy).name);
  }
  return {};
}

BeaconQos BeaconQosOf(const qos::ProfileSet& base) {
  const qos::Profile& writer = *base.Find(qos::Owner::kWriter, kWriter);
  const qos::Profile& reader = *base.Find(qos::Owner::kReader, kReader);
  return {.offered = Nanoseconds{writer.Number(qos::Policy::kDeadline)},
          .requested = Nanoseconds{reader.Number(qos::Policy::kDeadline)},
          .lease = Nanoseconds{reader.Number(qos::Policy::kLease)},
          .reliable = reader.Number(qos::Policy::kReliability) == qos::kReliable,
          .depth = reader.Number(qos::Policy::kDepth)};
}

std::vector<TuneCandidate> MakeCandidates(const BeaconQos& base, const TunePlanOptions& options) {
  Candidates candidates(base);
  const auto periods = [&](double count) { return Periods(count, options.tick); };
  const std::size_t deadlines = options.quick ? kQuickDeadlines : kDeadlines.size();
  for (std::size_t i = 0; i < deadlines; ++i) {
    candidates.Add(WithDeadline(base, periods(kDeadlines[i])));
  }
  const BeaconQos patient = WithDeadline(base, periods(kDeadlines[0]));
  candidates.Add(WithLease(patient, periods(kLongLease)));
  candidates.Add(WithReliable(patient, !base.reliable));
  candidates.Add(WithReliable(base, !base.reliable));
  candidates.Add(WithReliable(WithDeadline(base, periods(kEarlyDeadline)), !base.reliable));
  candidates.Add(WithDepth(patient, base.depth * 2));
  if (options.quick) return candidates.Take(options.most);
  candidates.Add(WithLease(base, periods(kShortLease)));
  candidates.Add(WithDepth(patient, 1));
  BeaconQos offered = patient;
  offered.offered = patient.requested;
  candidates.Add(offered);
  for (std::size_t i = 1; i < deadlines; ++i) {
    const BeaconQos qos = WithDeadline(base, periods(kDeadlines[i]));
    candidates.Add(WithLease(qos, periods(kLongLease)));
    candidates.Add(WithReliable(qos, !base.reliable));
  }
  return candidates.Take(options.most);
}

std::vector<qos::ProfileEdit> EditsOf(const BeaconQos& wanted, const BeaconQos& base) {
  std::vector<qos::ProfileEdit> edits;
  const auto writer = [&](qos::Policy policy, std::int64_t value) {
    edits.push_back({qos::Owner::kWriter, kWriter, policy, value});
  };
  const auto reader = [&](qos::Policy policy, std::int64_t value) {
    edits.push_back({qos::Owner::kReader, kReader, policy, value});
  };
  if (wanted.offered != base.offered) writer(qos::Policy::kDeadline, Count(wanted.offered));
  if (wanted.requested != base.requested) reader(qos::Policy::kDeadline, Count(wanted.requested));
  if (wanted.lease != base.lease) {
    writer(qos::Policy::kLease, Count(wanted.lease));
    reader(qos::Policy::kLease, Count(wanted.lease));
  }
  if (wanted.reliable != base.reliable) {
    const std::int64_t kind = wanted.reliable ? qos::kReliable : qos::kBestEffort;
    writer(qos::Policy::kReliability, kind);
    reader(qos::Policy::kReliability, kind);
  }
  if (wanted.depth != base.depth) reader(qos::Policy::kDepth, wanted.depth);
  return edits;
}

std::vector<Rung> MakeRungs(std::size_t candidates, bool quick) {
  std::vector<Rung> rungs{{candidates, 1}};
  const std::size_t most = quick ? 2 : 4;
  while (rungs.size() < most && rungs.back().candidates > 2) {
    rungs.push_back({(rungs.back().candidates + 1) / 2, rungs.back().trials * 2});
  }
  return rungs;
}

std::uint32_t TrialSeed(std::uint32_t seed, bool verification, std::uint32_t trial) {
  const std::uint64_t stream = (verification ? 1ULL << 32U : 0) | trial;
  const auto drawn = static_cast<std::uint32_t>(Random(seed, stream).Next() >> 32U);
  return drawn == 0 ? 1 : drawn;
}

}  // namespace giveway::fleetctl
