#include <gmock/gmock.h>

#include "services/qos/changes.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<Change> Changes(const std::string& from, const std::string& to) {
  const XmlRead before = ReadXml(from, "from.xml");
  const XmlRead after = ReadXml(to, "to.xml");
  EXPECT_TRUE(before.root && after.root);
  return Changes(*before.root, *after.root);
}

std::string Set(const std::string& profiles) {
  return "<dds><profiles>" + profiles + "</profiles></dds>";
}
std::string Reader(const std::string& qos) {
  return Set("<data_reader profile_name=\"r\"><qos>" + qos + "</qos></data_reader>");
}
std::string WithDeadline(const std::string& period) {
  return Reader("<deadline><period>" + period + "</period></deadline>");
}

TEST(Changes, OfASetToItselfAreNone) {
  for (const auto& file : XmlFilesIn(GIVEWAY_QOS_SETS)) {
    EXPECT_THAT(Changes(BytesOf(file), BytesOf(file)), IsEmpty()) << file;
  }
}

TEST(Changes, OfADeadlineTakeEffectAtOnce) {
  const auto changes = Changes(WithDeadline("<nanosec>150000000</nanosec>"),
                               WithDeadline("<nanosec>180000000</nanosec>"));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].profile, "r");
  EXPECT_EQ(changes[0].what, "deadline");
  EXPECT_EQ(changes[0].from, "150 ms");
  EXPECT_EQ(changes[0].to, "180 ms");
  EXPECT_EQ(changes[0].number, 180'000'000);
  EXPECT_EQ(changes[0].effect, Effect::kNow);
  EXPECT_FALSE(NeedsRestart(changes));
}

TEST(Changes, OfAnythingElseTakeARestart) {
  const std::string before = Reader("<reliability><kind>BEST_EFFORT</kind></reliability>");
  for (const char* qos : {"<reliability><kind>RELIABLE</kind></reliability>",
                          "<liveliness><lease_duration><sec>1</sec></lease_duration></liveliness>",
                          "<durability><kind>TRANSIENT_LOCAL</kind></durability>"}) {
    EXPECT_TRUE(NeedsRestart(Changes(before, Reader(qos)))) << qos;
  }
}

TEST(Changes, AreNoneWhereADefaultIsOnlyWrittenDown) {
  EXPECT_THAT(Changes(Reader(""), Reader("<durability><kind>VOLATILE</kind></durability>")),
              IsEmpty());
  EXPECT_THAT(Changes(WithDeadline("<sec>1</sec><nanosec>0</nanosec>"),
                      WithDeadline("<!-- a second --><sec>1</sec>")),
              IsEmpty());
}

TEST(Changes, OfWhatNoPolicyNamesAreToldByTheirElement) {
  const std::string transport =
      "<transport_descriptors><transport_descriptor><transport_id>udp</transport_id>"
      "<type>UDPv4</type><TTL>%</TTL></transport_descriptor></transport_descriptors>";
  std::string one = transport;
  std::string two = transport;
  one.replace(one.find('%'), 1, "1");
  two.replace(two.find('%'), 1, "2");
  const auto changes = Changes(Set(one), Set(two));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].profile, "transport udp");
  EXPECT_EQ(changes[0].what, "TTL");
  EXPECT_EQ(changes[0].from, "1");
  EXPECT_EQ(changes[0].to, "2");
  EXPECT_EQ(changes[0].effect, Effect::kRestart);
}

std::string Peers(const std::string& list) {
  return Set("<participant profile_name=\"p\"><rtps><builtin><initialPeersList>" + list +
             "</initialPeersList></builtin></rtps></participant>");
}

TEST(Changes, OfAListKeepItsOrder) {
  const std::string a = "<locator><udpv4><address>10.0.0.1</address></udpv4></locator>";
  const std::string b = "<locator><udpv4><address>10.0.0.2</address></udpv4></locator>";
  EXPECT_THAT(Changes(Peers(a + b), Peers(a + b)), IsEmpty());
  EXPECT_THAT(Changes(Peers(a), Peers(a + b)), SizeIs(1));
  EXPECT_THAT(Changes(Peers(a + b), Peers(b + a)), SizeIs(2));
}

// Two lists whose texts are the same in a row.
TEST(Changes, OfWhichEntryOfAListSaysWhatAreSeen) {
  const std::string only = "<locator><udpv4><address>10.0.0.1</address></udpv4></locator>";
  const std::string port = "<locator><udpv4><port>7</port></udpv4></locator>";
  const std::string both =
      "<locator><udpv4><address>10.0.0.1</address><port>7</port></udpv4></locator>";
  EXPECT_THAT(Changes(Peers(only + port), Peers(both)), SizeIs(2));
  EXPECT_THAT(Changes(Peers(only + only), Peers(only)), SizeIs(1));
}

// By its prefix Fast DDS 2.9.1 knows a server.
TEST(Changes, OfAnAttributeAreSeen) {
  const auto with = [](const std::string& prefix) {
    return Set(
        "<participant profile_name=\"p\"><rtps><builtin><discovery_config><discoveryServersList>"
        "<RemoteServer prefix=\"" +
        prefix + "\"/></discoveryServersList></discovery_config></builtin></rtps></participant>");
  };
  const auto changes = Changes(with("44.53.00"), with("44.53.01"));
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_THAT(changes[0].what, ::testing::EndsWith("RemoteServer@prefix"));
  EXPECT_EQ(changes[0].to, "44.53.01");
}

TEST(Changes, OfAProfileThatComesOrGoesTakeARestart) {
  const std::string none = Set("");
  for (const auto& changes : {Changes(none, Reader("")), Changes(Reader(""), none)}) {
    ASSERT_THAT(changes, SizeIs(1));
    EXPECT_EQ(changes[0].what, "profile");
    EXPECT_TRUE(NeedsRestart(changes));
  }
}

}  // namespace
}  // namespace giveway::qos
