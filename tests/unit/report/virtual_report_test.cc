// The report of a batch of virtual runs as JSON and as text.
#include "services/report/virtual_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

VirtualReport Failed() {
  VirtualReport report;
  report.scenario = "swarm";
  report.verdict = Verdict::kFailed;
  report.reason = "contact";
  report.runs = 200;
  report.failed_runs = 2;
  report.contacts = 3;
  report.violations = {{"contact", 3}, {"arrival", 0}};
  report.vehicle_hours = 12.5;
  report.delay_p50_s = 1.25;
  report.delay_p99_s = 9;
  report.delay_mean_s = 2.5;
  report.traffic = {
      .by_rule_s = {{"cruise", 26.5}, {"give_way", 1.25}}, .stops = 0.5, .taken_back = 2};
  report.trust = {1, 2, 3, 4, 5};
  report.hash = "00000000000000ff";
  report.failing_seeds = {7, 99};
  return report;
}

TEST(VirtualReportAsJson, HasTheFieldsOfTheSchemaOnOneLine) {
  const std::string json = ToJson(Failed());
  EXPECT_THAT(json, Not(HasSubstr("\n")));
  for (
      const char* part :
      {R"("scenario":"swarm")", R"("verdict":"failed")", R"("runs":200)", R"("contacts":3)",
       R"("violations":{"contact":3,)", R"("wait_cycle":0)", R"("vehicle_hours":12.5)",
       R"("delay_s":{"p50":1.25,"p99":9,"mean":2.5})", R"("hash":"00000000000000ff")",
       R"("failing_seeds":[7,99])",
       R"("traffic":{"by_rule":[{"rule":"cruise","mean_s":26.5},{"rule":"give_way","mean_s":1.25}],)"
       R"("stops":0.5,"taken_back":2})",
       R"("trust":{"beacon_without_echo":1,"echo_without_beacon":2,"halted_but_closing":3,)"
       R"("jumps":4,"impossible_speeds":5})"}) {
    EXPECT_THAT(json, HasSubstr(part));
  }
}

TEST(VirtualReport, NamesWhoBrokeWhatWhen) {
  VirtualReport report = Failed();
  report.first_violations = {
      {7, 12.35, {"contact", Tick{247}, VehicleId{4}, VehicleId{9}}, "cruise"},
      {99, 3, {"clearance", Tick{60}, VehicleId{2}, kNoVehicle}, "obstacle"}};
  report.vehicles = 20;
  report.arrived = 18;
  const std::string text = ToText(report);
  EXPECT_THAT(text, HasSubstr("seed 7, 12.35 s (tick 247): contact, vehicle 4 with 9, cruise\n"));
  EXPECT_THAT(text, HasSubstr("seed 99, 3.00 s (tick 60): clearance, vehicle 2, obstacle\n"));
  EXPECT_THAT(text, HasSubstr("arrived 18 of 20 vehicles"));
  const std::string json = ToJson(report);
  EXPECT_THAT(json, HasSubstr(R"({"invariant":"contact","tick":247,"vehicle":4,"other":9,"seed":7,)"
                              R"("time_s":12.35,"rule":"cruise"})"));
  EXPECT_THAT(json, HasSubstr(R"("arrived":18)"));
}

TEST(VirtualReportAsJson, LeavesOutTheDelayIfNobodyArrived) {
  VirtualReport report = Failed();
  report.delay_p50_s.reset();
  report.delay_p99_s.reset();
  report.delay_mean_s.reset();
  EXPECT_THAT(ToJson(report), Not(HasSubstr("delay_s")));
}

TEST(VirtualReportAsText, NamesWhatBrokeAndTheSeeds) {
  const std::string text = ToText(Failed());
  EXPECT_THAT(text, HasSubstr("swarm: FAILED, contact"));
  EXPECT_THAT(text, HasSubstr("contact broken 3 times"));
  EXPECT_THAT(text, Not(HasSubstr("arrival broken")));
  EXPECT_THAT(text, HasSubstr("failing seeds: 7 99"));
  EXPECT_THAT(text, HasSubstr("did not fit: 1 beacons without echo, 3 halted but closing, 4 jumps, "
                              "5 impossible speeds; 2 echoes without beacon"));
}

}  // namespace
}  // namespace giveway
