// A process that asks for places it does not want: so many requests to join, each of a session of
// its own, spread evenly over so many seconds, from ten participants: the library's writer gets
// slow with thousands of instances. For tests/bench/comings_and_goings.sh.
//   join_flood DOMAIN REQUESTS SECONDS QOS_FILE
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "services/link/fastdds/profile_file.h"
#include "services/link/vehicle_link.h"

int main(int argc, char** argv) {
  using std::chrono::steady_clock;
  if (argc != 5) return 2;
  giveway::link::LinkOptions options;
  options.domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
  options.qos = giveway::link::ReadProfileFile(argv[4]);
  const auto requests = static_cast<std::uint32_t>(std::atoi(argv[2]));
  const std::chrono::duration<double> all(std::atof(argv[3]));
  std::vector<std::unique_ptr<giveway::link::VehicleLink>> links;
  for (int i = 0; i < 10; ++i) {
    links.push_back(std::make_unique<giveway::link::VehicleLink>(options));
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));  // to be found
  const auto begin = steady_clock::now();
  for (std::uint32_t i = 0; i < requests; ++i) {
    std::this_thread::sleep_until(
        begin + std::chrono::duration_cast<steady_clock::duration>(all * i / requests));
    links[i % links.size()]->SendJoin({.session = {0xf100d, i, i, 1}});
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));
  std::printf("%u requests in %.1f s\n", requests,
              std::chrono::duration<double>(steady_clock::now() - begin).count() - 2);
}
