#include "services/fleetctl/soak/host_faults/discovery_servers.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "services/config/config_dir.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/file_descriptor.h"
#include "services/fleetctl/soak/host_faults/ipv4_address.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kProgram = "fast-discovery-server";

// Where a shell would find it; empty if nowhere.
std::string FindProgram() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = (std::filesystem::path(folder) / kProgram).string();
    if (::access(program.c_str(), X_OK) == 0) return program;
  }
  return {};
}

// Those of a deployment's servers.
std::string ProfileFile() { return ConfigDir() + "/deploy/discovery_server.xml"; }

// 0 port: the kernel chooses one that is free.
bool Bind(int socket, in_addr address, sockaddr_in* bound) {
  *bound = {};
  bound->sin_family = AF_INET;
  bound->sin_addr = address;
  socklen_t length = sizeof *bound;
  auto* const any = reinterpret_cast<sockaddr*>(bound);
  return ::bind(socket, any, length) == 0 && ::getsockname(socket, any, &length) == 0;
}

}  // namespace

std::string WhyNoDiscoveryServers(const std::string& interface) {
  if (!Ipv4AddressOf(interface)) {
    return fmt::format(
        "discovery servers listen on an IPv4 address, and '{}' is none: give --interface one",
        interface);
  }
  if (FindProgram().empty()) {
    return fmt::format("there is no {} in PATH: install Debian's fastdds-tools", kProgram);
  }
  if (::access(ProfileFile().c_str(), R_OK) != 0) {
    return fmt::format(
        "cannot read {}, the profiles of a server: GIVEWAY_CONFIG_DIR needs a copy of "
        "config/deploy",
        ProfileFile());
  }
  return {};
}

std::vector<DiscoveryServer> FreeServerAddresses(std::uint32_t count,
                                                 const std::string& interface) {
  const in_addr address = Ipv4AddressOf(interface).value_or(in_addr{});
  std::vector<FileDescriptor> sockets;  // all open until the last has its port: no port twice
  std::vector<DiscoveryServer> servers;
  for (std::uint32_t i = 0; i < count; ++i) {
    sockets.emplace_back(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in bound{};
    if (!Bind(sockets.back().Get(), address, &bound)) {
      throw StartError(fmt::format("a discovery server cannot listen on {}: {}", interface,
                                   std::strerror(errno)));
    }
    servers.push_back({interface, ntohs(bound.sin_port)});
  }
  return servers;
}

std::vector<MemberCommand> ServerCommands(const std::vector<DiscoveryServer>& addresses,
                                          const std::string& logs_folder) {
  const std::string program = FindProgram();
  const std::string profiles = ProfileFile();
  std::vector<MemberCommand> commands;
  for (std::uint32_t i = 0; i < addresses.size(); ++i) {
    const MemberId member{MemberKind::kDiscoveryServer, i + 1};
    // With the profiles of a deployment's: over UDP alone, so that no full /dev/shm ends it. The
    // place in the clients' list is the number that 2.9.1 knows a server by.
    ChildCommand child{NameOf(member),
                       {program, "-x", profiles, "-i", std::to_string(i), "-l", addresses[i].host,
                        "-p", std::to_string(addresses[i].port)}};
    const std::string log = fmt::format("discovery-server-{}.log", i + 1);
    child.log_file = (std::filesystem::path(logs_folder) / log).string();
    commands.push_back({member, std::move(child)});
  }
  return commands;
}

}  // namespace giveway::fleetctl
