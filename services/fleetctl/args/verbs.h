// The verbs of the command line, one file each. A verb adds itself, and sets the exit code when it
// has run. It throws what it cannot do (LinkError, InputError, OutputError, DomainError): main
// reports it and exits with kCouldNotRun.
#pragma once

#include <CLI/CLI.hpp>

namespace giveway::fleetctl {

void AddCampaignVerb(CLI::App* fleetctl, int* exit_code);
void AddDoctorVerb(CLI::App* fleetctl, int* exit_code);
void AddExportVerb(CLI::App* fleetctl, int* exit_code);
void AddFaultsVerb(CLI::App* fleetctl, int* exit_code);
void AddListenVerb(CLI::App* fleetctl, int* exit_code);
void AddLsVerb(CLI::App* fleetctl, int* exit_code);
void AddPlanVerb(CLI::App* fleetctl, int* exit_code);
void AddQosApply(CLI::App* qos, int* exit_code);  // of the verb qos
void AddQosTune(CLI::App* qos, int* exit_code);   // of the verb qos
void AddQosVerb(CLI::App* fleetctl, int* exit_code);
void AddRecordVerb(CLI::App* fleetctl, int* exit_code);
void AddReplayVerb(CLI::App* fleetctl, int* exit_code);
void AddReportVerb(CLI::App* fleetctl, int* exit_code);
void AddRunVerb(CLI::App* fleetctl, int* exit_code);
void AddShrinkVerb(CLI::App* fleetctl, int* exit_code);
void AddSoakVerb(CLI::App* fleetctl, int* exit_code);
void AddStopwatchVerb(CLI::App* fleetctl, int* exit_code);
void AddTopVerb(CLI::App* fleetctl, int* exit_code);
void AddVirtualVerb(CLI::App* fleetctl, int* exit_code);
void AddWhyVerb(CLI::App* fleetctl, int* exit_code);

}  // namespace giveway::fleetctl
