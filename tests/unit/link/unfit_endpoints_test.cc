// Endpoints on our topics that will never match, as reported by discovery.
#include "services/link/inbox/unfit_endpoints.h"

#include <gmock/gmock.h>

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

FoundEndpoint Endpoint(bool writes, const std::string& topic, const std::string& partition,
                       std::uint8_t participant) {
  FoundEndpoint endpoint;
  endpoint.guid = {1, 0x10, participant};
  endpoint.writes = writes;
  endpoint.topic = topic;
  endpoint.type = "giveway::wire::Join";
  if (!partition.empty()) endpoint.partitions = {partition};
  return endpoint;
}

class Unfit : public testing::Test {
 protected:
  // What is said of these a second after they were found.
  std::vector<std::string> Lines(const std::vector<FoundEndpoint>& found) {
    for (const FoundEndpoint& one : found) unfit_.Add(one, seconds(5));
    EXPECT_THAT(unfit_.Check(own_, seconds(5) + milliseconds(999)), IsEmpty());
    auto lines = unfit_.Check(own_, seconds(6));
    EXPECT_THAT(unfit_.Check(own_, seconds(60)), IsEmpty());
    return lines;
  }
  static FoundEndpoint JoinReader() {
    FoundEndpoint reader = Endpoint(false, "fleet/join", "fleet", 0);
    reader.reliable = true;
    reader.durability = 1;
    return reader;
  }
  static FoundEndpoint JoinWriter(const std::string& partition = "fleet") {
    FoundEndpoint writer = Endpoint(true, "fleet/join", partition, 7);
    writer.reliable = true;
    writer.durability = 1;
    return writer;
  }

  std::vector<FoundEndpoint> own_ = {JoinReader()};
  UnfitEndpoints unfit_;
};

TEST_F(Unfit, AJoinOfTheRightQosAndPartitionIsNoNews) {
  EXPECT_THAT(Lines({JoinWriter()}), IsEmpty());
}

TEST_F(Unfit, AJoinWithTheWrongDurabilityIsToldWithBothValues) {
  FoundEndpoint writer = JoinWriter();
  writer.durability = 0;
  EXPECT_THAT(Lines({writer}),
              ElementsAre("a writer of fleet/join in fleet (Eclipse Cyclone DDS, participant "
                          "011007000000000000000000) does not match: durability offered VOLATILE, "
                          "requested TRANSIENT_LOCAL"));
}

// They never match, and nothing said why.
TEST_F(Unfit, AnExclusiveWriterOfASharedReaderIsNamed) {
  FoundEndpoint writer = JoinWriter();
  writer.exclusive = true;
  EXPECT_THAT(Lines({writer}),
              ElementsAre(HasSubstr("ownership offered EXCLUSIVE, requested SHARED")));
}

TEST_F(Unfit, AWriterWithoutAPartitionIsTold) {
  EXPECT_THAT(Lines({JoinWriter("")}),
              ElementsAre(HasSubstr("a writer of fleet/join with no partition")));
}

TEST_F(Unfit, AnotherTypeOnATopicIsTold) {
  FoundEndpoint writer = JoinWriter();
  writer.type = "giveway::wire::dds_::Join_";
  EXPECT_THAT(Lines({writer}), ElementsAre(HasSubstr("type giveway::wire::dds_::Join_ written")));
}

TEST_F(Unfit, WhatIsMeantForOthersIsNot) {
  own_ = {Endpoint(true, "world/ranges", "v1", 0), Endpoint(true, "world/ranges", "v2", 0),
          Endpoint(false, "fleet/beacon", "main/*", 0)};
  EXPECT_THAT(Lines({Endpoint(false, "world/ranges", "v3", 7),
                     Endpoint(true, "fleet/beacon", "north/v4", 7),
                     Endpoint(true, "fleet/beacon", "main/v5", 8),
                     Endpoint(true, "fleet/beacon", "", 8),  // besides that in a partition
                     Endpoint(true, "chatter", "", 9)}),
              IsEmpty());
}

TEST_F(Unfit, AReaderThatAsksForMoreThanItsOwnWriterOffersIsTold) {
  FoundEndpoint reader = Endpoint(false, "world/ranges", "v2", 7);
  reader.reliable = true;
  own_ = {Endpoint(true, "world/ranges", "v1", 0), Endpoint(true, "world/ranges", "v2", 0),
          Endpoint(true, "world/ranges", "v3", 0)};
  EXPECT_THAT(Lines({reader}),
              ElementsAre(HasSubstr("reliability offered BEST_EFFORT, requested RELIABLE")));
}

// Issue 21, number 11: 512 endpoints of vehicles that had come stayed, 150 KB of a world.
TEST_F(Unfit, OfThoseThatCameLongAgoFewAreKnown) {
  SteadyTime now = seconds(10);
  for (std::uint32_t vehicle = 1; vehicle <= 500; ++vehicle, now += seconds(1)) {
    for (int i = 0; i < 10; ++i) unfit_.Add(JoinWriter(), now);
    EXPECT_THAT(unfit_.Check(own_, now), IsEmpty());
  }
  EXPECT_LE(unfit_.Known(), 150U);
  // A vehicle's other endpoints are still known, with eleven others in between.
  own_.push_back(Endpoint(false, "fleet/beacon", "main/*", 0));
  unfit_.Add(Endpoint(true, "fleet/beacon", "main/v5", 8), now);
  for (int i = 0; i < 110; ++i) unfit_.Add(JoinWriter(), now);
  EXPECT_THAT(unfit_.Check(own_, now += seconds(1)), IsEmpty());
  unfit_.Add(Endpoint(true, "fleet/beacon", "", 8), now);
  EXPECT_THAT(unfit_.Check(own_, now + seconds(1)), IsEmpty());
}

}  // namespace
}  // namespace giveway::link
