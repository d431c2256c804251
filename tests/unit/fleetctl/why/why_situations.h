// Two vehicles that hear each other, to be corrupted one fact at a time.
#pragma once

#include <string>

#include "services/fleetctl/survey/why_situation.h"
#include "services/qos/xml_tree.h"

namespace giveway::fleetctl {

// A set with a beacon and a participant; `participant`, `writer` and `reader` go into its elements.
inline qos::ProfileSet SetWith(const std::string& participant = "", const std::string& writer = "",
                               const std::string& reader = "", bool shared_memory = false) {
  const std::string text =
      "<dds><profiles><transport_descriptors>"
      "<transport_descriptor><transport_id>udp</transport_id><type>UDPv4</type>"
      "</transport_descriptor>"
      "<transport_descriptor><transport_id>shm</transport_id><type>SHM</type>"
      "</transport_descriptor></transport_descriptors>"
      "<participant profile_name=\"giveway_participant\"><rtps><userTransports>"
      "<transport_id>udp</transport_id>" +
      std::string(shared_memory ? "<transport_id>shm</transport_id>" : "") + "</userTransports>" +
      participant +
      "</rtps></participant>\n"
      "<data_writer profile_name=\"fleet_beacon_writer\">" +
      writer + "</data_writer>\n<data_reader profile_name=\"fleet_beacon_reader\">" + reader +
      "</data_reader></profiles></dds>";
  return qos::ReadProfiles(*qos::ReadXml(text, "set.xml").root, "set.xml");
}

constexpr std::uint32_t kLoopbackAddress = 0x7f000001;
constexpr std::uint32_t kEthernetAddress = 0xc0000202;  // 192.0.2.2

inline ProcessSituation Vehicle(std::uint32_t id) {
  ProcessSituation situation;
  situation.pid = static_cast<int>(100 + id);
  situation.pid_inside = situation.pid;
  situation.launch.id = VehicleId{id};
  situation.launch.domain = 7;
  situation.profiles = SetWith();
  situation.state = 'S';
  situation.network_namespace = 4026531840;
  situation.mount_namespace = 4026531841;
  situation.shared_memory = FileIdentity{22, 1};
  situation.addresses = {
      {{"lo", kLoopbackAddress, 0xff000000}, {"eth0", kEthernetAddress, 0xffffff00}}};
  // Discovery by multicast, discovery and data of this participant.
  const auto first = static_cast<std::uint16_t>(7400 + 250 * 7);
  const auto own = static_cast<std::uint16_t>(first + 10 + 2 * id);
  situation.ports = {{first, own, static_cast<std::uint16_t>(own + 1)}};
  situation.open_files = 30;
  situation.open_files_limit = 1024;
  return situation;
}

}  // namespace giveway::fleetctl
