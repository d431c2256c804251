// What is wrong with a host that runs a fleet or is going to. Pure: facts in, findings out; each
// rule adds its own findings and depends on no other rule.
#pragma once

#include "services/fleetctl/doctor/doctor_facts.h"
#include "services/qos/finding.h"

namespace giveway::fleetctl {

// Of /dev/shm: unused files, other users' files, free space.
void CheckMemoryFiles(const HostFacts& host, qos::Findings* findings);
void CheckForeignFiles(const HostFacts& host, qos::Findings* findings);
void CheckMemoryRoom(const HostFacts& host, qos::Findings* findings);
// Of pairs of live processes: one host and two memories, one memory and two hosts.
void CheckMemoryShared(const HostFacts& host, qos::Findings* findings);
void CheckHostIds(const HostFacts& host, qos::Findings* findings);

void CheckMulticast(const HostFacts& host, qos::Findings* findings);
void CheckReceiveBuffer(const HostFacts& host, qos::Findings* findings);
void CheckPorts(const HostFacts& host, qos::Findings* findings);
void CheckEphemeralPorts(const HostFacts& host, qos::Findings* findings);

void CheckSurroundings(const HostFacts& host, qos::Findings* findings);
void CheckClock(const HostFacts& host, qos::Findings* findings);
void CheckDescriptors(const HostFacts& host, qos::Findings* findings);

// All of them, errors first.
qos::Findings Examine(const HostFacts& host);

}  // namespace giveway::fleetctl
