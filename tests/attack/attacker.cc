// attacker: an intruder without credentials, on the fleet's network. Captures what the fleet says,
// and sends one attack at it. Prints how many packets it sent. For tests/attack/attack.sh, for
// fleetctl soak --attacker, and by hand.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <optional>
#include <thread>

#include "tests/attack/attacks.h"

namespace giveway::attack {
namespace {

using std::chrono::milliseconds;

// What is captured, at once: of one vehicle ten beacons.
constexpr milliseconds kOfAll(1200);
constexpr milliseconds kOfOne(500);

struct Options {
  std::string attack;
  std::uint32_t domain = 1;
  std::string interface = "lo";
  std::string address = "127.0.0.1";  // of the fleet's participants
  std::string source = "127.0.0.1";   // by which multicasts leave
  double seconds = 3;
  double rate_hz = 2000;
  std::uint64_t seed = 1;
  std::uint32_t vehicle = 0;  // the one that is meant; 0: all
  bool captures = true;
  bool progress = false;
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

// Says five times a second how many packets were sent: of an attack that is killed nothing else is
// known.
class Progress {
 public:
  Progress(bool says, const UdpSender& sender) {
    if (!says) return;
    thread_ = std::jthread([&sender](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        std::this_thread::sleep_for(milliseconds(200));
        std::printf("sent %llu\n", static_cast<unsigned long long>(sender.Sent()));
        std::fflush(stdout);
      }
    });
  }

 private:
  std::jthread thread_;
};

// Once, or of one vehicle until enough is known of it, as long as the attack is to last.
void Hear(const Listener& listener, const Options& options, Target* target) {
  constexpr std::size_t kMost = 4000;
  const auto end = std::chrono::steady_clock::now() + target->time;
  target->listener = &listener;
  const auto time = options.vehicle == 0 ? kOfAll : kOfOne;
  do {
    target->captured = listener.Capture(kMost, time);
  } while (!KnowsEnough(options.attack, *target) && std::chrono::steady_clock::now() < end);
}

int Run(const Options& options) {
  if (options.attack == "join") {
    JoinAndWait(options);
    return 0;
  }
  Target target{.domain = options.domain,
                .address = AddressOf(options.address),
                .vehicle = options.vehicle,
                .time = milliseconds(static_cast<int>(1000 * options.seconds)),
                .seed = options.seed};
  std::optional<Listener> listener;
  if (options.captures) {
    const std::uint16_t first = MulticastPort(options.domain);
    listener.emplace(options.interface, first, static_cast<std::uint16_t>(first + 249));
    Hear(*listener, options, &target);
  }
  UdpSender sender(options.source, options.rate_hz);
  const Progress progress(options.progress, sender);
  Attacks().at(options.attack)(target, &sender);
  std::printf("%s: captured %zu, sent %llu\n", options.attack.c_str(), target.captured.size(),
              static_cast<unsigned long long>(sender.Sent()));
  return sender.Sent() > 0 ? 0 : 1;
}

void CheckVehicle(const Options& options) {
  if (options.vehicle != 0 && !TakesVehicle(options.attack)) {
    throw CLI::ValidationError("--vehicle", options.attack + " is sent at all");
  }
  if (options.attack == "spoof" && (options.vehicle == 0 || !options.captures)) {
    throw CLI::ValidationError("--vehicle", "spoof speaks as one, and goes by what it hears");
  }
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
  app.add_option(
      "--vehicle", options.vehicle,
      "flood, malformed: to that vehicle alone; replay: its beacons; spoof: as that one");
  app.add_option("--seed", options.seed, "of what is random");
  app.add_flag("!--no-capture", options.captures, "goes by nothing heard");
  app.add_flag("--progress", options.progress,
               "says five times a second how many packets were sent");
  try {
    app.parse(argc, argv);
    CheckVehicle(options);
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
