#include "services/health/health_metrics.h"

#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <utility>

#include "services/health/heap_in_use.h"
#include "services/runtime/process.h"
#include "services/types/decision.h"

namespace giveway {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

constexpr double kSecondsPerMs = 1e-3;
constexpr double kSecondsPerUs = 1e-6;
constexpr double kMillion = 1e6;

// Families in the order they are added.
class Metrics {
 public:
  explicit Metrics(std::string prefix) : prefix_(std::move(prefix)) {}

  template <typename Number>
  void Counter(const std::string& name, const std::string& help, Number value) {
    Begin(name + "_total", help, MetricType::Counter);
    Add({}, value);
  }
  template <typename Number>
  void Gauge(const std::string& name, const std::string& help, Number value) {
    Begin(name, help, MetricType::Gauge);
    Add({}, value);
  }
  // A family whose members have one label each: first Begin, then Add for each.
  void Begin(const std::string& name, const std::string& help, MetricType type) {
    families_.push_back({.name = prefix_ + name, .help = help, .type = type, .metric = {}});
  }
  template <typename Number>
  void Add(std::vector<ClientMetric::Label> labels, Number value) {
    ClientMetric& metric = families_.back().metric.emplace_back();
    metric.label = std::move(labels);
    const auto number = static_cast<double>(value);
    const bool counts = families_.back().type == MetricType::Counter;
    (counts ? metric.counter.value : metric.gauge.value) = number;
  }
  // Totals since the process started, with quantiles 0.5, 0.99 and 1: millionths of the unit in its
  // name.
  void Summary(const std::string& name, const std::string& help, const FigureSummary& figure) {
    Begin(name, help, MetricType::Summary);
    ClientMetric::Summary& summary = families_.back().metric.emplace_back().summary;
    summary.sample_count = figure.count;
    summary.sample_sum = figure.sum / kMillion;
    summary.quantile = {
        {0.5, figure.p50 / kMillion}, {0.99, figure.p99 / kMillion}, {1, figure.max / kMillion}};
  }
  std::string Text() const { return prometheus::TextSerializer().Serialize(families_); }

 private:
  const std::string prefix_;
  std::vector<MetricFamily> families_;
};

void AddInfo(const std::vector<ClientMetric::Label>& labels, Metrics* metrics) {
  metrics->Begin("info", "Always 1; the labels say what runs.", MetricType::Gauge);
  metrics->Add(labels, 1);
}

void AddLoop(const LoopHealth& loop, bool ready, SteadyTime now, Metrics* metrics) {
  metrics->Gauge("ready", "1 if /readyz says so.", ready);
  metrics->Counter("loop_turns", "Iterations of the control loop.", loop.turns);
  metrics->Gauge("loop_silence_seconds", "Time since the last iteration of the control loop.",
                 Seconds(now - loop.turned));
}

void AddLog(const ProcessFigures& process, Metrics* metrics) {
  metrics->Counter("log_lines_dropped", "Log lines dropped because they were not read.",
                   process.log_lines_dropped);
}

void AddPackets(const PacketCounters& packets, Metrics* metrics) {
  metrics->Counter("packets_received", "Packets that the filter passed to the middleware.",
                   packets.Of(PacketDrop::kNone));
  metrics->Begin("packets_dropped_total", "Packets that the filter dropped, by reason.",
                 MetricType::Counter);
  for (std::size_t i = 1; i < kPacketDrops; ++i) {
    const auto reason = static_cast<PacketDrop>(i);
    metrics->Add({{"reason", std::string(Name(reason))}}, packets.Of(reason));
  }
}

void AddBeacons(const VehicleStatus& status, Metrics* metrics) {
  const BeaconCounters& beacons = status.beacons;
  metrics->Counter("beacons_sent", "Beacons sent.", beacons.sent);
  metrics->Counter("beacons_received", "Beacons taken from the middleware.", beacons.taken);
  metrics->Counter("beacons_accepted", "Beacons accepted for decisions.", beacons.accepted);
  metrics->Counter("beacons_not_heard", "Beacons from beyond the emission radius.",
                   beacons.not_heard);
  metrics->Counter("beacons_lost", "Sequence numbers that never arrived.", beacons.lost);
  metrics->Counter("beacons_superseded", "Beacons overwritten before the loop took them.",
                   status.beacons_superseded);
  metrics->Begin("beacons_rejected_total", "Beacons refused, by reason.", MetricType::Counter);
  const auto rejected = [metrics](const char* reason, std::uint32_t count) {
    metrics->Add({{"reason", reason}}, count);
  };
  rejected("not_finite", beacons.rejected_not_finite);
  rejected("out_of_range", beacons.rejected_out_of_range);
  rejected("crc", beacons.rejected_crc);
  rejected("replayed", beacons.rejected_replayed);
  rejected("own", beacons.rejected_own);
  rejected("wrong_name", beacons.rejected_wrong_name);
  rejected("duplicate_id", beacons.rejected_duplicate_id);
  rejected("wrong_epoch", beacons.rejected_wrong_epoch);
  rejected("table_full", beacons.rejected_table_full);
}

void AddRefused(const RefusedSamples& refused, Metrics* metrics) {
  metrics->Begin("samples_refused_total", "Samples that were not used, rejected beacons apart.",
                 MetricType::Counter);
  const auto add = [metrics](const char* reason, std::uint32_t count) {
    metrics->Add({{"reason", reason}}, count);
  };
  add("unbound", refused.unbound_samples);
  add("unreadable", refused.unreadable_samples);
  add("wrong_name", refused.wrong_name_scans);
  add("old_world", refused.old_world_entries);
  add("stranger", refused.strangers);
  add("implausible", refused.implausible);
}

void AddTrust(const TrustCounters& trust, Metrics* metrics) {
  metrics->Begin("doubts_total", "Inconsistencies in what peers published, by kind.",
                 MetricType::Counter);
  metrics->Add({{"kind", "beacon_without_echo"}}, trust.beacon_without_echo);
  metrics->Add({{"kind", "echo_without_beacon"}}, trust.echo_without_beacon);
  metrics->Add({{"kind", "halted_but_closing"}}, trust.halted_but_closing);
  metrics->Add({{"kind", "jump"}}, trust.jumps);
  metrics->Add({{"kind", "impossible_speed"}}, trust.impossible_speeds);
}

void AddPeers(const VehicleHealth& vehicle, Metrics* metrics) {
  const QosCounters& qos = vehicle.status.qos;
  metrics->Gauge("peers_matched", "Beacon writers of peers matched now.", vehicle.matched_peers);
  metrics->Gauge("peers_heard", "Peers with a fresh beacon.", vehicle.status.peers_heard);
  metrics->Counter("deadline_missed", "Deadlines that beacons of peers missed.",
                   qos.deadline_missed);
  metrics->Counter("liveliness_lost", "Peers whose liveliness was lost.", qos.liveliness_lost);
  metrics->Counter("incompatible_qos", "Endpoints with incompatible QoS.", qos.incompatible_qos);
  metrics->Counter("ranges_deadline_missed", "Deadlines that the world's ranges missed.",
                   vehicle.ranges_deadline_missed);
  metrics->Counter("write_failures", "Writes that the middleware refused.", vehicle.write_failures);
}

void AddDriving(const VehicleHealth& vehicle, SteadyTime now, Metrics* metrics) {
  const VehicleStatus& status = vehicle.status;
  metrics->Begin("mode", "1 for the mode it is in.", MetricType::Gauge);
  for (const Mode mode : {Mode::kCooperative, Mode::kSensorOnly, Mode::kHalt, Mode::kLeaving}) {
    metrics->Add({{"mode", std::string(Name(mode))}}, status.decision.mode == mode);
  }
  metrics->Gauge("speed_meters_per_second", "Forward speed as measured.", status.forward_m_s);
  if (status.nearest_echo_m) {
    metrics->Gauge("nearest_echo_meters", "The nearest ultrasonic echo.", *status.nearest_echo_m);
  }
  if (vehicle.scanned != SteadyTime{0}) {
    metrics->Gauge("ranges_age_seconds", "Age of the newest ranges.",
                   Seconds(now - vehicle.scanned));
  }
  metrics->Counter("late_scans", "Ranges overwritten by newer ones before the loop took them.",
                   vehicle.late_scans);
  metrics->Gauge("step_p99_seconds", "Processor time of the last 1000 decisions, 99th percentile.",
                 status.step_p99_us * kSecondsPerUs);
  metrics->Gauge("loop_max_seconds", "The longest time from ranges to command.",
                 status.loop_max_ms * kSecondsPerMs);
  metrics->Counter("placements", "Placements in a world: one, and one after each restart of it.",
                   vehicle.placements);
}

void AddPose(const VehicleHealth& vehicle, Metrics* metrics) {
  metrics->Gauge("lost", "1 while it stands because its pose is too uncertain.",
                 vehicle.status.decision.rule == Rule::kLost);
  metrics->Gauge("pose_sigma_meters", "Standard deviation of its own position.",
                 vehicle.pose_sigma_m);
  metrics->Counter("pose_fixes_used", "Pose fixes used in the estimate.", vehicle.fixes_used);
  metrics->Counter("pose_fixes_refused", "Pose fixes rejected as outdated or implausible.",
                   vehicle.fixes_refused);
}

void AddTiming(const DriveFigures& timing, Metrics* metrics) {
  metrics->Summary("beacon_age_seconds", "Age of the oldest beacon used in a decision, by ticks.",
                   timing.Of(DriveFigure::kBeaconAge));
  metrics->Summary("tick_jitter_seconds",
                   "Deviation of the time between two range scans from their ticks.",
                   timing.Of(DriveFigure::kTickJitter));
  metrics->Summary("turn_seconds", "Time from ranges to command.", timing.Of(DriveFigure::kTurn));
  metrics->Summary("reaction_seconds", "Time from a cause to the response of the wheels.",
                   timing.Of(DriveFigure::kReaction));
  metrics->Summary("reaction_meters", "Distance driven from a cause to the response of the wheels.",
                   timing.Of(DriveFigure::kReactionDistance));
  metrics->Summary("reaction_ratio", "The same as a share of the distance free at the cause.",
                   timing.Of(DriveFigure::kReactionShare));
  metrics->Summary(
      "beacon_latency_seconds",
      "From publishing to reception of beacons, the longest of a turn, by wall clocks.",
      timing.Of(DriveFigure::kBeaconLatency));
  metrics->Summary("scan_latency_seconds", "From publishing to reception of scans, by wall clocks.",
                   timing.Of(DriveFigure::kScanLatency));
  metrics->Counter("samples_received_before_sent",
                   "Samples received before they were sent, by wall clocks.",
                   timing.received_before_sent);
  if (timing.narrowest) {
    metrics->Gauge("narrowest_margin_ratio",
                   "Smallest share of its free distance that a reaction left.",
                   timing.narrowest->ShareLeft());
  }
  metrics->Counter("budget_spent", "Reactions that left less than a fifth of the free distance.",
                   timing.budget_spent);
}

// Under the names every exporter has for them.
std::string Text(const ProcessFigures& process) {
  Metrics metrics("process_");
  metrics.Gauge("start_time_seconds", "When the process started, since 1970.", process.started_s);
  metrics.Counter("cpu_seconds", "Processor time used.", process.cpu_s);
  metrics.Gauge("resident_memory_bytes", "Resident memory.", process.resident_bytes);
  if (process.heap_bytes) {
    metrics.Gauge("heap_bytes", "Heap in use, as the allocator counts it.",
                  static_cast<double>(*process.heap_bytes));
  }
  return metrics.Text();
}

double SinceEpoch() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

const double started_s = SinceEpoch();  // as near as makes no difference

double SecondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * kSecondsPerUs;
}

}  // namespace

ProcessFigures ReadProcessFigures() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  double pages = 0;
  double resident_pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident_pages;
  return {.started_s = started_s,
          .cpu_s = SecondsOf(usage.ru_utime) + SecondsOf(usage.ru_stime),
          .resident_bytes = resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)),
          .heap_bytes = HeapInUse(),
          .log_lines_dropped = LogLinesDropped()};
}

std::string MetricsText(const VehicleHealth& vehicle, const ProcessFigures& process,
                        SteadyTime now) {
  Metrics metrics("giveway_vehicle_");
  AddInfo(
      {{"vehicle", std::to_string(Number(vehicle.status.vehicle))}, {"version", GIVEWAY_VERSION}},
      &metrics);
  AddLoop(vehicle.loop, NotReady(vehicle, now).empty(), now, &metrics);
  AddDriving(vehicle, now, &metrics);
  AddPose(vehicle, &metrics);
  AddPeers(vehicle, &metrics);
  AddBeacons(vehicle.status, &metrics);
  AddTrust(vehicle.status.trust, &metrics);
  AddRefused(vehicle.status.refused, &metrics);
  AddTiming(vehicle.status.timing, &metrics);
  AddPackets(vehicle.packets, &metrics);
  AddLog(process, &metrics);
  return metrics.Text() + Text(process);
}

std::string MetricsText(const WorldHealth& world, const ProcessFigures& process, SteadyTime now) {
  Metrics metrics("giveway_world_");
  AddInfo({{"version", GIVEWAY_VERSION}}, &metrics);
  AddLoop(world.loop, NotReady(world, now).empty(), now, &metrics);
  metrics.Begin("run_state", "1 for the state the run is in.", MetricType::Gauge);
  for (const auto& [state, name] : {std::pair{RunState::kWaiting, "waiting"},
                                    {RunState::kRunning, "running"},
                                    {RunState::kEnded, "ended"}}) {
    metrics.Add({{"state", name}}, world.run_state == state);
  }
  metrics.Gauge("run_seconds", "Time since the start signal.", world.time_s);
  metrics.Counter("late_ticks", "Ticks of the run that started a whole period late.",
                  world.late_ticks);
  metrics.Gauge("vehicles_joined", "Vehicles with a place.", world.vehicles_joined);
  metrics.Counter("contacts", "Pairs of bodies that came into contact.", world.contacts);
  metrics.Counter("reactions", "Reactions: commands that answered a cause.", world.reactions);
  metrics.Counter("commands_received", "Motor commands taken.", world.commands_taken);
  metrics.Begin("commands_rejected_total", "Motor commands refused, by reason.",
                MetricType::Counter);
  metrics.Add({{"reason", "wrong_name"}}, world.commands_wrong_name);
  metrics.Add({{"reason", "unbound"}}, world.commands_unbound);
  metrics.Add({{"reason", "not_finite"}}, world.commands_not_finite);
  metrics.Add({{"reason", "stranger"}}, world.commands_strangers);
  metrics.Summary("command_latency_seconds",
                  "From publishing a motor command to the tick that applies it, by wall clocks.",
                  world.command_latency);
  metrics.Counter(
      "joins_rejected",
      "Join requests dropped unexamined: without a session, of another's session, or too many.",
      world.joins_refused);
  metrics.Counter("orders_rejected", "Orders of a writer that names too many vehicles.",
                  world.orders_refused);
  metrics.Counter("write_failures", "Writes that the middleware refused.", world.write_failures);
  AddPackets(world.packets, &metrics);
  AddLog(process, &metrics);
  return metrics.Text() + Text(process);
}

}  // namespace giveway
