// What a participant profile or a transport descriptor may hold.
#include "services/qos/schema.h"

namespace giveway::qos {
namespace {

using enum Content;

constexpr ElementRule Group(std::string_view name, std::span<const ElementRule> children) {
  return {name, kElements, children};
}
constexpr ElementRule List(std::string_view name, std::span<const ElementRule> children) {
  return {name, kElements, children, {}, false, true};
}
constexpr ElementRule Word(std::string_view name, std::string_view words) {
  return {name, kWord, {}, words};
}
constexpr ElementRule Many(std::string_view name, std::span<const ElementRule> children) {
  return {name, kElements, children, {}, true};
}

constexpr ElementRule kUdpLocator[] = {{"port", kUnsigned}, {"address", kText}};
constexpr ElementRule kTcp4Locator[] = {{"physical_port", kUnsigned},
                                        {"port", kUnsigned},
                                        {"address", kText},
                                        {"unique_lan_id", kText},
                                        {"wan_address", kText}};
constexpr ElementRule kTcp6Locator[] = {
    {"physical_port", kUnsigned}, {"port", kUnsigned}, {"address", kText}};
constexpr ElementRule kLocator[] = {Group("udpv4", kUdpLocator), Group("udpv6", kUdpLocator),
                                    Group("tcpv4", kTcp4Locator), Group("tcpv6", kTcp6Locator)};
constexpr ElementRule kLocators[] = {Many("locator", kLocator)};

constexpr ElementRule kSimpleEdp[] = {{"PUBWRITER_SUBREADER", kFlag},
                                      {"PUBREADER_SUBWRITER", kFlag}};
constexpr ElementRule kInitial[] = {{"count", kUnsigned}, {"period", kDuration}};
constexpr ElementRule kServer[] = {List("metatrafficUnicastLocatorList", kLocators),
                                   List("metatrafficMulticastLocatorList", kLocators)};
constexpr ElementRule kServers[] = {Many("RemoteServer", kServer)};
constexpr ElementRule kDiscovery[] = {
    Word("discoveryProtocol", "NONE SIMPLE CLIENT SERVER BACKUP SUPER_CLIENT"),
    {"ignoreParticipantFlags", kText},
    Word("EDP", "SIMPLE STATIC"),
    Group("simpleEDP", kSimpleEdp),
    {"leaseDuration", kDuration},
    {"leaseAnnouncement", kDuration},
    Group("initialAnnouncements", kInitial),
    {"clientAnnouncementPeriod", kDuration},
    List("discoveryServersList", kServers),
    {"staticEndpointXMLFilename", kDoor},
    {"static_edp_xml_config", kDoor, {}, {}, true},
};

constexpr std::string_view kMemory =
    "PREALLOCATED PREALLOCATED_WITH_REALLOC DYNAMIC "
    "DYNAMIC_REUSABLE";
constexpr ElementRule kBuiltin[] = {
    Group("discovery_config", kDiscovery),
    {"avoid_builtin_multicast", kFlag},
    {"use_WriterLivelinessProtocol", kFlag},
    {"metatraffic_external_unicast_locators", kOpaque},
    List("metatrafficUnicastLocatorList", kLocators),
    List("metatrafficMulticastLocatorList", kLocators),
    List("initialPeersList", kLocators),
    Word("readerHistoryMemoryPolicy", kMemory),
    Word("writerHistoryMemoryPolicy", kMemory),
    {"readerPayloadSize", kUnsigned},
    {"writerPayloadSize", kUnsigned},
    {"mutation_tries", kUnsigned},
};
constexpr ElementRule kPorts[] = {
    {"portBase", kPort}, {"domainIDGain", kPort}, {"participantIDGain", kPort}, {"offsetd0", kPort},
    {"offsetd1", kPort}, {"offsetd2", kPort},     {"offsetd3", kPort}};
constexpr ElementRule kThroughput[] = {{"bytesPerPeriod", kUnsigned},
                                       {"periodMillisecs", kUnsigned}};
constexpr ElementRule kUserTransports[] = {{"transport_id", kText, {}, {}, true}};
constexpr ElementRule kRtps[] = {
    {"name", kText},
    {"allocation", kOpaque},
    {"prefix", kText},
    List("defaultUnicastLocatorList", kLocators),
    {"default_external_unicast_locators", kOpaque},
    List("defaultMulticastLocatorList", kLocators),
    {"ignore_non_matching_locators", kFlag},
    {"sendSocketBufferSize", kUnsigned},
    {"listenSocketBufferSize", kUnsigned},
    Group("builtin", kBuiltin),
    Group("port", kPorts),
    {"participantID", kInteger},
    {"throughputController", kElements, kThroughput, {}, false, false, true},
    Group("userTransports", kUserTransports),
    {"useBuiltinTransports", kFlag},
    {"propertiesPolicy", kDoor},
    {"userData", kOpaque},
};
constexpr ElementRule kParticipant[] = {{"domainId", kUnsigned}, Group("rtps", kRtps)};

constexpr ElementRule kWhitelist[] = {{"address", kText, {}, {}, true}};
constexpr ElementRule kListening[] = {{"port", kPort, {}, {}, true}};
constexpr ElementRule kUdp[] = {
    {"transport_id", kText},
    Word("type", "UDPv4 UDPv6"),
    {"sendBufferSize", kUnsigned},
    {"receiveBufferSize", kUnsigned},
    {"TTL", kByte},
    {"non_blocking_send", kFlag},
    {"maxMessageSize", kUnsigned},
    {"maxInitialPeersRange", kUnsigned},
    Group("interfaceWhiteList", kWhitelist),
    {"output_port", kPort},
};
constexpr ElementRule kSharedMemory[] = {
    {"transport_id", kText},
    Word("type", "SHM"),
    {"maxMessageSize", kUnsigned},
    {"maxInitialPeersRange", kUnsigned},
    {"segment_size", kUnsigned},
    {"port_queue_capacity", kUnsigned},
    {"healthy_check_timeout_ms", kUnsigned},
    {"rtps_dump_file", kDoor},
};
constexpr ElementRule kTcp[] = {
    {"transport_id", kText},
    Word("type", "TCPv4 TCPv6"),
    {"sendBufferSize", kUnsigned},
    {"receiveBufferSize", kUnsigned},
    {"TTL", kByte},
    {"maxMessageSize", kUnsigned},
    {"maxInitialPeersRange", kUnsigned},
    Group("interfaceWhiteList", kWhitelist),
    {"wan_addr", kText},
    {"keep_alive_frequency_ms", kUnsigned},
    {"keep_alive_timeout_ms", kUnsigned},
    {"max_logical_port", kPort},
    {"logical_port_range", kPort},
    {"logical_port_increment", kPort},
    {"enable_tcp_nodelay", kFlag},
    {"metadata_logical_port", kPort},
    Group("listening_ports", kListening),
    {"tls", kOpaque},
    {"calculate_crc", kFlag},
    {"check_crc", kFlag},
};

}  // namespace

std::span<const ElementRule> ParticipantElements() { return kParticipant; }
std::span<const ElementRule> TransportElements(std::string_view type) {
  if (type.starts_with("SHM")) return kSharedMemory;
  if (type.starts_with("TCP")) return kTcp;
  return kUdp;
}

}  // namespace giveway::qos
