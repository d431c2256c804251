// Linear fits to what tests/bench/fleet_costs.sh measured of fleets of 2, 8, 16 and 32 vehicles:
// config/qos/default.xml, Fast DDS 2.9.1 over loopback, 20 ticks a second, all receive all, two
// cores of a virtual machine, nothing else running. Processor time differs by 10 % between two
// runs, and by core speed between machines. Fast DDS 3.1.2 has more threads; its memory, sockets,
// descriptors and packets were within 4 % of these, its processor time was not measured on an idle
// machine.
#pragma once

namespace giveway::fleetctl {

struct Costs {
  double ticks_per_s = 20;

  // Processor time, ms a second: of a process without peers, and for each peer it receives.
  double vehicle_cpu = 9.6;
  double vehicle_cpu_a_peer = 0.45;
  double world_cpu = 9.5;
  double world_cpu_a_vehicle = 0.87;
  double observer_cpu = 12;
  double observer_cpu_a_vehicle = 0.95;

  // MiB of private memory.
  double vehicle_mib = 19.15;
  double vehicle_mib_a_peer = 0.043;
  double world_mib = 6.0;
  double world_mib_a_vehicle = 0.085;
  double observer_mib = 8.0;
  double observer_mib_a_vehicle = 0.095;

  double threads = 7;
  double sockets = 5;  // UDP
  double descriptors = 12;

  // Packets a second of a vehicle and of the world to it, in addition to beacons and announcements.
  double packets_a_vehicle = 113.5;
  double bytes_a_packet = 360;
  // During discovery: for each ordered pair of vehicles.
  double discovery_packets_a_pair = 60;
};

// Of processes linked with Fast DDS 2 or 3.
inline Costs CostsWith(int library_major) {
  Costs costs;
  if (library_major >= 3) costs.threads = 10;
  return costs;
}

}  // namespace giveway::fleetctl
