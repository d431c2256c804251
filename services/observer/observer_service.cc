#include "services/observer/observer_service.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
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
#include "services/runtime/hang_signal.h"
#include "services/runtime/watchdog.h"

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

link::LinkOptions LinkOptionsOf(const ObserverFlags& flags,
                                const std::optional<Scenario>& scenario) {
  Scenario unknown;
  unknown.tick_period = Nanoseconds{0};  // then no rule speaks of it
  link::LinkOptions options;
  options.domain = flags.domain;
  options.interface = flags.interface;
  options.qos = ReadSoundQos(flags.qos, scenario.value_or(unknown));
  options.area = flags.area;
  if (options.area.empty()) options.area = scenario ? scenario->area : "main";
  options.fleet_size = kFleetSize;
  options.discovery_servers = flags.discovery_servers;
  // Once: participants that are made later, by the loop that is watched, must not wait for names.
  const link::FoundServers found = link::FindServers(flags.discovery_servers);
  if (!found.fault.empty()) throw link::LinkError(found.fault);
  options.server_addresses = found.addresses;
  return options;
}

// Of the ROS 2 topics: in the fleet's domain found as the fleet is.
link::LinkOptions Ros2LinkOptions(const ObserverFlags& flags, link::LinkOptions options) {
  if (flags.ros2_domain == 0 || flags.ros2_domain == flags.domain) return options;
  options.domain = flags.ros2_domain;
  options.discovery_servers.clear();
  options.server_addresses.clear();
  return options;
}

// Of one that the scenario does not name: that of its places, for which of them it has is not
// known.
RobotModel ProfileOf(const std::optional<Scenario>& scenario, VehicleId id) {
  if (!scenario) return PioneerP3dx();
  const auto found = std::ranges::find(scenario->vehicles, id, &VehicleOptions::id);
  if (found != scenario->vehicles.end()) return found->profile;
  return scenario->spawns.empty() ? PioneerP3dx() : scenario->spawns.front().profile;
}

std::uint64_t SinceEpoch_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::unique_ptr<FoxgloveFeed> FoxgloveOf(const ObserverFlags& flags,
                                         const std::optional<Scenario>& scenario) {
  if (flags.foxglove_port == 0) return nullptr;
  FoxgloveOptions options{.address = flags.address,
                          .port = static_cast<std::uint16_t>(flags.foxglove_port),
                          .name = "giveway, domain " + std::to_string(flags.domain),
                          .host_names = flags.host_names,
                          .channels = FoxgloveChannels()};
  auto feed = std::make_unique<FoxgloveFeed>(LinkOptionsOf(flags, scenario), std::move(options));
  LogInfo("serves Foxglove at ws://" + flags.address + ":" + std::to_string(flags.foxglove_port));
  return feed;
}

// Whether anything of a fleet came.
bool HasHeard(const link::Observed& observed) {
  return !observed.truths.empty() || !observed.beacons.empty() || !observed.statuses.empty() ||
         !observed.roster.empty() || !observed.events.empty();
}

PageAnswer Text(std::string body, int status = 200) {
  return {std::move(body), "text/plain; charset=utf-8", status};
}

}  // namespace

ObserverService::ObserverService(const ObserverFlags& flags)
    : ObserverService(flags, ScenarioOf(flags)) {}

ObserverService::ObserverService(const ObserverFlags& flags,
                                 const std::optional<Scenario>& scenario)
    : turned_ns_(SteadyNow().count()),
      link_(LinkOptionsOf(flags, scenario), link::ObserverLink::Ranges::kYes,
            flags.ros2 ? link::ObserverLink::Commands::kYes : link::ObserverLink::Commands::kNo),
      foxglove_(FoxgloveOf(flags, scenario)),
      server_(flags.address, static_cast<std::uint16_t>(flags.port), Sources(flags, scenario)) {
  LogInfo("serves http://" + flags.address + ":" + std::to_string(flags.port) + "/ of domain " +
          std::to_string(flags.domain));
  if (!flags.ros2) return;
  const link::LinkOptions options = Ros2LinkOptions(flags, LinkOptionsOf(flags, scenario));
  ros2_.emplace(options, flags.ros2_rate_hz,
                [scenario](VehicleId id) { return ProfileOf(scenario, id); });
  LogInfo("publishes ROS 2 topics in domain " + std::to_string(options.domain));
}

PageSources ObserverService::Sources(const ObserverFlags& flags,
                                     const std::optional<Scenario>& scenario) {
  PageSources sources;
  sources.page = PageText();
  // In a container each observer is process 1.
  const std::string observer =
      std::to_string(::getpid()) + " of " + std::to_string(SteadyNow().count());
  sources.scene = SceneJson({"domain " + std::to_string(flags.domain), scenario, observer});
  sources.frames = &board_;
  sources.host_names = flags.host_names;
  sources.get = [this](const std::string& path, const ServerFigures& server) {
    return Get(path, server);
  };
  return sources;
}

ObserverService::~ObserverService() { board_.Close(); }

PageAnswer ObserverService::Ready() {
  constexpr int kUnavailable = 503;
  const std::lock_guard lock(mutex_);
  const FleetSnapshot& fleet = view_.Heard();
  if (fleet.IsAnyHeard() || fleet.World().is_empty) return Text("ready\n");
  return Text("not ready: no vehicle and no world was heard yet\n", kUnavailable);
}

PageAnswer ObserverService::Metrics(const ServerFigures& server) {
  const ProcessFigures process = ReadProcessFigures();
  const FoxgloveFigures foxglove = foxglove_ ? foxglove_->Figures() : FoxgloveFigures{};
  const std::lock_guard lock(mutex_);
  const ObserverHealth health{.frames = frames_,
                              .streams = server.streams,
                              .refused_requests = server.refused,
                              .refused_samples = refused_samples_,
                              .cpu_s = process.cpu_s,
                              .resident_bytes = process.resident_bytes,
                              .foxglove_clients = foxglove.clients,
                              .foxglove_refused = foxglove.refused};
  return {FleetMetrics(view_, health, SteadyNow()), "text/plain; version=0.0.4; charset=utf-8"};
}

std::optional<PageAnswer> ObserverService::Get(const std::string& path,
                                               const ServerFigures& server) {
  constexpr int kUnavailable = 503;
  const SteadyTime now = SteadyNow();
  if (path == "/livez") {
    const bool hangs = now.count() - turned_ns_.load() > kHangs.count();
    return hangs ? Text("not live: the loop stands still\n", kUnavailable) : Text("live\n");
  }
  if (path == "/readyz") return Ready();
  if (path == "/metrics") return Metrics(server);
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

// False once it can hear no more.
bool ObserverService::Turn() {
  const link::Observed observed = link_.Take();
  const SteadyTime now = SteadyNow();
  LogNews(observed.refusals, {}, now, &refusal_log_);
  PublishRos2(observed);
  const std::lock_guard lock(mutex_);
  view_.Fold(observed, now);
  refused_samples_ += observed.refused;
  turned_ns_ = now.count();
  return !interface_check_.MustEnd(now, HasHeard(observed));
}

void ObserverService::PublishRos2(const link::Observed& observed) {
  if (!ros2_) return;
  ros2_->Publish(observed, SinceEpoch_ns());
  if (ros2_->Refused() > 0 && !std::exchange(ros2_refusal_logged_, true)) {
    LogWarning("Fast DDS refused a ROS 2 message; more are not logged");
  }
}

void ObserverService::Publish(SteadyTime now) {
  std::string frame;
  {
    const std::lock_guard lock(mutex_);
    frame = FrameJson(view_, now);
  }
  board_.Publish(std::move(frame));
  ++frames_;
}

bool ObserverService::Run(const StopSignal& stop) {
  Watchdog watchdog;
  SteadyTime next_frame = SteadyNow();
  while (!stop.IsSet()) {
    SleepUntil(SteadyNow() + kTurn);
    if (HangSignal::IsUp()) HangWhileUp();
    if (!Turn()) return false;
    watchdog.Feed();
    const SteadyTime now = SteadyNow();
    if (foxglove_ != nullptr) foxglove_->Turn(now);
    if (now < next_frame || server_.Figures().streams == 0) continue;  // else: as soon as one comes
    Publish(now);
    // Only this thread changes the view.
    const bool large = view_.Heard().Vehicles().size() > kLargeFleet;
    next_frame = now + (large ? kFrameOfLargeFleet : kFrame);
  }
  return true;
}

}  // namespace giveway
