// Properties of every expansion, whatever the rules.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <tuple>

#include "services/faults/exclusion.h"
#include "tests/unit/faults/fault_lists.h"

namespace giveway::faults {
namespace {

constexpr std::uint32_t kVehicles = 5;

Targets AnyTargets(const KindRow& row) {
  using What = Targets::What;
  std::vector<What> whats;
  if (row.Allows(Target::What::kVehicle)) {
    whats.insert(whats.end(), {What::kAnyVehicle, What::kEveryVehicle, What::kNamed});
  }
  if (row.Allows(Target::What::kWorld)) whats.push_back(What::kWorld);
  if (row.Allows(Target::What::kDiscoveryServer)) whats.push_back(What::kDiscoveryServer);
  if (row.Allows(Target::What::kAll)) whats.push_back(What::kAll);
  Targets targets{*rc::gen::elementOf(whats), {}};
  if (targets.what == What::kNamed) {
    targets.named = {VehicleId{1}, VehicleId{*rc::gen::inRange(2U, kVehicles + 1)}};
  }
  return targets;
}

RandomRule AnyRule(std::size_t number) {
  const KindRow& row = KindTable()[*rc::gen::inRange(std::size_t{0}, kKinds)];
  RandomRule rule = Randomly("rule_" + std::to_string(number), row.kind,
                             *rc::gen::inRange(20, 2000) / 10.0, 0, 0, AnyTargets(row));
  if (row.takes_time) {
    rule.for_low_s = *rc::gen::inRange(1, 1000) / 100.0;
    rule.for_high_s = rule.for_low_s + *rc::gen::inRange(0, 1000) / 100.0;
  }
  if (*rc::gen::arbitrary<bool>()) rule.at_most = *rc::gen::inRange(1U, 20U);
  return rule;
}

FaultFile AnyFile() {
  FaultFile file;
  const auto rules = *rc::gen::inRange(std::size_t{1}, std::size_t{8});
  for (std::size_t i = 0; i < rules; ++i) file.random.push_back(AnyRule(i));
  return file;
}

Course AnyCourse() {
  return {.seed = *rc::gen::arbitrary<std::uint32_t>(),
          .duration_s = *rc::gen::inRange(1, 1000) * 1.0,
          .warm_up_s = *rc::gen::inRange(0, 20) * 1.0,
          .healing_s = *rc::gen::inRange(0, 20) * 1.0};
}

// No generated fault may be refused.
Schedule AllOf(const FaultFile& file, const Course& course) {
  const Expansion expansion = Expand(file, course, Fleet(kVehicles));
  RC_ASSERT(expansion.refused.empty());
  return expansion.schedule;
}

bool StartsBefore(const Fault& a, const Fault& b) {
  return std::tie(a.at_s, a.rule, a.nth) < std::tie(b.at_s, b.rule, b.nth);
}

TEST(ExpandProperty, TheSameSeedGivesTheSameList) {
  EXPECT_TRUE(rc::check("same", [] {
    const FaultFile file = AnyFile();
    const Course course = AnyCourse();
    RC_ASSERT(AllOf(file, course) == AllOf(file, course));
  }));
}

TEST(ExpandProperty, ListsAreSortedInTimeAndWithoutFaultsThatExcludeEachOther) {
  EXPECT_TRUE(rc::check("sound", [] {
    const FaultFile file = AnyFile();
    const Course course = AnyCourse();
    const Schedule schedule = AllOf(file, course);
    RC_ASSERT(std::is_sorted(schedule.begin(), schedule.end(), StartsBefore));
    for (std::size_t j = 0; j < schedule.size(); ++j) {
      RC_ASSERT(schedule[j].at_s >= course.warm_up_s);
      RC_ASSERT(schedule[j].EndsAt_s() <= course.duration_s - course.healing_s);
      RC_ASSERT((schedule[j].for_s > 0) == RowOf(schedule[j].kind).takes_time);
      RC_ASSERT(RowOf(schedule[j].kind).Allows(schedule[j].target.what));
    }
    ForEachExcluding(schedule, [](std::size_t, std::size_t) { RC_FAIL("two exclude each other"); });
  }));
}

// No fault of another rule is moved or removed; one that was dropped because of a conflict may come
// back.
TEST(ExpandProperty, TakingOneRuleOutLeavesTheFaultsOfAllOthers) {
  EXPECT_TRUE(rc::check("others stay", [] {
    FaultFile file = AnyFile();
    const Course course = AnyCourse();
    const Expansion with = Expand(file, course, Fleet(kVehicles));
    const std::size_t out = *rc::gen::inRange(std::size_t{0}, file.random.size());
    const std::string name = file.random[out].name;
    file.random.erase(file.random.begin() + static_cast<std::ptrdiff_t>(out));
    const Schedule without = AllOf(file, course);
    Schedule others = with.schedule;
    std::erase_if(others, [&](const Fault& fault) { return fault.rule == name; });
    for (const Fault& fault : others) {
      RC_ASSERT(std::find(without.begin(), without.end(), fault) != without.end());
    }
    const bool nobody_made_way =
        std::all_of(with.left_out.begin(), with.left_out.end(),
                    [](const LeftOut& left) { return left.excluded == 0; });
    if (nobody_made_way) RC_ASSERT(without == others);
  }));
}

TEST(ExpandProperty, TheListExpandsToItself) {
  EXPECT_TRUE(rc::check("itself", [] {
    const FaultFile file = AnyFile();
    Course course = AnyCourse();
    const Schedule schedule = AllOf(file, course);
    course.seed += 1;
    const Expansion again = Expand(AsFile(schedule), course, Fleet(kVehicles));
    RC_ASSERT(again.refused.empty());
    RC_ASSERT(again.schedule == schedule);
    RC_ASSERT(again.left_out.empty());
  }));
}

}  // namespace
}  // namespace giveway::faults
