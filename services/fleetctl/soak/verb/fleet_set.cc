#include "services/fleetctl/soak/verb/fleet_set.h"

#include <fmt/format.h>

#include "services/faults/kind_table.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/qos/request_offered.h"
#include "services/qos/xml_tree.h"

namespace giveway::fleetctl {
namespace {

qos::ProfileSet ReadSet(const std::string& file) {
  const QosProfiles profiles = ReadSoundQos(file);
  const qos::XmlRead read = qos::ReadXml(profiles.text, profiles.name);
  return read.root ? qos::ReadProfiles(*read.root, profiles.name) : qos::ProfileSet{};
}

// What a vehicle counts as incompatible are writers of beacons that its own reader does not match.
bool HearsBeaconsOf(const qos::ProfileSet& reads, const qos::ProfileSet& writes) {
  const qos::Profile* const reader = reads.Find(qos::Owner::kReader, "fleet_beacon_reader");
  const qos::Profile* const writer = writes.Find(qos::Owner::kWriter, "fleet_beacon_writer");
  return reader == nullptr || writer == nullptr || qos::WillMatch(*writer, *reader);
}

}  // namespace

FleetSet::FleetSet(const std::string& file) : set_(ReadSet(file)) {}

std::string FleetSet::WhyNot(const faults::Fault& fault) {
  if (faults::ActorOf(fault.kind) == faults::Actor::kHearer && qos::UsesSharedMemory(set_)) {
    return "the fleet's profile set names shared memory, and only what is heard by UDP is impaired";
  }
  if (fault.kind != faults::Kind::kQosMismatch) return {};
  const auto [why, is_new] = no_mismatch_.try_emplace(fault.parameters.qos);
  if (is_new) why->second = WhyNoMismatch(fault.parameters.qos);
  return why->second;
}

std::string FleetSet::WhyNoMismatch(const std::string& name) const {
  const qos::ProfileSet other = ReadSet(ResolveQosFile(name));
  if (!HearsBeaconsOf(set_, other) || !HearsBeaconsOf(other, set_)) return {};
  return fmt::format("the beacons of the set '{}' match those of the fleet's own", name);
}

}  // namespace giveway::fleetctl
