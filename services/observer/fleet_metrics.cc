#include "services/observer/fleet_metrics.h"

#include <prometheus/text_serializer.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "services/types/decision.h"

namespace giveway {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

constexpr double kSecondsPerMs = 1e-3;
constexpr double kSecondsPerUs = 1e-6;
constexpr double kUsPerSecond = 1e6;  // by division 75 000 is 0.075 and nothing near it

using Label = ClientMetric::Label;

ClientMetric MakeMetric(std::vector<Label> labels, double value, MetricType type) {
  ClientMetric metric;
  metric.label = std::move(labels);
  (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
  return metric;
}

// The families of all vehicles: each is started, then filled vehicle by vehicle.
class Families {
 public:
  Families(const FleetView& view, SteadyTime now) : view_(view), now_(now) {}

  void Begin(const std::string& name, const std::string& help, MetricType type) {
    families_.push_back({.name = name, .help = help, .type = type, .metric = {}});
  }
  void Add(std::vector<Label> labels, double value) {
    families_.back().metric.push_back(MakeMetric(std::move(labels), value, families_.back().type));
  }
  // Of each vehicle that is heard and has published its status: the last one of a vehicle that is
  // silent is history, by which no alert may fire.
  template <typename Use>
  void EachStatus(Use&& use) const {
    for (const auto& [id, heard] : view_.Heard().Vehicles()) {
      if (heard.status && heard.LivenessAt(now_) == Liveness::kHeard) use(id, *heard.status);
    }
  }
  // One number of each status.
  template <typename Of>
  void OfStatus(const std::string& name, const std::string& help, MetricType type, Of&& of) {
    Begin("giveway_vehicle_" + name, help, type);
    EachStatus([&](VehicleId id, const VehicleStatus& status) {
      Add({Vehicle(id)}, static_cast<double>(of(status)));
    });
  }
  template <typename Of>
  void ByReason(const std::string& name, const std::string& help, const std::string& label,
                const std::vector<std::pair<const char*, Of>>& kinds) {
    Begin("giveway_vehicle_" + name, help, MetricType::Counter);
    EachStatus([&](VehicleId id, const VehicleStatus& status) {
      for (const auto& [kind, of] : kinds) Add({Vehicle(id), {label, kind}}, of(status));
    });
  }
  void Histogram(const std::string& name, const std::string& help,
                 const FigureHistogram VehicleView::*figure) {
    Begin("giveway_vehicle_" + name, help, MetricType::Histogram);
    EachStatus([&](VehicleId id, const VehicleStatus&) {
      const VehicleView* vehicle = view_.Find(id);
      if (vehicle == nullptr) return;
      ClientMetric metric;
      metric.label = {Vehicle(id)};
      metric.histogram = BucketsOf(vehicle->*figure);
      families_.back().metric.push_back(std::move(metric));
    });
  }

  const FleetView& View() const { return view_; }
  SteadyTime Now() const { return now_; }
  static Label Vehicle(VehicleId id) { return {"vehicle", std::to_string(Number(id))}; }
  std::string Text() const { return prometheus::TextSerializer().Serialize(families_); }

 private:
  static ClientMetric::Histogram BucketsOf(const FigureHistogram& figure) {
    ClientMetric::Histogram histogram;
    std::uint64_t cumulative = 0;
    for (std::size_t i = 0; i < FigureHistogram::kLimits_us.size(); ++i) {
      cumulative += figure.Count(i);
      histogram.bucket.push_back({cumulative, FigureHistogram::kLimits_us[i] / kUsPerSecond});
    }
    histogram.bucket.push_back({figure.Values(), std::numeric_limits<double>::infinity()});
    histogram.sample_count = figure.Values();
    histogram.sample_sum = figure.Sum_us() / kUsPerSecond;
    return histogram;
  }

  const FleetView& view_;
  const SteadyTime now_;
  std::vector<MetricFamily> families_;
};

void AddLiveness(Families* to) {
  to->Begin("giveway_vehicle_heard", "1 if something came of it within the last second.",
            MetricType::Gauge);
  for (const auto& [id, heard] : to->View().Heard().Vehicles()) {
    to->Add({Families::Vehicle(id)}, heard.LivenessAt(to->Now()) == Liveness::kHeard);
  }
  to->Begin("giveway_vehicle_left", "1 if its last status said that it leaves.", MetricType::Gauge);
  for (const auto& [id, heard] : to->View().Heard().Vehicles()) {
    to->Add({Families::Vehicle(id)}, heard.LivenessAt(to->Now()) == Liveness::kLeft);
  }
  to->Begin("giveway_vehicle_silence_seconds", "Time since its last sample.", MetricType::Gauge);
  for (const auto& [id, heard] : to->View().Heard().Vehicles()) {
    if (heard.HeardAt()) to->Add({Families::Vehicle(id)}, Seconds(to->Now() - *heard.HeardAt()));
  }
}

void AddDriving(Families* to) {
  to->Begin("giveway_vehicle_mode", "1 for the mode it is in.", MetricType::Gauge);
  to->EachStatus([to](VehicleId id, const VehicleStatus& status) {
    for (const Mode mode : {Mode::kCooperative, Mode::kSensorOnly, Mode::kHalt, Mode::kLeaving}) {
      to->Add({Families::Vehicle(id), {"mode", std::string(Name(mode))}},
              status.decision.mode == mode);
    }
  });
  to->Begin("giveway_vehicle_rule", "1 for the rule that decides, by its name.", MetricType::Gauge);
  to->EachStatus([to](VehicleId id, const VehicleStatus& status) {
    to->Add({Families::Vehicle(id), {"rule", std::string(Name(status.decision.rule))}}, 1);
  });
  to->OfStatus("speed_meters_per_second", "Forward speed as measured.", MetricType::Gauge,
               [](const VehicleStatus& status) { return status.forward_m_s; });
  to->Begin("giveway_vehicle_nearest_echo_meters", "The nearest ultrasonic echo.",
            MetricType::Gauge);
  to->EachStatus([to](VehicleId id, const VehicleStatus& status) {
    if (status.nearest_echo_m) to->Add({Families::Vehicle(id)}, *status.nearest_echo_m);
  });
  to->OfStatus("step_p99_seconds", "Processor time of the last 1000 decisions, 99th percentile.",
               MetricType::Gauge,
               [](const VehicleStatus& status) { return status.step_p99_us * kSecondsPerUs; });
  to->Begin("giveway_vehicle_heap_bytes", "Heap in use, as its allocator counts it.",
            MetricType::Gauge);
  to->EachStatus([to](VehicleId id, const VehicleStatus& status) {
    if (!status.heap_bytes) return;
    to->Add({Families::Vehicle(id)}, static_cast<double>(*status.heap_bytes));
  });
  to->OfStatus("loop_max_seconds", "The longest time from ranges to command.", MetricType::Gauge,
               [](const VehicleStatus& status) { return status.loop_max_ms * kSecondsPerMs; });
}

void AddPeers(Families* to) {
  const auto counter = [to](const char* name, const char* help, auto&& of) {
    to->OfStatus(name, help, MetricType::Counter, of);
  };
  to->OfStatus("peers_heard", "Peers with a fresh beacon.", MetricType::Gauge,
               [](const VehicleStatus& status) { return status.peers_heard; });
  counter("beacons_sent_total", "Beacons sent.",
          [](const VehicleStatus& status) { return status.beacons.sent; });
  counter("beacons_received_total", "Beacons taken from the middleware.",
          [](const VehicleStatus& status) { return status.beacons.taken; });
  counter("beacons_accepted_total", "Beacons accepted for decisions.",
          [](const VehicleStatus& status) { return status.beacons.accepted; });
  counter("beacons_lost_total", "Sequence numbers that never arrived.",
          [](const VehicleStatus& status) { return status.beacons.lost; });
  counter("beacons_superseded_total", "Beacons overwritten before the loop took them.",
          [](const VehicleStatus& status) { return status.beacons_superseded; });
  counter("deadline_missed_total", "Deadlines that beacons of peers missed.",
          [](const VehicleStatus& status) { return status.qos.deadline_missed; });
  counter("liveliness_lost_total", "Peers whose liveliness was lost.",
          [](const VehicleStatus& status) { return status.qos.liveliness_lost; });
  counter("incompatible_qos_total", "Endpoints with incompatible QoS.",
          [](const VehicleStatus& status) { return status.qos.incompatible_qos; });
}

void AddRefusals(Families* to) {
  using Of = double (*)(const VehicleStatus&);
  to->ByReason<Of>(
      "beacons_rejected_total", "Beacons refused, by reason.", "reason",
      {{"not_finite", [](const auto& s) -> double { return s.beacons.rejected_not_finite; }},
       {"out_of_range", [](const auto& s) -> double { return s.beacons.rejected_out_of_range; }},
       {"crc", [](const auto& s) -> double { return s.beacons.rejected_crc; }},
       {"replayed", [](const auto& s) -> double { return s.beacons.rejected_replayed; }},
       {"own", [](const auto& s) -> double { return s.beacons.rejected_own; }},
       {"wrong_name", [](const auto& s) -> double { return s.beacons.rejected_wrong_name; }},
       {"duplicate_id", [](const auto& s) -> double { return s.beacons.rejected_duplicate_id; }},
       {"wrong_epoch", [](const auto& s) -> double { return s.beacons.rejected_wrong_epoch; }},
       {"table_full", [](const auto& s) -> double { return s.beacons.rejected_table_full; }}});
  to->ByReason<Of>(
      "samples_refused_total", "Samples that were not used, rejected beacons apart.", "reason",
      {{"unbound", [](const auto& s) -> double { return s.refused.unbound_samples; }},
       {"unreadable", [](const auto& s) -> double { return s.refused.unreadable_samples; }},
       {"wrong_name", [](const auto& s) -> double { return s.refused.wrong_name_scans; }},
       {"old_world", [](const auto& s) -> double { return s.refused.old_world_entries; }},
       {"stranger", [](const auto& s) -> double { return s.refused.strangers; }},
       {"implausible", [](const auto& s) -> double { return s.refused.implausible; }}});
  to->ByReason<Of>(
      "doubts_total", "Inconsistencies in what peers published, by kind.", "kind",
      {{"beacon_without_echo", [](const auto& s) -> double { return s.trust.beacon_without_echo; }},
       {"echo_without_beacon", [](const auto& s) -> double { return s.trust.echo_without_beacon; }},
       {"halted_but_closing", [](const auto& s) -> double { return s.trust.halted_but_closing; }},
       {"jump", [](const auto& s) -> double { return s.trust.jumps; }},
       {"impossible_speed", [](const auto& s) -> double { return s.trust.impossible_speeds; }}});
}

void AddPackets(Families* to) {
  const auto count = [](PacketDrop drop) {
    return [drop](const VehicleStatus& status) {
      return static_cast<double>(status.packets.Of(drop));
    };
  };
  to->OfStatus("packets_received_total", "Packets that the filter passed to the middleware.",
               MetricType::Counter, count(PacketDrop::kNone));
  using Of = std::function<double(const VehicleStatus&)>;
  std::vector<std::pair<const char*, Of>> reasons;
  for (std::size_t i = 1; i < kPacketDrops; ++i) {
    const auto drop = static_cast<PacketDrop>(i);
    reasons.emplace_back(Name(drop).data(), count(drop));  // names are literals
  }
  to->ByReason<Of>("packets_dropped_total", "Packets that the filter dropped, by reason.", "reason",
                   reasons);
}

void AddWorld(Families* to) {
  const WorldSnapshot& world = to->View().Heard().World();
  to->Begin("giveway_observer_world_heard", "1 if a world is heard, or is there without vehicles.",
            MetricType::Gauge);
  to->Add({}, world.IsHeard(to->Now()));
  to->Begin("giveway_observer_run_seconds", "Time since the start signal.", MetricType::Gauge);
  to->Add({}, world.time_s);
}

void AddObserver(const ObserverHealth& observer, Families* to) {
  const auto add = [to](const char* name, const char* help, MetricType type, double value) {
    to->Begin(name, help, type);
    to->Add({}, value);
  };
  to->Begin("giveway_observer_info", "Always 1; the labels say what runs.", MetricType::Gauge);
  to->Add({{"version", GIVEWAY_VERSION}}, 1);
  add("giveway_observer_frames_total", "Frames made for the page.", MetricType::Counter,
      static_cast<double>(observer.frames));
  add("giveway_observer_streams", "Clients connected to the stream.", MetricType::Gauge,
      observer.streams);
  add("giveway_observer_requests_refused_total", "Requests refused.", MetricType::Counter,
      static_cast<double>(observer.refused_requests));
  add("giveway_observer_samples_refused_total",
      "Samples of a participant without the authority, or of another id.", MetricType::Counter,
      static_cast<double>(observer.refused_samples));
  add("giveway_observer_foxglove_clients", "Clients of the Foxglove WebSocket.", MetricType::Gauge,
      observer.foxglove_clients);
  add("giveway_observer_foxglove_refused_total",
      "Connections and messages to it that were refused.", MetricType::Counter,
      static_cast<double>(observer.foxglove_refused));
  add("process_cpu_seconds_total", "Processor time used.", MetricType::Counter, observer.cpu_s);
  add("process_resident_memory_bytes", "Resident memory.", MetricType::Gauge,
      observer.resident_bytes);
}

}  // namespace

std::string FleetMetrics(const FleetView& view, const ObserverHealth& observer, SteadyTime now) {
  Families families(view, now);
  AddLiveness(&families);
  AddDriving(&families);
  AddPeers(&families);
  AddRefusals(&families);
  AddPackets(&families);
  families.Histogram("beacon_age_seconds", "Age of the oldest beacon used in a decision, by ticks.",
                     &VehicleView::beacon_age);
  families.Histogram("reaction_seconds", "Time from a cause to the response of the wheels.",
                     &VehicleView::reaction);
  AddWorld(&families);
  AddObserver(observer, &families);
  return families.Text();
}

}  // namespace giveway
