// The table of policies and topics in services/qos against the library: every default, every value
// of the shipped sets, every topic.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "services/fleetctl/qos/qos_effective.h"
#include "services/fleetctl/qos/qos_in_child.h"
#include "services/qos/deployment.h"
#include "services/qos/xml_tree.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

std::vector<EffectiveEndpoint> EffectiveOf(const fs::path& file) {
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const qos::XmlRead read = qos::ReadXml(text, file);
  EXPECT_TRUE(read.root.has_value());
  link::LinkOptions options;
  options.domain = 1;
  options.qos = {file, text};
  return EffectiveQos(ResolveQosInChild(options), qos::ReadProfiles(*read.root, file));
}

// What participant.cc adds to a profile; everything else is the file's or the library's.
bool IsSetByCode(const EffectiveEndpoint& endpoint, const QosRow& row) {
  return row.policy == "partition" || row.policy == "heartbeat_period" ||
         (row.policy == "depth" && endpoint.topic == "world/event");
}

// A value that neither we nor the table expect would count as set by code.
void ExpectNoOtherFromCode(const std::vector<EffectiveEndpoint>& endpoints) {
  for (const EffectiveEndpoint& endpoint : endpoints) {
    for (const QosRow& row : endpoint.rows) {
      if (IsSetByCode(endpoint, row)) continue;
      EXPECT_NE(row.origin, QosOrigin::kCode)
          << endpoint.profile << ": the library has " << row.policy << " " << row.value;
    }
  }
}

TEST(ResolvedQos, OfTheShippedSetsIsWhatThePureReaderSays) {
  for (const auto& entry : fs::directory_iterator(GIVEWAY_QOS_SETS)) {
    if (entry.path().extension() != ".xml") continue;
    SCOPED_TRACE(entry.path());
    ExpectNoOtherFromCode(EffectiveOf(entry.path()));
  }
}

TEST(ResolvedQos, OfASilentSetIsTheTableOfDefaults) {
  std::string profiles = R"(<transport_descriptors><transport_descriptor>
<transport_id>udp</transport_id><type>UDPv4</type></transport_descriptor></transport_descriptors>
<participant profile_name="giveway_participant"><rtps><userTransports>
<transport_id>udp</transport_id></userTransports>
<useBuiltinTransports>false</useBuiltinTransports></rtps></participant>)";
  for (const qos::Topic& topic : qos::FleetTopics()) {
    const std::string stem(topic.stem);
    profiles += "<data_writer profile_name=\"" + stem + "_writer\"/>";
    profiles += "<data_reader profile_name=\"" + stem + "_reader\"/>";
  }
  const fs::path file =
      fs::temp_directory_path() / ("giveway-silent-qos-" + std::to_string(getpid()) + ".xml");
  std::ofstream(file) << "<dds><profiles>" << profiles << "</profiles></dds>";
  const std::vector<EffectiveEndpoint> endpoints = EffectiveOf(file);
  fs::remove(file);
  ExpectNoOtherFromCode(endpoints);
  for (const EffectiveEndpoint& endpoint : endpoints) {
    for (const QosRow& row : endpoint.rows) {
      if (IsSetByCode(endpoint, row) || row.policy == "builtin_transports") continue;
      EXPECT_EQ(row.origin, QosOrigin::kDefault) << endpoint.profile << " " << row.policy;
    }
  }
}

TEST(ResolvedQos, KnowsTheTopicsAndPoliciesThatTheTablesName) {
  const auto endpoints = EffectiveOf(fs::path(GIVEWAY_QOS_SETS) / "default.xml");
  std::set<std::string> topics, policies, known_topics, known_policies;
  for (const EffectiveEndpoint& endpoint : endpoints) {
    topics.insert(endpoint.topic);
    for (const QosRow& row : endpoint.rows) policies.insert(row.policy);
  }
  for (const qos::Topic& topic : qos::FleetTopics()) known_topics.emplace(topic.name);
  for (const qos::PolicyInfo& info : qos::Policies()) known_policies.emplace(info.name);
  topics.erase("");             // the participant
  policies.erase("partition");  // of no profile
  EXPECT_EQ(topics, known_topics);
  EXPECT_EQ(policies, known_policies);
}

}  // namespace
}  // namespace giveway::fleetctl
