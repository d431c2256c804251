// attacker: an intruder without credentials, on the fleet's network. Captures what the fleet says,
// and sends one attack at it. Prints how many packets it sent. For tests/attack/attack.sh and by
// hand, in a network namespace of its own.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <thread>

#include "tests/attack/attacks.h"

namespace giveway::attack {
namespace {

struct Options {
  std::string attack;
  std::uint32_t domain = 1;
  std::string interface = "lo";
  std::string address = "127.0.0.1";  // of the fleet's participants
  std::string source = "127.0.0.1";   // by which multicasts leave
  double seconds = 3;
  double rate_hz = 2000;
  std::uint64_t seed = 1;
  bool captures = true;
};

// Only joins the fleet's group on an interface, as any program of the machine may, and waits.
void JoinAndWait(const Options& options) {
  const int joined = socket(AF_INET, SOCK_DGRAM, 0);
  ip_mreq group{AddressOf("239.255.0.1"), AddressOf(options.source)};
  if (setsockopt(joined, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0) {
    throw std::runtime_error("cannot join 239.255.0.1 on " + options.source);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  close(joined);
}

int Run(const Options& options) {
  if (options.attack == "join") {
    JoinAndWait(options);
    return 0;
  }
  Target target{.domain = options.domain,
                .address = AddressOf(options.address),
                .captured = {},
                .time = std::chrono::milliseconds(static_cast<int>(1000 * options.seconds)),
                .seed = options.seed};
  if (options.captures) {
    const std::uint16_t first = MulticastPort(options.domain);
    target.captured = Capture(options.interface, first, static_cast<std::uint16_t>(first + 249),
                              4000, std::chrono::milliseconds(1200));
  }
  UdpSender sender(options.source, options.rate_hz);
  Attacks().at(options.attack)(target, &sender);
  std::printf("%s: captured %zu, sent %llu\n", options.attack.c_str(), target.captured.size(),
              static_cast<unsigned long long>(sender.Sent()));
  return sender.Sent() > 0 ? 0 : 1;
}

int Main(int argc, char** argv) {
  Options options;
  std::string names = "join";
  std::vector<std::string> known{"join"};
  for (const auto& [name, attack] : Attacks()) {
    names += ", " + name;
    known.push_back(name);
  }
  CLI::App app("Attacks a fleet. Exit code 0: sent; 1: nothing was sent; 2: could not run.");
  app.add_option("ATTACK", options.attack, names)->required()->check(CLI::IsMember(known));
  app.add_option("--domain", options.domain, "of the fleet")->check(CLI::Range(1, 99));
  app.add_option("--interface", options.interface, "what passes it is captured");
  app.add_option("--address", options.address, "of the fleet's participants");
  app.add_option("--source", options.source, "own address on the interface for multicasts");
  app.add_option("--seconds", options.seconds, "for how long");
  app.add_option("--rate", options.rate_hz, "packets a second");
  app.add_option("--seed", options.seed, "of what is random");
  app.add_flag("!--no-capture", options.captures, "goes by nothing heard");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return Run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "attacker: %s\n", error.what());
    return 2;
  }
}

}  // namespace
}  // namespace giveway::attack

int main(int argc, char** argv) { return giveway::attack::Main(argc, argv); }
