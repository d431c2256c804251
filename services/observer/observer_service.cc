#include "services/observer/observer_service.h"

#include <string_view>
#include <utility>

#include "services/config/scenario_file.h"
#include "services/health/health_metrics.h"
#include "services/node/qos_at_start.h"
#include "services/observer/fleet/fleet_json.h"
#include "services/observer/fleet/frame_json.h"
#include "services/observer/fleet/scene_json.h"
#include "services/observer/page/page_text.h"
#include "services/observer/server/request_rules.h"

namespace giveway {
namespace {

constexpr Nanoseconds kTurn = std::chrono::milliseconds(20);
constexpr Nanoseconds kFrame = std::chrono::milliseconds(100);
constexpr Nanoseconds kFrameOfLargeFleet = std::chrono::milliseconds(200);
constexpr std::size_t kLargeFleet = 100;
constexpr Nanoseconds kHangs = std::chrono::seconds(2);
constexpr std::uint32_t kFleetSize = 32;  // sets the depth of the event history alone
constexpr std::string_view kVehiclePath = "/api/v1/vehicles/";

std::optional<Scenario> ScenarioOf(const ObserverFlags& flags) {
  if (flags.scenario.empty()) return std::nullopt;
  return LoadScenario(flags.scenario, {});
}

std::string AreaOf(const ObserverFlags& flags) {
  if (!flags.area.empty()) return flags.area;
  const auto scenario = ScenarioOf(flags);
  return scenario ? scenario->area : "main";
}

link::LinkOptions LinkOptionsOf(const ObserverFlags& flags) {
  Scenario unknown;
  unknown.tick_period = Nanoseconds{0};  // then no rule speaks of it
  const Scenario scenario = ScenarioOf(flags).value_or(unknown);
  link::LinkOptions options;
  options.domain = flags.domain;
  options.interface = flags.interface;
  options.qos = ReadSoundQos(flags.qos, scenario);
  options.area = AreaOf(flags);
  options.fleet_size = kFleetSize;
  options.discovery_servers = flags.discovery_servers;
  return options;
}

PageAnswer Text(std::string body, int status = 200) {
  return {std::move(body), "text/plain; charset=utf-8", status};
}

}  // namespace

ObserverService::ObserverService(const ObserverFlags& flags)
    : link_(LinkOptionsOf(flags), link::ObserverLink::Ranges::kYes) {
  PageSources sources;
  sources.page = PageText();
  sources.scene = SceneJson({"domain " + std::to_string(flags.domain), ScenarioOf(flags)});
  sources.frames = &board_;
  sources.host_names = flags.host_names;
  sources.get = [this](const std::string& path) { return Get(path); };
  turned_ns_ = SteadyNow().count();
  server_.emplace(flags.address, static_cast<std::uint16_t>(flags.port), std::move(sources));
  LogInfo("serves http://" + flags.address + ":" + std::to_string(flags.port) + "/ of domain " +
          std::to_string(flags.domain));
}

ObserverService::~ObserverService() { board_.Close(); }

PageAnswer ObserverService::Ready() {
  constexpr int kUnavailable = 503;
  const std::lock_guard lock(mutex_);
  if (view_.Heard().Anybody()) return Text("ready\n");
  return Text("not ready: no vehicle and no world was heard yet\n", kUnavailable);
}

std::optional<PageAnswer> ObserverService::Get(const std::string& path) {
  constexpr int kUnavailable = 503;
  const SteadyTime now = SteadyNow();
  if (path == "/livez") {
    const bool hangs = now.count() - turned_ns_.load() > kHangs.count();
    return hangs ? Text("not live: the loop stands still\n", kUnavailable) : Text("live\n");
  }
  if (path == "/readyz") return Ready();
  if (path == "/metrics") {
    const ProcessFigures process = ReadProcessFigures();
    ObserverHealth health{.frames = frames_,
                          .streams = server_ ? server_->Streams() : 0,
                          .refused_requests = server_ ? server_->Refused() : 0,
                          .refused_samples = 0,
                          .cpu_s = process.cpu_s,
                          .resident_bytes = process.resident_bytes};
    const std::lock_guard lock(mutex_);
    health.refused_samples = refused_samples_;
    return PageAnswer{FleetMetrics(view_, health, now), "text/plain; version=0.0.4; charset=utf-8"};
  }
  const std::lock_guard lock(mutex_);
  if (path == "/api/v1/fleet") return PageAnswer{FleetJson(view_, now) + "\n"};
  if (path == "/api/v1/events") return PageAnswer{EventsJson(view_) + "\n"};
  if (!path.starts_with(kVehiclePath)) return std::nullopt;
  const auto id = VehicleOfPath(std::string_view(path).substr(kVehiclePath.size()));
  if (!id) return std::nullopt;
  constexpr int kNotFound = 404;
  const auto vehicle = VehicleJson(view_, *id, now);
  if (!vehicle)
    return PageAnswer{"{\"error\":\"no such vehicle\"}\n", "application/json", kNotFound};
  return PageAnswer{*vehicle + "\n"};
}

void ObserverService::Turn() {
  const link::Observed observed = link_.Take();
  const SteadyTime now = SteadyNow();
  LogNews(observed.refusals, {}, now, &refusal_log_);
  const std::lock_guard lock(mutex_);
  view_.Fold(observed, now);
  refused_samples_ += observed.refused;
  turned_ns_ = now.count();
}

void ObserverService::Run(const StopSignal& stop) {
  SteadyTime next_frame = SteadyNow();
  while (!stop.IsSet()) {
    SleepUntil(SteadyNow() + kTurn);
    Turn();
    const SteadyTime now = SteadyNow();
    if (now < next_frame) continue;
    const std::lock_guard lock(mutex_);
    const bool large = view_.Heard().Vehicles().size() > kLargeFleet;
    next_frame = now + (large ? kFrameOfLargeFleet : kFrame);
    board_.Publish(FrameJson(view_, now));
    ++frames_;
  }
}

}  // namespace giveway
