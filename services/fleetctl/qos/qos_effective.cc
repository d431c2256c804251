#include "services/fleetctl/qos/qos_effective.h"

#include <algorithm>
#include <cstdlib>

#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/qos/qos_in_child.h"
#include "services/qos/deployment.h"
#include "services/qos/xml_tree.h"

namespace giveway::fleetctl {
namespace {

qos::Owner OwnerOf(const link::ResolvedEntity& entity) {
  if (entity.topic.empty()) return qos::Owner::kParticipant;
  return entity.profile.ends_with("_writer") ? qos::Owner::kWriter : qos::Owner::kReader;
}

QosRow RowOf(const link::ResolvedValue& value, const qos::PolicyInfo& info,
             const qos::Profile& profile) {
  const qos::Value& said = profile[info.policy];
  QosRow row{std::string(info.name), qos::Text(info.policy, value.number)};
  if (said.number != value.number) {
    row.origin = QosOrigin::kCode;
  } else if (said.given) {
    row.origin = QosOrigin::kProfile;
    row.line = said.place.line;
  }
  return row;
}

QosRow PartitionRow(const qos::Topic& topic, qos::Owner owner) {
  return {"partition", std::string(owner == qos::Owner::kWriter ? topic.written_in : topic.read_in),
          QosOrigin::kCode};
}

// Empty if it is not XML: the library will refuse it with its own message.
qos::ProfileSet SetOf(const QosProfiles& profiles) {
  const qos::XmlRead xml = qos::ReadXml(profiles.text, profiles.name);
  return xml.root ? qos::ReadProfiles(*xml.root, profiles.name) : qos::ProfileSet{};
}

QosRow InterfaceRow(const std::string& interface) {
  QosOrigin origin = QosOrigin::kFlag;
  const char* twin = std::getenv("GIVEWAY_INTERFACE");
  if (interface == link::LinkOptions{}.interface) origin = QosOrigin::kCode;
  if (twin != nullptr && interface == twin) origin = QosOrigin::kEnvironment;
  return {"interface", interface, origin};
}

}  // namespace

std::string Name(QosOrigin origin) {
  switch (origin) {
    case QosOrigin::kProfile:
      return "profile";
    case QosOrigin::kDefault:
      return "default";
    case QosOrigin::kCode:
      return "code";
    case QosOrigin::kEnvironment:
      return "environment";
    case QosOrigin::kDiscovered:
      return "discovered";
    case QosOrigin::kFlag:
      break;
  }
  return "flag";
}

std::vector<EffectiveEndpoint> EffectiveQos(const std::vector<link::ResolvedEntity>& resolved,
                                            const qos::ProfileSet& set) {
  std::vector<EffectiveEndpoint> endpoints;
  for (const link::ResolvedEntity& entity : resolved) {
    const qos::Owner owner = OwnerOf(entity);
    const qos::Profile silent = qos::DefaultProfile(owner, entity.profile);
    const qos::Profile* profile = set.Find(owner, entity.profile);
    EffectiveEndpoint endpoint{entity.profile, entity.topic, {}};
    // In the order of the table, whatever the order they were answered in.
    for (const qos::PolicyInfo& info : qos::Policies()) {
      const auto value = std::ranges::find(entity.values, info.name, &link::ResolvedValue::policy);
      if (value == entity.values.end()) continue;
      endpoint.rows.push_back(RowOf(*value, info, profile == nullptr ? silent : *profile));
    }
    if (const qos::Topic* topic = qos::TopicOfProfile(entity.profile)) {
      endpoint.rows.push_back(PartitionRow(*topic, owner));
    }
    endpoints.push_back(std::move(endpoint));
  }
  return endpoints;
}

EffectiveSet EffectiveQosOfFile(const std::string& argument, const std::string& interface,
                                std::uint32_t vehicles) {
  link::LinkOptions options;
  options.domain = 1;  // nothing is opened in it
  options.interface = interface;
  options.fleet_size = vehicles;
  const std::string file = ResolveQosFile(argument);
  options.qos = ReadQosOrThrow(file);
  EffectiveSet set{options.qos.name, options.qos.text,
                   EffectiveQos(ResolveQosInChild(options), SetOf(options.qos))};
  set.endpoints.front().rows.push_back(InterfaceRow(interface));
  return set;
}

std::string OriginText(const QosRow& row, const std::string& file) {
  if (row.origin == QosOrigin::kProfile) {
    return row.line == 0 ? file : file + ":" + std::to_string(row.line);
  }
  return row.origin == QosOrigin::kDefault ? "library default" : Name(row.origin);
}

}  // namespace giveway::fleetctl
