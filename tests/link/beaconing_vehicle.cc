// A vehicle process that only sends beacons, at 20 Hz, until it is killed or its parent dies.
//   beaconing_vehicle DOMAIN ID QOS_FILE
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "services/link/fastdds/profile_file.h"
#include "tests/link/fleet.h"

int main(int argc, char** argv) {
  const pid_t parent = getppid();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (argc != 4 || getppid() != parent) return 2;
  giveway::link::LinkOptions options;
  options.domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
  options.qos = giveway::link::ReadProfileFile(argv[3]);
  giveway::test::Beaconing vehicle(options,
                                   giveway::VehicleId{static_cast<std::uint32_t>(atoi(argv[2]))});
  while (true) {
    vehicle.Send();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}
