// Fault files: what the shipped ones contain, what is refused and how, and that a printed list
// reads back as the same list.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <set>

#include "services/config/faults/faults_file.h"
#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using faults::Kind;
using faults::Target;
using faults::Targets;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr faults::Course kHalfHour{.seed = 1, .duration_s = 1800};
constexpr faults::Course kMonth{
    .seed = 1, .duration_s = 30 * 86400.0, .warm_up_s = 0, .healing_s = 0};

std::vector<VehicleId> FleetOf(std::uint32_t vehicles) {
  std::vector<VehicleId> ids;
  for (std::uint32_t id = 1; id <= vehicles; ++id) ids.push_back(VehicleId{id});
  return ids;
}

faults::FaultFile LoadText(const std::string& text) {
  const TempFolder folder;
  return LoadFaults(folder.Write("f.textproto", text));
}

std::vector<Problem> ProblemsIn(const std::string& text, const faults::Course& course = kMonth) {
  const TempFolder folder;
  try {
    LoadAndExpandFaults(folder.Write("f.textproto", text), course, FleetOf(4));
  } catch (const InputError& error) {
    return error.Problems();
  }
  return {};
}

// Problems of a single rule, written in the second line.
void ExpectRefused(const std::string& rule, const char* field, const char* message) {
  EXPECT_THAT(ProblemsIn("description: \"d\"\n" + rule), ElementsAre(Is(2, field, message)))
      << rule;
}

TEST(FaultsFile, SaysEverythingThereIs) {
  const faults::FaultFile file = LoadText(R"(description: "a day"
at { name: "a" nth: 3 time_s: 10 kind: "loss" vehicle: 2 for_s: 5 probability: 0.4 }
at { name: "b" time_s: 20 kind: "pause" target: "world" for_s: 1.5 }
at { name: "c" time_s: 30 kind: "one_way_cut" vehicle: 1 for_s: 2 from: 2 }
random { name: "d" kind: "qos_apply" mean_between_s: 60 for_s: [2, 8] target: "all" at_most: 3 qos: "q" }
random { name: "e" kind: "kill" mean_between_s: 90 vehicle: [3, 1] }
random { name: "f" kind: "slow" mean_between_s: 90 for_s: 4 target: "every_vehicle" share: 0.5 }
)");
  EXPECT_EQ(file.description, "a day");
  ASSERT_THAT(file.at, SizeIs(3));
  EXPECT_EQ(file.at[0].name, "a");
  EXPECT_EQ(file.at[0].nth, 3U);
  EXPECT_EQ(file.at[0].time_s, 10);
  EXPECT_EQ(file.at[0].for_s, 5);
  EXPECT_EQ(file.at[0].kind, Kind::kLoss);
  EXPECT_EQ(file.at[0].target, (Target{Target::What::kVehicle, VehicleId{2}}));
  EXPECT_EQ(file.at[0].parameters, (faults::Parameters{.probability = 0.4}));
  EXPECT_EQ(file.at[0].line, 2);
  EXPECT_EQ(file.at[1].target, Target{Target::What::kWorld});
  EXPECT_EQ(file.at[2].parameters.from, VehicleId{2});
  ASSERT_THAT(file.random, SizeIs(3));
  EXPECT_EQ(file.random[0].mean_between_s, 60);
  EXPECT_EQ(file.random[0].for_low_s, 2);
  EXPECT_EQ(file.random[0].for_high_s, 8);
  EXPECT_EQ(file.random[0].targets.what, Targets::What::kAll);
  EXPECT_EQ(file.random[0].at_most, 3U);
  EXPECT_EQ(file.random[0].parameters.qos, "q");
  EXPECT_THAT(file.random[1].targets.named, ElementsAre(VehicleId{1}, VehicleId{3}));
  EXPECT_EQ(file.random[1].at_most, std::nullopt);
  EXPECT_EQ(file.random[2].for_low_s, 4);
  EXPECT_EQ(file.random[2].for_high_s, 4);
  EXPECT_EQ(file.random[2].targets.what, Targets::What::kEveryVehicle);
  EXPECT_EQ(file.random[2].line, 7);
}

TEST(FaultsFile, AnUnknownKindIsToldWithTheNearest) {
  const auto problems =
      ProblemsIn("at { name: \"a\" time_s: 1 kind: \"restrat\" vehicle: 1 for_s: 1 }");
  ASSERT_THAT(problems, ElementsAre(Is(1, "at[0].kind", "is no kind of fault")));
  EXPECT_THAT(problems[0].remedy, HasSubstr("write restart,"));
  EXPECT_EQ(problems[0].value, "\"restrat\"");
}

TEST(FaultsFile, IsRefusedFieldByField) {
  ExpectRefused(R"(at { time_s: 1 kind: "kill" vehicle: 1 })", "at[0].name", "missing");
  ExpectRefused(R"(at { name: "A b" time_s: 1 kind: "kill" vehicle: 1 })", "at[0].name", "1 to 64");
  ExpectRefused(R"(at { name: "a" kind: "kill" vehicle: 1 })", "at[0].time_s", "missing");
  ExpectRefused(R"(at { name: "a" time_s: -1 kind: "kill" vehicle: 1 })", "at[0].time_s",
                "between 0");
  ExpectRefused(R"(at { name: "a" time_s: nan kind: "kill" vehicle: 1 })", "at[0].time_s",
                "finite");
  ExpectRefused(R"(at { name: "a" time_s: 1 vehicle: 1 })", "at[0].kind", "missing");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "kill" })", "at[0]", "has no target");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "pause" vehicle: 1 target: "world" for_s: 1 })",
                "at[0].target", "together with vehicle");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "kill" vehicle: 0 })", "at[0].vehicle",
                "between 1");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "kill" target: "moon" })", "at[0].target",
                "none of its words");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "kill" target: "any_vehicle" })", "at[0].target",
                "none of its words");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "kill" target: "world" })", "at[0].target",
                "kill cannot meet world");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "churn" vehicle: 1 for_s: 5 })", "at[0].vehicle",
                "churn cannot meet vehicle");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "pause" vehicle: 1 })", "at[0].for_s", "missing");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "pause" vehicle: 1 for_s: 0 })", "at[0].for_s",
                "between 0.001");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "kill" vehicle: 1 for_s: 1 })", "at[0].for_s",
                "takes no time");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "loss" vehicle: 1 for_s: 1 probability: 1.5 })",
                "at[0].probability", "between 0.001 and 1");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "burst" vehicle: 1 for_s: 1 count: 9 })",
                "at[0].count", "between 10 and 10000");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "loss" vehicle: 1 for_s: 1 delay_s: 1 })",
                "at[0].delay_s", "loss does not take it");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "loss" vehicle: 1 for_s: 1 from: 2 })",
                "at[0].from", "loss does not take it");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "loss" vehicle: 1 for_s: 1 qos: "q" })",
                "at[0].qos", "loss does not take it");
  ExpectRefused(R"(at { name: "a" time_s: 1 kind: "qos_apply" vehicle: 1 for_s: 1 qos: "-x" })",
                "at[0].qos", "no name of a profile set");
  ExpectRefused(R"(random { name: "a" kind: "kill" })", "random[0].mean_between_s", "missing");
  ExpectRefused(R"(random { name: "a" kind: "kill" mean_between_s: 0 })",
                "random[0].mean_between_s", "between 0.1");
  ExpectRefused(R"(random { name: "a" kind: "pause" mean_between_s: 9 for_s: [5, 2] })",
                "random[0].for_s", "lowest is above the highest");
  ExpectRefused(R"(random { name: "a" kind: "pause" mean_between_s: 9 for_s: [1, 2, 3] })",
                "random[0].for_s", "at most 2");
  ExpectRefused(R"(random { name: "a" kind: "kill" mean_between_s: 9 at_most: 0 })",
                "random[0].at_most", "between 1");
  ExpectRefused(R"(random { name: "a" kind: "churn" mean_between_s: 9 for_s: 5 })", "random[0]",
                "churn cannot meet vehicle");
  ExpectRefused(R"(random { name: "a" kind: "kill" mean_between_s: 9 vehicle: 1 target: "world" })",
                "random[0].target", "together with vehicle");
  ExpectRefused(R"(random { name: "a" kind: "kill" mean_between_s: 9 when: 3 })", "when",
                "no field");
}

TEST(FaultsFile, NamesStandOnce) {
  const std::string one = R"(at { name: "a" time_s: 1 kind: "kill" vehicle: 1 }
)";
  EXPECT_THAT(ProblemsIn(one + R"(at { name: "a" time_s: 1 kind: "kill" vehicle: 2 })"),
              ElementsAre(Is(2, "at[1].name", "stands in line 1 too")));
  EXPECT_THAT(ProblemsIn(one + R"(at { name: "a" nth: 1 time_s: 1 kind: "kill" vehicle: 2 })"),
              IsEmpty());
  EXPECT_THAT(ProblemsIn(one + R"(random { name: "a" kind: "kill" mean_between_s: 1e6 })"),
              ElementsAre(Is(2, "random[0].name", "stands in line 1 too")));
  EXPECT_THAT(ProblemsIn(R"(random { name: "a" kind: "kill" mean_between_s: 1e6 }
random { name: "a" kind: "kill" mean_between_s: 1e6 })"),
              ElementsAre(Is(2, "random[1].name", "stands in line 1 too")));
}

TEST(FaultsFile, EveryProblemIsToldAtOnce) {
  EXPECT_THAT(ProblemsIn(R"(at { name: "a" time_s: -1 kind: "kil" vehicle: 1 }
at { name: "b" time_s: 1 kind: "pause" }
random { name: "c" kind: "loss" mean_between_s: 0 for_s: 1 probability: 2 }
)"),
              SizeIs(6));
}

TEST(FaultsFile, WhatDoesNotFitTheFleetOrTheRunIsToldWithItsLine) {
  EXPECT_THAT(ProblemsIn("\nat { name: \"a\" time_s: 1 kind: \"kill\" vehicle: 9 }"),
              ElementsAre(Is(2, "a.vehicle", "no vehicle 9")));
  EXPECT_THAT(ProblemsIn(R"(at { name: "stand" time_s: 10 kind: "pause" vehicle: 1 for_s: 5 }
at { name: "die" time_s: 12 kind: "kill" vehicle: 1 })"),
              ElementsAre(Is(2, "die", "stand (10 s for 5 s: vehicle 1: pause) of line 1")));
  EXPECT_THAT(ProblemsIn("at { name: \"a\" time_s: 1790 kind: \"kill\" vehicle: 1 }", kHalfHour),
              ElementsAre(Is(1, "a.time_s", "heals from 1785 s on")));
}

TEST(FaultsFile, AShippedOneIsFoundByItsName) {
  EXPECT_FALSE(LoadFaults("calm").random.empty());
  try {
    LoadFaults("no_such_faults");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no shipped fault file"));
    EXPECT_THAT(error.what(), HasSubstr("calm, everything, flaky_hardware, radio_storm"));
  }
}

// A soak whose draw had no fault wrote an empty file, which its world refused.
TEST(FaultsFile, AListWithoutFaultsReadsBack) {
  EXPECT_TRUE(Expand(LoadText(faults::AsTextproto({})), kHalfHour, FleetOf(2)).schedule.empty());
}

class ShippedFaults : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedFaults, DescribeThemselvesAndMakeAListThatReadsBack) {
  EXPECT_FALSE(LoadFaults(GetParam()).description.empty());
  const auto expansion = LoadAndExpandFaults(GetParam(), kHalfHour, FleetOf(20));
  EXPECT_FALSE(expansion.schedule.empty());
  const faults::FaultFile again = LoadText(faults::AsTextproto(expansion.schedule));
  EXPECT_EQ(Expand(again, kHalfHour, FleetOf(20)).schedule, expansion.schedule);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedFaults,
                         ::testing::Values("calm", "radio_storm", "flaky_hardware", "everything"));

// Except for what needs shared memory.
TEST(FaultsFile, EverythingHasEveryKindWithinHalfAnHourWhateverTheSeed) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    faults::Course course = kHalfHour;
    course.seed = seed;
    std::set<Kind> kinds;
    for (const faults::Fault& fault :
         LoadAndExpandFaults("everything", course, FleetOf(20)).schedule) {
      kinds.insert(fault.kind);
    }
    EXPECT_GE(kinds.size(), faults::kKinds - 3 - 3) << seed;  // a rare one may not have come
  }
  std::set<Kind> kinds;
  for (const faults::RandomRule& rule : LoadFaults("everything").random) kinds.insert(rule.kind);
  for (const faults::KindRow& row : faults::KindTable()) {
    const bool shared_memory = row.word.starts_with("shared_memory");
    EXPECT_EQ(kinds.contains(row.kind), !shared_memory) << row.word;
  }
}

// Any numbers, not only those that a draw can give.
TEST(FaultsFile, AnyListThatIsPrintedReadsBackBitForBit) {
  EXPECT_TRUE(rc::check("reads back", [] {
    faults::Schedule schedule;
    const auto count = *rc::gen::inRange(1U, 20U);
    for (std::uint32_t i = 0; i < count; ++i) {
      const faults::KindRow& row =
          faults::KindTable()[*rc::gen::inRange(std::size_t{0}, faults::kKinds)];
      const auto unit = [] { return *rc::gen::inRange(0, 1 << 30) / 1073741823.0; };
      faults::Fault fault{"rule-" + std::to_string(i), i, unit() * 1e6, 0, row.kind, {}, {}};
      if (row.takes_time) fault.for_s = 0.001 + unit() * 1e5;
      fault.target = row.Allows(Target::What::kVehicle)
                         ? Target{Target::What::kVehicle, VehicleId{1 + i}}
                         : Target{Target::What::kAll};
      for (const faults::QuantityRow& taken : row.numbers) {
        double value = taken.low + unit() * (taken.high - taken.low);
        Set(&fault.parameters, taken.quantity, std::clamp(value, taken.low, taken.high));
      }
      if (row.takes_from) fault.parameters.from = VehicleId{7};
      fault.parameters = Filled(row.kind, fault.parameters);
      schedule.push_back(fault);
    }
    const faults::FaultFile file = LoadText(faults::AsTextproto(schedule));
    RC_ASSERT(file.at.size() == schedule.size());
    for (std::size_t i = 0; i < schedule.size(); ++i) {
      const faults::AtRule& at = file.at[i];
      const faults::Fault read{at.name, at.nth,    at.time_s,    at.for_s,
                               at.kind, at.target, at.parameters};
      RC_ASSERT(read == schedule[i]);
    }
  }));
}

}  // namespace
}  // namespace giveway
