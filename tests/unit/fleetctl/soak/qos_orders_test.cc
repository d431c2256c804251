// When a soak orders a vehicle to take another profile set, and its own again. The orders
// themselves are in tests/system/soak.sh.
#include "services/fleetctl/soak/host_faults/qos_orders.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>

#include "services/qos/profile_set.h"
#include "services/qos/xml_tree.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;

TEST(QosOrderCourse, ASetIsTakenOnceAndTakenBackWhenTheFaultIsOver) {
  QosOrderCourse course;
  EXPECT_EQ(course.Due(seconds(1)), QosOrder::kTake);
  course.NoteGiven(QosOrder::kTake);
  EXPECT_EQ(course.Due(seconds(1)), std::nullopt);
  course.NoteEnd(true, seconds(3));
  EXPECT_EQ(course.Due(seconds(60)), std::nullopt);
  course.NoteFaultOver();
  EXPECT_EQ(course.Due(seconds(60)), QosOrder::kTakeBack);
  EXPECT_FALSE(course.IsOver());
  course.NoteGiven(QosOrder::kTakeBack);
  course.NoteEnd(true, seconds(61));
  EXPECT_TRUE(course.IsOver());
}

// Both may not run at once: which would end last is not known.
TEST(QosOrderCourse, AFaultThatEndsDuringTheOrderTakesItBackAfterwards) {
  QosOrderCourse course;
  course.NoteGiven(QosOrder::kTake);
  course.NoteFaultOver();
  EXPECT_EQ(course.Due(seconds(9)), std::nullopt);
  EXPECT_FALSE(course.IsOver());
  course.NoteEnd(true, seconds(10));
  EXPECT_EQ(course.Due(seconds(10)), QosOrder::kTakeBack);
}

TEST(QosOrderCourse, AnOrderThatFailsIsGivenAgainAfterAWhile) {
  QosOrderCourse course;
  course.NoteGiven(QosOrder::kTake);
  course.NoteEnd(false, seconds(10));
  EXPECT_EQ(course.Due(seconds(11)), std::nullopt);
  EXPECT_EQ(course.Due(seconds(12)), QosOrder::kTake);
}

TEST(QosOrderCourse, TakingItBackIsAttemptedAFewTimesOnly) {
  QosOrderCourse course;
  course.NoteFaultOver();
  int attempts = 0;
  SteadyTime now = seconds(1);
  for (; !course.IsOver() && attempts < 100; ++attempts, now += seconds(10)) {
    ASSERT_EQ(course.Due(now), QosOrder::kTakeBack);
    course.NoteGiven(QosOrder::kTakeBack);
    course.NoteEnd(false, now);
  }
  EXPECT_EQ(attempts, 5);
}

qos::ProfileSet SetOf(const std::string& text) {
  return qos::ReadProfiles(*qos::ReadXml(text, "set").root, "set");
}

class EachShippedSet : public testing::TestWithParam<const char*> {};

TEST_P(EachShippedSet, WithPatientReadersDiffersInTheirDeadlinesAlone) {
  std::ifstream file(std::string(GIVEWAY_QOS_SETS) + "/" + GetParam());
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const qos::ProfileSet own = SetOf(text);
  const qos::ProfileSet patient = SetOf(WithPatientReaders(text, "set"));
  ASSERT_EQ(patient.profiles.size(), own.profiles.size());
  int doubled = 0;
  for (std::size_t i = 0; i < own.profiles.size(); ++i) {
    const qos::Value& was = own.profiles[i][qos::Policy::kDeadline];
    const std::int64_t is = patient.profiles[i].Number(qos::Policy::kDeadline);
    const bool reader = own.profiles[i].owner == qos::Owner::kReader;
    EXPECT_EQ(is, reader && was.given ? 2 * was.number : was.number) << own.profiles[i].name;
    doubled += is == was.number ? 0 : 1;
  }
  EXPECT_GT(doubled, 5);
}

INSTANTIATE_TEST_SUITE_P(Sets, EachShippedSet,
                         testing::Values("default.xml", "lossy_radio.xml", "same_host.xml",
                                         "wan_discovery_server.xml"));

TEST(PatientReaders, WhatIsNoProfileFileHasNone) {
  EXPECT_EQ(WithPatientReaders("<dds", "set"), "");
}

}  // namespace
}  // namespace giveway::fleetctl
