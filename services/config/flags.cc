#include "services/config/flags.h"

#include <chrono>
#include <cstdio>

#include "services/config/byte_size.h"
#include "services/config/flag_values.h"
#include "services/config/help/command_line.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/text_file.h"
#include "services/runtime/restart.h"

namespace giveway {
namespace {

constexpr int kUsageError = 2;
enum class Service { kVehicle, kWorld };

constexpr const char* kFooter = R"(
Every flag has a twin in the environment: --log-level is also GIVEWAY_LOG_LEVEL. The flag wins; an
empty variable counts as unset. GIVEWAY_CONFIG_DIR names the folder with qos/ and scenarios/.

Exit code: 0 the run is over (of the world: passed), or it was stopped by SIGTERM or SIGINT; 1 the
run failed (world), or the network interface was replaced by another; 2 a flag, a file or
the network was not usable, or the world refused the vehicle: stderr says which; 70 the control loop
hung, and the watchdog ended it; 130 or 143 it had not left a second after SIGINT or SIGTERM, or a
second signal came.
)";

void AddFlags(Service service, CommandLine* line) {
  line->Add("--scenario", "FILE|NAME", "scenario file, or the name of a shipped one (required)");
  line->Add("--domain", "1..99", "DDS domain (required)");
  line->Add("--interface", "NAME|ADDRESS|any", "network interface (default 127.0.0.1)");
  line->Add("--discovery-server", "HOST[:PORT],...",
            "find all participants through these servers, and not by what --qos says; "
            "the first has the id 0, the next 1 (port 11811)");
  line->Add(
      "--qos", "SET|FILE",
      "complete Fast DDS XML profiles: a file, or the name of a shipped set (default: default)");
  if (service == Service::kVehicle) {
    line->Add("--id", "1..4294967295", "id to ask the world for (default: any free one)");
    line->Add("--record", "FILE",
              "record all inputs and outputs of the brain, for fleetctl replay; where FILE "
              "exists, into the first free of FILE with a number");
    line->Add("--record-split", "SIZE", "start another file of the recording at this size: 64MiB");
    line->Add("--record-ring", "SECONDS",
              "keep only the last so many seconds of the recording, in two files: 60");
    line->Add("--impair", "RULES",
              "impairs what it receives, in place of the scenario's rules: loss=0.1,delay=20ms, or "
              "none, or @FILE; link/impairment/README.md lists the keys");
    line->Add(
        "--impair-since", "SECONDS",
        "internal: what the times of its rules count from, on the steady clock; set by a soak\n"
        "that restarts it");
    line->AddSwitch("--stay", "when the run has ended, halt and ask the next world for a place");
    line->AddSwitch("--partition-free",
                    "publishes beacons without a partition, too, for foreign tools");
    line->AddSwitch("--hang-on-signal",
                    "a drill: SIGUSR1 makes the control loop hang, SIGUSR2 makes it resume");
    line->AddSwitch("--no-watchdog", "a drill: a control loop that hangs does not end the process");
  } else {
    line->Add("--threads", "1..256", "threads that share the work of a tick (default 1)");
    line->Add("--checkpoint", "FILE", "resume from there after a crash, and keep it up to date");
    line->Add("--faults", "FILE",
              "carries out the world's faults of this list: ultrasonics, motors, encoders and "
              "pose fixes; fleetctl faults expand writes one");
  }
  line->Add("--leave-out", "shared_memory",
            "does without this transport of the set; a service whose shared memory was deleted,\n"
            "or is full, restarts itself so");
  line->Add("--try-qos", "FILE",
            "create every endpoint of this set once, report whether that succeeds, and exit");
  line->Add("--resume", "FILE",
            "internal, as the next ones: set by a service for itself when an order "
            "restarts it");
  line->Add("--former-qos", "FILE", "the set it had before");
  line->Add("--rolled-back", "TEXT", "why it restarted with that");
  line->Add("--memory-lost", "TEXT", "why it restarted without shared memory");
  if (service == Service::kWorld) line->Add("--go-on-from", "FILE", "the run as it was");
  line->Add("--seed", "0..4294967295", "moves start poses and cruise speeds; 0 moves nothing");
  line->Add("--behaviour", "NAME",
            "cooperative, lecture_avoid, stock_avoid, lecture_yield, or "
            "lecture_printed, which shows the flaws of the printed scripts: it collides");
  line->Add("--duration", "TIME",
            "end after this time instead of the scenario's: 90, 90s or 30m, at most a day");
  line->Add("--admin-key", "FILE",
            "takes orders (fleetctl qos apply) sealed with the key in this file:\n"
            "openssl rand -hex 32 > FILE makes one. Without it no order is taken");
  line->AddSwitch("--admin", "takes orders without a key, from any participant that reaches it");
  line->AddSwitch("--lockstep", "the world waits for every command of a tick");
  line->Add("--health-port", "0..65535",
            "serves /livez, /readyz, /metrics; 0, the default: not served");
  line->Add("--health-address", "ADDRESS", "address of that port (default 127.0.0.1)");
  line->AddOptional("--health", "live|ready|metrics",
                    "asks the service at --health-port, prints the answer, and exits: "
                    "0 yes, 1 no, 2 no answer (ready if no value follows)");
  line->Add("--log-format", "text|json", "format of the log lines on stderr (default text)");
  line->Add("--log-level", "LEVEL", "debug, info, warning or error (default info)");
}

std::optional<Impairment> ReadImpairment(FlagValues* values) {
  constexpr double kMost_s = 1e9;
  const auto text = values->Text("--impair");
  const auto since_s = values->Number("--impair-since", {0, kMost_s, "s"});
  if (!text) return std::nullopt;
  ParsedImpairment parsed = ParseImpairment(*text);
  for (ImpairTextProblem& problem : parsed.problems) {
    values->AddError("--impair", std::move(problem.message), std::move(problem.remedy));
  }
  if (since_s) parsed.impairment.started = FromSeconds(*since_s);
  return std::move(parsed.impairment);
}

void ReadRing(FlagValues* values, ServiceFlags* flags) {
  if (!values->Text("--record-ring")) return;
  if (values->Text("--record-split")) {
    values->AddError("--record-ring", "a ring is split by time, and not by size",
                     "leave --record-split out, or --record-ring");
  }
  flags->record_ring = std::chrono::seconds(values->Uint("--record-ring", {5, 3600}).value_or(0));
}

void ReadRecord(FlagValues* values, ServiceFlags* flags) {
  if (values->Text("--record")) flags->record = values->TextOr("", "--record");
  for (const char* flag : {"--record-split", "--record-ring"}) {
    if (!values->Text(flag) || values->Text("--record")) continue;
    values->AddError(flag, "says how to record, and nothing is recorded", "give --record FILE");
  }
  ReadRing(values, flags);
  const auto split = values->Text("--record-split");
  if (!split) return;
  const auto bytes = ParseByteSize(*split);
  if (!bytes || *bytes < kLeastSplitBytes || *bytes > kMostSplitBytes) {
    values->AddError("--record-split", "\"" + *split + "\" is no size a recording is split by",
                     kSplitRemedy);
    return;
  }
  flags->record_split = *bytes;
}

std::optional<Resumed> ReadResumed(FlagValues* values) {
  const auto file = values->Text("--resume");
  if (!file) return std::nullopt;
  try {
    const auto resumed = ResumedFrom(ReadBytes(*file));
    LetGo(*file);
    if (resumed) return resumed;
    values->AddError("--resume", "\"" + *file + "\" does not hold what a vehicle gives to itself",
                     "leave it out: fleetctl qos apply makes a vehicle restart itself");
  } catch (const InputError& error) {
    values->Add(error.Problems());
  }
  return std::nullopt;
}

void ReadHealth(FlagValues* values, ServiceFlags* flags) {
  flags->health_port = values->Uint("--health-port", {0, 65535}).value_or(0);
  flags->health_address = values->TextOr(flags->health_address, "--health-address");
  const auto what = values->Text("--health");
  if (what) {
    const bool is_silent = what->empty();
    flags->ask_health =
        is_silent ? "ready" : values->OneOf("--health", {"live", "ready", "metrics"}).value_or("");
  }
  if (!flags->ask_health.empty() && flags->health_port == 0) {
    values->AddError("--health", "asks at --health-port, and there is none",
                     "write --health-port with the port of the service");
  }
}

ServiceFlags Read(Service service, FlagValues* values) {
  constexpr double kMaxWhole = 4294967295.0;
  ServiceFlags flags;
  ReadHealth(values, &flags);
  if (values->Text("--health")) return flags;  // what a service needs, a question does not
  flags.scenario = values->RequiredText("--scenario", "name a file or a shipped scenario");
  if (!values->Text("--domain")) {
    values->AddError("--domain", "is required and missing", "write --domain with a number 1..99");
  }
  flags.domain = values->Uint("--domain", {1, 99}).value_or(0);
  flags.interface = values->TextOr(flags.interface, "--interface");
  flags.discovery_servers = ReadDiscoveryServers(values);
  flags.qos = ReadQosFlag(values);
  if (service == Service::kVehicle) {
    flags.id = values->Uint("--id", {1, kMaxWhole}).value_or(0);
    ReadRecord(values, &flags);
    flags.impair = ReadImpairment(values);
    flags.stay = values->Switch("--stay");
    flags.partition_free = values->Switch("--partition-free");
    flags.hang_on_signal = values->Switch("--hang-on-signal");
    flags.watchdog = !values->Switch("--no-watchdog");
  }
  if (service == Service::kWorld) {
    flags.threads = values->Uint("--threads", {1, 256}).value_or(flags.threads);
    flags.go_on_from = values->Text("--go-on-from").value_or("");
    if (values->Text("--checkpoint")) flags.checkpoint = values->TextOr("", "--checkpoint");
    if (values->Text("--faults")) flags.faults = values->TextOr("", "--faults");
  }
  flags.leaves_out_shared_memory = values->OneOf("--leave-out", {"shared_memory"}).has_value();
  flags.memory_lost = values->Text("--memory-lost").value_or("");
  flags.try_qos = values->Text("--try-qos").value_or("");
  flags.resume = ReadResumed(values);
  flags.former_qos = values->Text("--former-qos").value_or("");
  flags.rolled_back = values->Text("--rolled-back").value_or("");
  flags.seed = values->Uint("--seed", {0, kMaxWhole});
  const auto behaviour =
      values->OneOf("--behaviour", {Name(Behaviour::kCooperative), Name(Behaviour::kLectureAvoid),
                                    Name(Behaviour::kStockAvoid), Name(Behaviour::kLectureYield),
                                    Name(Behaviour::kLecturePrinted)});
  if (behaviour) flags.behaviour = BehaviourNamed(*behaviour);
  flags.duration_s = values->Duration_s("--duration", {0, 86400, "s", true});
  flags.lockstep = values->Switch("--lockstep");
  flags.admin = values->Switch("--admin");
  if (values->Text("--admin-key")) flags.admin_key = values->TextOr("", "--admin-key");
  flags.log_format = values->OneOf("--log-format", {"text", "json"}).value_or(flags.log_format);
  flags.log_level =
      values->OneOf("--log-level", {"debug", "info", "warning", "error"}).value_or(flags.log_level);
  return flags;
}

ParsedFlags ParseFlags(Service service, const std::string& name, const std::string& description,
                       std::string_view library, int argc, const char* const* argv) {
  CommandLine line(name, description, name + " " + GIVEWAY_VERSION + ", " + std::string(library),
                   kFooter);
  AddFlags(service, &line);
  try {
    FlagValues values(line.Parse(argc, argv));
    ServiceFlags flags = Read(service, &values);
    if (values.Problems().empty()) return flags;
    std::fprintf(stderr, "%s\n", Format(values.Problems()).c_str());
    return kUsageError;
  } catch (const CLI::ParseError& error) {
    return line.Exit(error);
  }
}

}  // namespace

ParsedFlags ParseVehicleFlags(int argc, const char* const* argv, std::string_view library) {
  return ParseFlags(Service::kVehicle, "giveway-vehicle",
                    "One vehicle of a fleet: beacons, decides, drives.", library, argc, argv);
}

ParsedFlags ParseWorldFlags(int argc, const char* const* argv, std::string_view library) {
  return ParseFlags(Service::kWorld, "giveway-world",
                    "The simulated world a fleet shares: bodies, walls, ultrasonics, the judge.",
                    library, argc, argv);
}

std::optional<Behaviour> BehaviourNamed(std::string_view name) {
  for (const Behaviour behaviour :
       {Behaviour::kCooperative, Behaviour::kLectureAvoid, Behaviour::kStockAvoid,
        Behaviour::kLectureYield, Behaviour::kLecturePrinted}) {
    if (Name(behaviour) == name) return behaviour;
  }
  return std::nullopt;
}

}  // namespace giveway
