#include "services/fleetctl/plan/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "services/fleetctl/plan/plan_costs.h"

namespace giveway::fleetctl {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

qos::ProfileFile DefaultSet() {
  std::ifstream file(GIVEWAY_QOS_SETS "/default.xml", std::ios::binary);
  return {"default.xml", {std::istreambuf_iterator<char>(file), {}}};
}

// Of hosts on which nothing is short.
PlanRequest Of(std::uint32_t vehicles, std::uint32_t hosts = 1) {
  return {.vehicles = vehicles,
          .hosts = hosts,
          .cores = 1e6,
          .memory_mib = 1e9,
          .link_mbit_s = 1e9,
          .set = DefaultSet()};
}

const PlanRow& RowOf(const PlanReport& report, std::string_view name) {
  const auto row = std::ranges::find(report.rows, name, &PlanRow::name);
  EXPECT_NE(row, report.rows.end()) << name;
  return *row;
}

std::vector<std::string> Rules(const PlanReport& report) {
  std::vector<std::string> rules;
  for (const qos::Finding& finding : report.findings) rules.push_back(finding.rule);
  return rules;
}

// What tests/bench/fleet_costs.sh printed where the costs are from.
struct Measured {
  std::uint32_t vehicles;
  double vehicle_cpu_ms_s;
  double others_cpu_ms_s;  // world and observer
  double vehicle_mib;
  double packets_s;
  double start_packets;
};

TEST(Plan, ReckonsWhatWasMeasured) {
  for (const Measured& m : {Measured{8, 12.0, 17.5 + 21.6, 19.4, 2131, 3226},
                            Measured{16, 16.7, 25.8 + 29.1, 19.7, 6927, 11473},
                            Measured{32, 24.8, 39.1 + 40.8, 20.5, 24589, 69684}}) {
    const PlanReport report = Plan(Of(m.vehicles));
    const PlanRow& cpu = RowOf(report, "processor, cores");
    EXPECT_NEAR(*cpu.vehicle * 1000, m.vehicle_cpu_ms_s, 0.1 * m.vehicle_cpu_ms_s);
    EXPECT_NEAR((*cpu.fleet - m.vehicles * *cpu.vehicle) * 1000, m.others_cpu_ms_s,
                0.1 * m.others_cpu_ms_s);
    EXPECT_NEAR(*RowOf(report, "memory, MiB").vehicle, m.vehicle_mib, 0.02 * m.vehicle_mib);
    EXPECT_NEAR(*RowOf(report, "packets/s").fleet, m.packets_s, 0.02 * m.packets_s);
    // One run differs from the next by a fifth.
    EXPECT_NEAR(*RowOf(report, "discovery, packets").fleet, m.start_packets, 0.3 * m.start_packets);
  }
}

TEST(Plan, SamplesComeFromEveryPeerAndTheWorldOnceATick) {
  PlanRequest request = Of(10, 2);
  EXPECT_EQ(RowOf(Plan(request), "samples received/s").vehicle, 200);
  EXPECT_EQ(RowOf(Plan(request), "samples received/s").host, 5 * 200);
  request.tick_ns /= 2;
  EXPECT_EQ(RowOf(Plan(request), "samples received/s").vehicle, 400);
  EXPECT_EQ(RowOf(Plan(request), "instances of fleet/beacon").vehicle, 10);
}

TEST(Plan, TheBusiestHostHasTheWorldAndTheOddVehicle) {
  const PlanReport report = Plan(Of(11, 3));
  EXPECT_EQ(RowOf(report, "participants").host, 4 + 2);
  EXPECT_EQ(RowOf(report, "participants").fleet, 13);
  EXPECT_EQ(RowOf(report, "threads").host, 6 * Costs{}.threads);
}

TEST(Plan, AProcessHasTheThreadsOfItsRelease) {
  PlanRequest request = Of(4);
  EXPECT_EQ(RowOf(Plan(request), "threads").vehicle, 7);
  request.library_major = 3;
  EXPECT_EQ(RowOf(Plan(request), "threads").vehicle, 10);
}

TEST(Plan, OnlyHostsThatAreApartSendToEachOther) {
  EXPECT_EQ(RowOf(Plan(Of(10)), "sent to other hosts, Mbit/s").host, 0);
  EXPECT_GT(*RowOf(Plan(Of(10, 2)), "sent to other hosts, Mbit/s").host, 0);
}

TEST(Plan, LargeFleetsAnnounceThemselvesEveryFiveSeconds) {
  EXPECT_EQ(RowOf(Plan(Of(32)), "announcements/s").fleet, 34 * 34);
  EXPECT_EQ(RowOf(Plan(Of(33)), "announcements/s").fleet, 35 * 35 / 5.0);
}

TEST(Plan, WhatFitsHasNoFindings) {
  const PlanReport report = Plan(Of(20));
  EXPECT_TRUE(report.Fits());
  EXPECT_THAT(report.findings, IsEmpty());
  EXPECT_FALSE(report.fewer_vehicles || report.more_hosts);
}

TEST(Plan, EveryShortageIsNamedWarnedOfAboveHalfAndRefusedAboveNineTenths) {
  struct Shortage {
    const char* rule;
    const char* row;
    double PlanRequest::*has;
  };
  for (const Shortage& shortage :
       {Shortage{"processor", "processor, cores", &PlanRequest::cores},
        Shortage{"memory", "memory, MiB", &PlanRequest::memory_mib},
        Shortage{"link", "sent to other hosts, Mbit/s", &PlanRequest::link_mbit_s}}) {
    PlanRequest request = Of(20, 2);
    const double used = *RowOf(Plan(request), shortage.row).host;
    request.*shortage.has = used / 0.49;
    EXPECT_THAT(Rules(Plan(request)), IsEmpty()) << shortage.rule;
    request.*shortage.has = used / 0.89;
    EXPECT_THAT(Rules(Plan(request)), ElementsAre(shortage.rule));
    EXPECT_TRUE(Plan(request).Fits());
    request.*shortage.has = used / 0.91;
    EXPECT_THAT(Rules(Plan(request)), ElementsAre(shortage.rule));
    EXPECT_FALSE(Plan(request).Fits());
  }
}

TEST(Plan, WhatIsSaidToFitDoesAndOneStepBackDoesNot) {
  PlanRequest request = Of(100);
  request.cores = 4;
  const PlanReport report = Plan(request);
  ASSERT_FALSE(report.Fits());
  ASSERT_TRUE(report.fewer_vehicles && report.more_hosts);
  const auto fits = [&](std::uint32_t vehicles, std::uint32_t hosts) {
    PlanRequest changed = request;
    changed.vehicles = vehicles;
    changed.hosts = hosts;
    return Plan(changed).Fits();
  };
  EXPECT_TRUE(fits(*report.fewer_vehicles, 1));
  EXPECT_FALSE(fits(*report.fewer_vehicles + 1, 1));
  EXPECT_TRUE(fits(100, *report.more_hosts));
  EXPECT_FALSE(fits(100, *report.more_hosts - 1));
  EXPECT_THAT(ToText(request, report), HasSubstr("It does not fit."));
  EXPECT_THAT(ToText(request, report), HasSubstr(std::to_string(*report.more_hosts) + " hosts"));
}

TEST(Plan, ParticipantsOfAHostNeedPortsUnlessTheyHaveANetworkEach) {
  PlanRequest request = Of(500);
  EXPECT_THAT(Rules(Plan(request)), Contains("participant_limit"));
  EXPECT_FALSE(Plan(request).Fits());
  EXPECT_LE(*Plan(request).fewer_vehicles, 400U);
  request.hosts = 10;
  EXPECT_THAT(Rules(Plan(request)), Not(Contains("participant_limit")));
  request.hosts = 1;
  request.containers = true;
  EXPECT_THAT(Rules(Plan(request)), Not(Contains("participant_limit")));
}

TEST(Plan, ASetThatIsNoneIsRefused) {
  PlanRequest request = Of(4);
  request.set.bytes = "<dds><profiles>";
  const PlanReport report = Plan(request);
  EXPECT_FALSE(report.Fits());
  EXPECT_FALSE(report.fewer_vehicles || report.more_hosts);
}

}  // namespace
}  // namespace giveway::fleetctl
