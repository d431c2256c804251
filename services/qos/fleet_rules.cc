// A writer or reader of a topic of the fleet: does it hold as many vehicles as there are, and do
// its deadline and lease fit the rate they guard?
#include <string>

#include "services/qos/qos_rules.h"

namespace giveway::qos {
namespace {

constexpr int kLongestDeadline = 4;  // periods; a beacon lost now and then is no silence
constexpr int kLongestLease = 20;

class FleetRules {
 public:
  FleetRules(const Profile& profile, const Topic& topic, const Deployment& deployment,
             Findings* findings)
      : profile_(profile),
        topic_(topic),
        deployment_(deployment),
        period_(Period(topic, deployment)),
        findings_(*findings) {}

  void CheckInstances();
  void CheckDeadline();
  void CheckLease();
  void CheckHistory();

 private:
  bool Reads() const { return profile_.owner == Owner::kReader; }
  void Add(Severity severity, const std::string& rule, Policy at, const std::string& against,
           std::string consequence, std::string remedy) {
    findings_.push_back({severity, rule, PlaceOf(profile_, at), profile_.name,
                         std::string(Info(at).name) + " " + StatedValue(profile_, at) + against,
                         std::move(consequence), std::move(remedy)});
  }
  std::string Every() const { return "; a sample comes every " + DurationText(period_); }

  const Profile& profile_;
  const Topic& topic_;
  const Deployment& deployment_;
  std::int64_t period_;  // ns; 0: no fixed rate
  Findings& findings_;
};

void FleetRules::CheckInstances() {
  const std::int64_t most = profile_.Number(Policy::kMaxInstances);
  const std::int64_t there = Instances(topic_, profile_.owner, deployment_);
  if (most > 0 && most < there) {
    Add(Severity::kError, "instance_limit", Policy::kMaxInstances,
        "; " + std::to_string(there) + " vehicles",
        "The samples of the further vehicles are refused.", "write 0 for unlimited");
  }
  const std::int64_t samples = profile_.Number(Policy::kMaxSamples);
  const std::int64_t wanted = there * profile_.Number(Policy::kDepth);
  if (samples > 0 && samples < wanted && profile_.Number(Policy::kHistory) == kKeepLast) {
    Add(Severity::kWarning, "sample_limit", Policy::kMaxSamples,
        "; " + std::to_string(there) + " vehicles with " + StatedValue(profile_, Policy::kDepth) +
            " samples each need " + std::to_string(wanted),
        "Once the history is full, new samples are refused until old ones are taken.",
        "write 0 for unlimited");
  }
}

void FleetRules::CheckDeadline() {
  const std::int64_t deadline = profile_.Number(Policy::kDeadline);
  if (deadline == kInfinite) {
    if (!topic_.guarded || !Reads()) return;
    Add(Severity::kWarning, "deadline_missing", Policy::kDeadline, Every(),
        "No process is informed when a peer falls silent; only the age of its last sample shows "
        "it.",
        "three periods: " + DurationText(3 * period_));
    return;
  }
  if (period_ == 0) {
    Add(Severity::kWarning, "deadline_without_rate", Policy::kDeadline,
        "; " + std::string(topic_.name) + " has no fixed rate",
        "It is missed whenever there is nothing to say.", "remove it");
  } else if (deadline <= period_) {
    Add(Severity::kError, "deadline_too_short", Policy::kDeadline, Every(),
        "Every sample that is not early is a miss.",
        "two periods offered, three requested: " + DurationText(2 * period_) + ", " +
            DurationText(3 * period_));
  } else if (deadline > kLongestDeadline * period_) {
    Add(Severity::kWarning, "deadline_too_long", Policy::kDeadline, Every(),
        "It speaks after the limit on the age of samples has decided already, and guards nothing.",
        "at most " + DurationText(kLongestDeadline * period_));
  }
}

void FleetRules::CheckLease() {
  const std::int64_t lease = profile_.Number(Policy::kLease);
  if (lease == kInfinite) {
    if (!topic_.lively || !Reads()) return;
    Add(Severity::kWarning, "lease_missing", Policy::kLease, Every(),
        "A peer that vanished is given up only when its participant lease ends.",
        "five periods: " + DurationText(5 * period_));
    return;
  }
  if (period_ == 0) {
    if (profile_.Number(Policy::kLiveliness) != kManualByTopic) return;
    Add(Severity::kWarning, "lease_without_rate", Policy::kLease,
        "; " + std::string(topic_.name) + " has no fixed rate",
        "The writer counts as dead whenever it has nothing to say.", "remove it");
  } else if (lease < 2 * period_) {
    Add(Severity::kError, "lease_too_short", Policy::kLease, Every(),
        "One late sample, and a living vehicle counts as gone.",
        "five periods: " + DurationText(5 * period_));
  } else if (lease < profile_.Number(Policy::kDeadline) &&
             profile_.Number(Policy::kDeadline) <= kLongestDeadline * period_) {
    Add(Severity::kWarning, "lease_below_deadline", Policy::kLease,
        ", below the deadline of " + StatedValue(profile_, Policy::kDeadline),
        "A silent peer counts as gone before its deadline is missed, and the deadline says "
        "nothing.",
        "longer than the deadline: " + DurationText(5 * period_));
  } else if (lease > kLongestLease * period_) {
    Add(Severity::kWarning, "lease_too_long", Policy::kLease, Every(),
        "A dead vehicle counts as alive for that long.",
        "five periods: " + DurationText(5 * period_));
  }
}

void FleetRules::CheckHistory() {
  if (Reads() && profile_.Number(Policy::kHistory) == kKeepLast &&
      profile_.Number(Policy::kDepth) < topic_.reader_depth) {
    Add(Severity::kWarning, "depth_overwrites", Policy::kDepth,
        "; drained once a tick, while samples come at any time",
        "A later sample overwrites one that was not taken yet, which looks like loss.",
        "keep the last 4");
  }
  if (!topic_.late_joiners) return;
  if (profile_.Number(Policy::kDurability) < kTransientLocal ||
      profile_.Number(Policy::kReliability) != kReliable) {
    Add(Severity::kError, "late_joiner_unserved", Policy::kDurability,
        ", reliability " + StatedValue(profile_, Policy::kReliability),
        "A late joiner never receives the sample, and waits for ever.",
        "RELIABLE and TRANSIENT_LOCAL, in the writer and in the reader");
  }
}

}  // namespace

void CheckFleet(const Profile& profile, const Topic& topic, const Deployment& deployment,
                Findings* findings) {
  FleetRules rules(profile, topic, deployment, findings);
  rules.CheckInstances();
  rules.CheckDeadline();
  rules.CheckLease();
  rules.CheckHistory();
}

}  // namespace giveway::qos
