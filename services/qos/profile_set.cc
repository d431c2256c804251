#include "services/qos/profile_set.h"

#include <algorithm>
#include <optional>

#include "services/qos/xml_value.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kLargestCount = 0x7fff'ffff;

std::optional<Owner> OwnerOf(std::string_view element) {
  if (element == "participant") return Owner::kParticipant;
  if (element == "data_writer" || element == "publisher") return Owner::kWriter;
  if (element == "data_reader" || element == "subscriber") return Owner::kReader;
  return std::nullopt;
}

std::optional<std::int64_t> Parse(const XmlElement& element, const PolicyInfo& info) {
  switch (info.shape) {
    case Shape::kWord: {
      const std::int64_t index = WordIndex(info.words, element.text);
      return index < 0 ? std::nullopt : std::optional(index);
    }
    case Shape::kDuration:
      return ReadDuration(element);
    case Shape::kFlag:
      return ReadFlag(element.text);
    case Shape::kCount:
      break;
  }
  const auto number =
      ReadNumber(element.text, info.is_unsigned ? NumberKind::kUnsigned : NumberKind::kSigned);
  if (!number) return std::nullopt;
  // A product of two must fit our arithmetic.
  return std::clamp(number->value, -kLargestCount, kLargestCount);
}

class Reader {
 public:
  Reader(const XmlElement& root, const std::string& file) : root_(root) { set_.file = file; }

  ProfileSet Read() {
    if (const XmlElement* profiles = ProfilesOf(root_)) ReadProfilesIn(*profiles);
    if (const auto* delivery = root_.Descendant("library_settings/intraprocess_delivery")) {
      set_.intraprocess = delivery->text;
      set_.intraprocess_place = At(*delivery);
    }
    return std::move(set_);
  }

 private:
  Place At(const XmlElement& element) const { return {set_.file, element.line}; }
  void ReadProfilesIn(const XmlElement& profiles);
  void ReadTransport(const XmlElement& descriptor);
  Profile ReadProfile(const XmlElement& element, Owner owner) const;
  Participation ReadParticipation(const XmlElement& element) const;
  DiscoveryServer ReadServer(const XmlElement& element) const;
  void ReadDiscovery(const XmlElement& rtps, Participation* to) const;

  const XmlElement& root_;
  ProfileSet set_;
};

void Reader::ReadTransport(const XmlElement& descriptor) {
  Transport transport;
  transport.place = At(descriptor);
  for (const XmlElement& child : descriptor.children) {
    if (child.name == "transport_id") transport.id = child.text;
    if (child.name == "type") transport.type = child.text;
    if (const auto number = ReadNumber(child.text, NumberKind::kUnsigned)) {
      transport.numbers[child.name] = {number->value, At(child), true};
    } else if (child.name == "interfaceWhiteList") {
      transport.numbers[child.name] = {1, At(child), true};
    }
  }
  set_.transports.push_back(std::move(transport));
}

Profile Reader::ReadProfile(const XmlElement& element, Owner owner) const {
  Profile profile = DefaultProfile(owner, element.Attribute("profile_name"));
  profile.place = At(element);
  for (const PolicyInfo& info : Policies()) {
    if (!Has(owner, info)) continue;
    const XmlElement* said = element.Descendant(info.path);
    if (said == nullptr) continue;
    if (const auto number = Parse(*said, info)) {
      profile.values[Index(info.policy)] = {*number, At(*said), true};
    }
  }
  if (const XmlElement* names = element.Descendant("qos/partition/names")) {
    profile.partition_place = At(*names);
    for (const XmlElement& name : names->children) profile.partitions.push_back(name.text);
  }
  return profile;
}

DiscoveryServer Reader::ReadServer(const XmlElement& element) const {
  DiscoveryServer server{element.Attribute("prefix"), "", At(element)};
  const XmlElement* const locators = element.Child("metatrafficUnicastLocatorList");
  if (locators == nullptr) return server;
  for (const XmlElement& locator : locators->children) {
    for (const XmlElement& by_transport : locator.children) {
      const XmlElement* const address = by_transport.Child("address");
      const XmlElement* const port = by_transport.Child("port");
      if (address == nullptr || port == nullptr) continue;
      server.address += (server.address.empty() ? "" : " ") + address->text + ":" + port->text;
    }
  }
  return server;
}

void Reader::ReadDiscovery(const XmlElement& rtps, Participation* to) const {
  const XmlElement* config = rtps.Descendant("builtin/discovery_config");
  if (config == nullptr) return;
  if (const auto* flags = config->Child("ignoreParticipantFlags")) {
    to->ignore_flags = flags->text;
    to->ignore_place = At(*flags);
  }
  if (const auto* servers = config->Child("discoveryServersList")) {
    for (const XmlElement& server : servers->children) to->servers.push_back(ReadServer(server));
  }
  if (const auto* edp = config->Child("EDP"); edp != nullptr && edp->text == "STATIC") {
    to->static_discovery = true;
    to->static_place = At(*edp);
  }
}

Participation Reader::ReadParticipation(const XmlElement& element) const {
  Participation to;
  to.profile = element.Attribute("profile_name");
  const XmlElement* rtps = element.Child("rtps");
  if (rtps == nullptr) return to;
  if (const auto* transports = rtps->Child("userTransports")) {
    for (const XmlElement& id : transports->children) to.transports.emplace_back(id.text, At(id));
  }
  if (const auto* prefix = rtps->Child("prefix")) to.prefix = prefix->text;
  if (const auto* peers = rtps->Descendant("builtin/initialPeersList")) {
    to.peers_place = At(*peers);
    for (const XmlElement& locator : peers->children) {
      to.peers_without_port += locator.Descendant("udpv4/port") == nullptr ? 1 : 0;
    }
  }
  for (const char* name : {"throughputController", "name"}) {
    if (const auto* limit = rtps->Child(name)) to.limits[name] = At(*limit);
  }
  if (const auto* domain = element.Child("domainId")) to.limits["domainId"] = At(*domain);
  ReadDiscovery(*rtps, &to);
  return to;
}

void Reader::ReadProfilesIn(const XmlElement& profiles) {
  for (const XmlElement& child : profiles.children) {
    if (child.name == "transport_descriptors") {
      for (const XmlElement& descriptor : child.children) ReadTransport(descriptor);
    }
    const auto owner = OwnerOf(child.name);
    if (!owner) continue;
    set_.profiles.push_back(ReadProfile(child, *owner));
    if (*owner == Owner::kParticipant) set_.participations.push_back(ReadParticipation(child));
  }
}

}  // namespace

Profile DefaultProfile(Owner owner, const std::string& name) {
  Profile profile;
  profile.owner = owner;
  profile.name = name;
  for (const PolicyInfo& info : Policies()) {
    profile.values[Index(info.policy)].number = Default(owner, info);
  }
  return profile;
}

const Profile* ProfileSet::Find(Owner owner, std::string_view name) const {
  const auto found = std::ranges::find_if(profiles, [&](const Profile& profile) {
    return profile.owner == owner && profile.name == name;
  });
  return found == profiles.end() ? nullptr : &*found;
}

const Transport* ProfileSet::FindTransport(std::string_view id) const {
  const auto found = std::ranges::find(transports, id, &Transport::id);
  return found == transports.end() ? nullptr : &*found;
}

const Participation* ProfileSet::OurParticipation() const {
  const auto ours = std::ranges::find(participations, kParticipantProfile, &Participation::profile);
  return ours == participations.end() ? nullptr : &*ours;
}

bool UsesSharedMemory(const ProfileSet& set) {
  const Participation* const ours = set.OurParticipation();
  return ours != nullptr && std::ranges::any_of(ours->transports, [&](const auto& named) {
           const Transport* const transport = set.FindTransport(named.first);
           return transport != nullptr && transport->type == "SHM";
         });
}

const XmlElement* ProfilesOf(const XmlElement& root) {
  return root.name == "profiles" ? &root : root.FirstChild("profiles");
}

ProfileSet ReadProfiles(const XmlElement& root, const std::string& file) {
  return Reader(root, file).Read();
}

}  // namespace giveway::qos
