#include "services/qos/rollout.h"

#include <algorithm>

#include "services/qos/deployment.h"
#include "services/qos/profile_edit.h"
#include "services/qos/qos_rules.h"
#include "services/qos/request_offered.h"

namespace giveway::qos {
namespace {

// Only the writers, or only the readers, that a process of the role makes.
ProfileSet Own(const ProfileSet& set, Role role, Owner owner) {
  ProfileSet own = set;
  std::erase_if(own.profiles, [&](const Profile& profile) {
    return profile.owner != owner || !Concerns(role, profile.name);
  });
  return own;
}

// Two processes find each other only by the same protocol at the same ports.
void CheckDiscovery(const ProfileSet& a, const ProfileSet& b, Findings* findings) {
  const Profile* const one = a.Find(Owner::kParticipant, kParticipantProfile);
  const Profile* const other = b.Find(Owner::kParticipant, kParticipantProfile);
  if (one == nullptr || other == nullptr) return;
  for (const Policy policy : {Policy::kDiscoveryProtocol, Policy::kPortBase, Policy::kDomainGain,
                              Policy::kParticipantGain, Policy::kOffset0, Policy::kOffset1,
                              Policy::kOffset2, Policy::kOffset3}) {
    if (one->Number(policy) == other->Number(policy)) continue;
    findings->push_back({Severity::kError, "discovery_mismatch", PlaceOf(*one, policy), one->name,
                         std::string(Info(policy).name) + " " + StatedValue(*one, policy) +
                             ", and " + StatedValue(*other, policy),
                         "The two no longer find each other, nor does an operator find both.",
                         "start the processes again with the new set, all at once"});
  }
}

// What does not match between two processes with these sets, either way.
Findings Mismatches(Role a, const ProfileSet& set_a, Role b, const ProfileSet& set_b) {
  Findings findings;
  CheckDiscovery(set_a, set_b, &findings);
  CheckPairs(Own(set_a, a, Owner::kWriter), Own(set_b, b, Owner::kReader), &findings);
  CheckPairs(Own(set_b, b, Owner::kWriter), Own(set_a, a, Owner::kReader), &findings);
  std::erase_if(findings,
                [](const Finding& finding) { return finding.severity != Severity::kError; });
  return findings;
}

ProfileSet SetOf(const std::string& text, const std::string& name) {
  const XmlRead read = ReadXml(text, name);
  return read.root ? ReadProfiles(*read.root, name) : ProfileSet{};
}

// The more of both for a writer, the less for a reader.
std::int64_t Between(const MatchRule& rule, Owner owner, std::int64_t a, std::int64_t b) {
  const bool larger = (rule.relation == Relation::kAtLeast) == (owner == Owner::kWriter);
  return larger ? std::max(a, b) : std::min(a, b);
}

std::string BetweenText(const std::vector<RolloutProcess>& processes, const ProfileSet& wanted,
                        const std::string& text) {
  std::vector<ProfileEdit> edits;
  for (const Profile& profile : wanted.profiles) {
    if (profile.owner == Owner::kParticipant || TopicOfProfile(profile.name) == nullptr) continue;
    for (const MatchRule& rule : MatchRules()) {
      if (!rule.enforced || rule.relation == Relation::kEqual) continue;
      std::int64_t value = profile.Number(rule.policy);
      for (const RolloutProcess& process : processes) {
        const Profile* const old = process.set.Find(profile.owner, profile.name);
        if (process.role == Role::kOperator || old == nullptr) continue;
        value = Between(rule, profile.owner, value, old->Number(rule.policy));
      }
      if (value == profile.Number(rule.policy)) continue;
      edits.push_back({profile.owner, profile.name, rule.policy, value});
    }
  }
  return Edit(text, wanted.file, edits).bytes;
}

class Planner {
 public:
  Planner(const std::vector<RolloutProcess>& processes, const ProfileSet& wanted,
          const ProfileSet& between, std::optional<std::size_t> first)
      : processes_(processes), wanted_(wanted), between_(between), first_(first) {
    for (const RolloutProcess& process : processes) {
      now_.push_back(&process.set);
      done_.push_back(!process.moves);
    }
  }

  // False where no step is left that keeps all matched.
  bool Plan() {
    while (std::ranges::find(done_, false) != done_.end()) {
      if (!StepToWanted() && !StepBetween()) return false;
    }
    return true;
  }
  const std::vector<RolloutStep>& Steps() const { return steps_; }
  // Why the first process that is not done cannot take the wanted set.
  Findings WhyNot() const {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      if (!done_[i]) return MismatchesOf(i, wanted_);
    }
    return {};
  }

 private:
  // With all others as they are now. What does not match now already is none of ours.
  Findings MismatchesOf(std::size_t process, const ProfileSet& set) const {
    const Role role = processes_[process].role;
    Findings all;
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      if (i == process) continue;
      const Role other = processes_[i].role;
      if (!Mismatches(role, *now_[process], other, *now_[i]).empty()) continue;
      for (Finding& finding : Mismatches(role, set, other, *now_[i])) {
        finding.subject += " (" + processes_[process].name + " and " + processes_[i].name + ")";
        all.push_back(std::move(finding));
      }
    }
    return all;
  }
  bool StepToWanted() {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      const bool waits =
          first_ && !done_[*first_] && i != *first_ && processes_[i].role == Role::kVehicle;
      if (done_[i] || waits || !MismatchesOf(i, wanted_).empty()) continue;
      now_[i] = &wanted_;
      done_[i] = true;
      steps_.push_back({i, false});
      return true;
    }
    return false;
  }
  bool StepBetween() {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      if (done_[i] || now_[i] == &between_ || !MismatchesOf(i, between_).empty()) continue;
      now_[i] = &between_;
      steps_.push_back({i, true});
      return true;
    }
    return false;
  }

  const std::vector<RolloutProcess>& processes_;
  const ProfileSet& wanted_;
  const ProfileSet& between_;
  const std::optional<std::size_t> first_;
  std::vector<const ProfileSet*> now_;
  std::vector<bool> done_;
  std::vector<RolloutStep> steps_;
};

}  // namespace

Rollout PlanRollout(const std::vector<RolloutProcess>& processes, const std::string& wanted,
                    const std::string& wanted_name, std::optional<std::size_t> first) {
  const ProfileSet set = SetOf(wanted, wanted_name);
  Rollout rollout;
  rollout.between = BetweenText(processes, set, wanted);
  const ProfileSet between = SetOf(rollout.between, wanted_name);
  Planner planner(processes, set, between, first);
  if (!planner.Plan()) {
    rollout.blocked = planner.WhyNot();
    return rollout;
  }
  rollout.steps = planner.Steps();
  if (std::ranges::none_of(rollout.steps, &RolloutStep::between)) rollout.between.clear();
  return rollout;
}

}  // namespace giveway::qos
