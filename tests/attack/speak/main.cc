// speak_attacker ATTACK DOMAIN QOS_FILE [TARGET [MILLISECONDS]]: an intruder on a fleet, for the
// tests. Exit code: 0 it did what it was asked to, 1 it could not.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/attack/speak/attacks.h"

int main(int argc, char** argv) {
  using namespace giveway;
  const auto attack = argc < 4 ? attack::Attacks().end() : attack::Attacks().find(argv[1]);
  if (attack == attack::Attacks().end()) {
    std::fputs("usage: speak_attacker ATTACK DOMAIN QOS_FILE [TARGET [MILLISECONDS]]\n", stderr);
    for (const auto& [name, does] : attack::Attacks()) std::fprintf(stderr, "  %s\n", name.c_str());
    return 1;
  }
  attack::Orders orders;
  orders.domain = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
  orders.qos_file = argv[3];
  if (argc > 4) {
    orders.target = VehicleId{static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 10))};
  }
  if (argc > 5) orders.duration = attack::milliseconds(std::strtol(argv[5], nullptr, 10));
  try {
    attack->second(orders);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
    return 1;
  }
}
