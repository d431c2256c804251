// A profile file as values: what every profile means, with the default of the library filled in
// where the file is silent, and where each value comes from.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/qos/finding.h"
#include "services/qos/policy.h"
#include "services/qos/xml_tree.h"

namespace giveway::qos {

struct Value {
  std::int64_t number = 0;
  Place place;         // line 0: the file does not say
  bool given = false;  // by the file; else the library's default

  bool operator==(const Value&) const = default;
};

struct Profile {
  Owner owner = Owner::kParticipant;
  std::string name;
  Place place;
  std::array<Value, kPolicyCount> values;  // by Index(policy)
  std::vector<std::string> partitions;     // as the profile says; code sets the real ones
  Place partition_place;

  bool operator==(const Profile&) const = default;
  const Value& operator[](Policy policy) const { return values[Index(policy)]; }
  std::int64_t Number(Policy policy) const { return values[Index(policy)].number; }
};

// A profile in which the file is silent about everything.
Profile DefaultProfile(Owner owner, const std::string& name);

struct Transport {
  std::string id;
  std::string type;  // "UDPv4", "SHM", ...
  Place place;
  std::map<std::string, Value> numbers;  // by element name, where the file says

  bool operator==(const Transport&) const = default;
};

struct DiscoveryServer {
  std::string prefix;   // as written; what clients know it by
  std::string address;  // "10.0.0.1:11811", or several
  Place place;

  bool operator==(const DiscoveryServer&) const = default;
};

// What of a participant is no single number.
struct Participation {
  std::string profile;
  std::vector<std::pair<std::string, Place>> transports;  // ids it names
  std::string ignore_flags;
  Place ignore_place;
  std::vector<DiscoveryServer> servers;
  std::string prefix;
  bool static_discovery = false;
  Place static_place;
  std::size_t peers_without_port = 0;
  Place peers_place;
  std::map<std::string, Place> limits;  // elements that slow it down, or that code overrides

  bool operator==(const Participation&) const = default;
};

// Of world, vehicles and observers alike.
inline constexpr std::string_view kParticipantProfile = "giveway_participant";

struct ProfileSet {
  std::string file;
  std::vector<Profile> profiles;  // in the order of the file
  std::vector<Transport> transports;
  std::vector<Participation> participations;  // one a participant profile
  std::string intraprocess = "FULL";          // the library's default
  Place intraprocess_place;

  bool operator==(const ProfileSet&) const = default;
  // Null if there is none.
  const Profile* Find(Owner owner, std::string_view name) const;
  const Transport* FindTransport(std::string_view id) const;
  // How kParticipantProfile takes part; null if there is none.
  const Participation* OurParticipation() const;
};

// Whether that profile names a transport through shared memory.
bool UsesSharedMemory(const ProfileSet& set);

// The <profiles> that the library reads, of a root that is it or holds it: the first. Null if there
// is none.
const XmlElement* ProfilesOf(const XmlElement& root);

// Takes what can be understood; what cannot is left out, and is a finding of CheckSchema.
ProfileSet ReadProfiles(const XmlElement& root, const std::string& file);

}  // namespace giveway::qos
