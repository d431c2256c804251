#include "services/qos/rollout.h"

#include <algorithm>
#include <map>
#include <tuple>

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

// What does not match between two processes with these sets, either way.
Findings Mismatches(Role a, const ProfileSet& set_a, Role b, const ProfileSet& set_b) {
  Findings findings;
  CheckFindEachOther(set_a, set_b, &findings);
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

// What does not match, of the few different sets that a fleet has: each pair is held against each
// other once, however many processes have the two.
class MatchTable {
 public:
  // The number of a set, which must outlive this; equal ones have one.
  std::size_t NumberOf(const ProfileSet& set) {
    const auto known = std::ranges::find_if(sets_, [&](const auto* one) { return *one == set; });
    if (known != sets_.end()) return static_cast<std::size_t>(known - sets_.begin());
    sets_.push_back(&set);
    return sets_.size() - 1;
  }
  const Findings& Of(Role a, std::size_t set_a, Role b, std::size_t set_b) {
    const auto [found, is_new] = found_.try_emplace({a, set_a, b, set_b});
    if (is_new) found->second = Mismatches(a, *sets_[set_a], b, *sets_[set_b]);
    return found->second;
  }

 private:
  std::vector<const ProfileSet*> sets_;
  std::map<std::tuple<Role, std::size_t, Role, std::size_t>, Findings> found_;
};

class Planner {
 public:
  Planner(const std::vector<RolloutProcess>& processes, const ProfileSet& wanted,
          const ProfileSet& between, std::optional<std::size_t> first)
      : processes_(processes),
        wanted_(table_.NumberOf(wanted)),
        between_(table_.NumberOf(between)),
        first_(first) {
    for (const RolloutProcess& process : processes) {
      now_.push_back(table_.NumberOf(process.set));
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
  Findings WhyNot() {
    Findings all;
    const auto blocked = std::ranges::find(done_, false);
    if (blocked == done_.end()) return all;
    const auto process = static_cast<std::size_t>(blocked - done_.begin());
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      for (Finding finding : MismatchesOf(process, i, wanted_)) {
        finding.subject += " (" + processes_[process].name + " and " + processes_[i].name + ")";
        all.push_back(std::move(finding));
      }
    }
    return all;
  }

 private:
  // What would not match between the two. What does not match now already is none of ours.
  const Findings& MismatchesOf(std::size_t process, std::size_t other, std::size_t set) {
    static const Findings kNone;
    const Role role = processes_[process].role;
    const Role role_of_other = processes_[other].role;
    if (process == other || !table_.Of(role, now_[process], role_of_other, now_[other]).empty()) {
      return kNone;
    }
    return table_.Of(role, set, role_of_other, now_[other]);
  }
  // With all others as they are now.
  bool MayTake(std::size_t process, std::size_t set) {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      if (!MismatchesOf(process, i, set).empty()) return false;
    }
    return true;
  }
  bool StepToWanted() {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      const bool waits =
          first_ && !done_[*first_] && i != *first_ && processes_[i].role == Role::kVehicle;
      if (done_[i] || waits || !MayTake(i, wanted_)) continue;
      now_[i] = wanted_;
      done_[i] = true;
      steps_.push_back({i, false});
      return true;
    }
    return false;
  }
  bool StepBetween() {
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      if (done_[i] || now_[i] == between_ || !MayTake(i, between_)) continue;
      now_[i] = between_;
      steps_.push_back({i, true});
      return true;
    }
    return false;
  }

  MatchTable table_;
  const std::vector<RolloutProcess>& processes_;
  const std::size_t wanted_;  // its number in the table, as of the next two
  const std::size_t between_;
  const std::optional<std::size_t> first_;
  std::vector<std::size_t> now_;
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
