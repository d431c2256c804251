#include "services/fleetctl/soak/host_faults/attackers.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/if_ether.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "services/fleetctl/process/file_descriptor.h"
#include "services/fleetctl/soak/host_faults/ipv4_address.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;

// The fault's end ends it; this is its own limit if that never comes.
constexpr double kLonger_s = 5;
constexpr std::string_view kProgress = "sent ";

const char* AttackOf(Kind kind) {
  switch (kind) {
    case Kind::kSpoofed:
      return "spoof";
    case Kind::kReplayed:
      return "replay";
    case Kind::kFlooded:
      return "flood";
    case Kind::kMalformed:
      return "malformed";
    default:
      return "";
  }
}

// The program's own count, from a line of its progress.
std::uint64_t SentBy(std::string_view line) {
  std::uint64_t sent = 0;
  if (!line.starts_with(kProgress)) return 0;
  std::from_chars(line.data() + kProgress.size(), line.data() + line.size(), sent);
  return sent;
}

}  // namespace

bool MayOpenPacketSocket() {
  return FileDescriptor(::socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))).IsOpen();
}

std::string WhyNoAttacker(const std::string& program, bool may_open_packet_socket) {
  if (program.empty()) {
    return "it takes --attacker PROGRAM: the intruder that is built with the tests "
           "(build/release/bin/attacker), and root, for its packet socket";
  }
  if (::access(program.c_str(), X_OK) != 0) {
    return fmt::format("--attacker {}: {}", program, std::strerror(errno));
  }
  return may_open_packet_socket ? ""
                                : "--attacker hears the fleet by a packet socket, which root may "
                                  "open and this user may not";
}

// Targets on this machine are reached through lo, whichever interface the fleet uses.
std::vector<std::string> AttackWords(const AttackerTools& tools, const faults::Fault& fault) {
  std::vector<std::string> words = {
      tools.program, AttackOf(fault.kind),
      "--domain",    std::to_string(tools.domain),
      "--interface", "lo",
      "--rate",      fmt::format("{}", fault.parameters.rate_hz.value_or(1)),
      "--seconds",   fmt::format("{}", fault.for_s + kLonger_s),
      "--progress"};
  if (Ipv4AddressOf(tools.interface)) words.insert(words.end(), {"--source", tools.interface});
  if (fault.target.what == faults::Target::What::kVehicle) {
    words.insert(words.end(), {"--vehicle", std::to_string(Number(fault.target.vehicle))});
  }
  return words;
}

void Attackers::Begin(const faults::Fault& fault) {
  if (faults::ActorOf(fault.kind) != faults::Actor::kAttacker) return;
  ChildCommand command;
  command.name = fmt::format("attacker of {}#{}", fault.rule, fault.nth);
  command.words = AttackWords(tools_, fault);
  auto process = std::make_unique<ChildProcess>(command);
  running_[&fault].process = std::move(process);
}

void Attackers::Turn() {
  for (auto& [fault, running] : running_) {
    running.process->Poll();
    if (running.process->IsRunning() || running.complained) continue;
    running.complained = true;
    const auto& said = running.process->LastLines();
    std::fprintf(
        stderr, "%s ended: %s%s%s\n", running.process->Name().c_str(),
        Describe(*running.process->End()).c_str(),
        said.empty() ? "" : "; the last it said: ", said.empty() ? "" : said.back().c_str());
  }
}

std::string Attackers::EffectOf(const faults::Fault& fault) const {
  const auto running = running_.find(&fault);
  if (running == running_.end() || fault.kind != Kind::kReplayed) return {};
  const auto& said = running->second.process->LastLines();
  const std::uint64_t sent = said.empty() ? 0 : SentBy(said.back());
  return sent == 0 ? "" : fmt::format("the attacker says that it sent {} packets", sent);
}

}  // namespace giveway::fleetctl
