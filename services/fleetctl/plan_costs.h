// What tests/bench/fleet_costs.sh measured, as straight lines and one parabola through its rows:
// config/qos/default.xml, Fast DDS 2.9.1 over loopback, 20 ticks a second, everybody hears
// everybody, two cores of a virtual machine (Sapphire Rapids class). Processor times are of such a
// core; another one differs by its speed.
#pragma once

namespace giveway::fleetctl {

struct Costs {
  double ticks_per_s = 20;

  // Processor time, ms a second: of a process that hears nobody, and for each peer it hears.
  double vehicle_cpu = 11.5;
  double vehicle_cpu_a_peer = 1.0;
  double world_cpu = 10;
  double world_cpu_a_vehicle = 1.6;
  double observer_cpu_a_vehicle = 1.0;

  // MiB that a process shares with nobody.
  double vehicle_mib = 19;
  double vehicle_mib_a_peer = 0.04;
  double world_mib = 5.8;
  double world_mib_a_vehicle = 0.09;

  double threads = 7;
  double sockets = 5;  // UDP
  double descriptors = 12;

  // Packets a second: of a beacon to each peer one; the rest of what a vehicle says and is told.
  double packets_a_vehicle = 104;
  double bytes_a_packet = 357;
  // Until everybody has found everybody: for each ordered pair of vehicles.
  double discovery_packets_a_pair = 60;
};

}  // namespace giveway::fleetctl
