// The further sensors and the signals: which vehicle receives them, what is refused, and the effect
// of their silence.
#include <gmock/gmock.h>

#include <limits>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/observer_link.h"
#include "services/link/participant.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::Field;

constexpr VehicleId kSeven{7};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

RobotModel Fitted(bool radar, bool lidar, bool camera) {
  RobotModel profile;
  profile.radar = radar;
  profile.lidar = lidar;
  profile.camera = camera;
  return profile;
}

template <typename Scan>
Scan ScanAt(std::uint32_t tick) {
  Scan scan;
  scan.vehicle = kSeven;
  scan.epoch = WorldEpoch{1};
  scan.tick = Tick{tick};
  return scan;
}

SignalState SignalAt(std::uint32_t id, std::uint32_t tick) {
  SignalState state;
  state.id = SignalId{id};
  state.epoch = WorldEpoch{1};
  state.tick = Tick{tick};
  state.phase = SignalPhase::kGreen;
  return state;
}

auto IsSignal(std::uint32_t id) { return Field(&SignalState::id, SignalId{id}); }

// A world and vehicle 7 with every sensor and with signals, that hear each other.
class FullyFitted : public ::testing::Test {
 protected:
  FullyFitted() : world_(OptionsIn(domain_)), vehicle_(OptionsIn(domain_)) {
    world_.OpenVehicle(kSeven, Fitted(true, true, true));
    vehicle_.Open(kSeven, Fitted(true, true, true), true);
  }
  // A writer may have matched a reader that has not matched it yet, and loses what it sends until
  // then: hence each is heard once.
  void SetUp() override {
    bool scan = false, radar = false, lidar = false, camera = false, signal = false;
    ASSERT_TRUE(Eventually([&] {
      Speak(1);
      const Inputs inputs = vehicle_.Take(SteadyTime{0}).inputs;
      scan |= inputs.scan.has_value();
      radar |= inputs.radar != nullptr;
      lidar |= inputs.lidar != nullptr;
      camera |= inputs.camera != nullptr;
      signal |= !inputs.signals.empty();
      return scan && radar && lidar && camera && signal && world_.IsMatched(kSeven);
    }));
    HearAll(2);
  }

  void Speak(std::uint32_t tick) {
    world_.SendSignal(SignalAt(1, tick));
    world_.SendRadar(ScanAt<RadarScan>(tick));
    world_.SendLidar(ScanAt<LidarScan>(tick));
    world_.SendCamera(ScanAt<CameraScan>(tick));
    world_.SendScan(ScanAt<RangeScan>(tick));
  }
  // Sends one of each and takes until the scan of that tick has come.
  void HearAll(std::uint32_t tick) {
    Speak(tick);
    ASSERT_TRUE(Eventually([&] {
      taken_ = vehicle_.Take(SteadyTime{0});
      return taken_.inputs.scan && taken_.inputs.scan->tick == Tick{tick};
    }));
  }

  DomainLock domain_;
  link::WorldLink world_;
  link::VehicleLink vehicle_;
  link::Taken taken_;
};

// Sends as the world would, but whatever a test wants.
class RawWorld {
 public:
  explicit RawWorld(const link::LinkOptions& options)
      : participant_(options, "raw-world", names_),
        radar(participant_.MakeWriter<wire::RadarScan>("v7")),
        lidar(participant_.MakeWriter<wire::LidarScan>("v7")),
        camera(participant_.MakeWriter<wire::CameraScan>("v7")),
        ranges(participant_.MakeWriter<wire::RangeScan>("v7")),
        signal(participant_.MakeWriter<wire::SignalState>("world")) {}

 private:
  link::WriterNames names_;
  link::Participant participant_;

 public:
  link::Writer<wire::RadarScan> radar;
  link::Writer<wire::LidarScan> lidar;
  link::Writer<wire::CameraScan> camera;
  link::Writer<wire::RangeScan> ranges;
  link::Writer<wire::SignalState> signal;
};

TEST_F(FullyFitted, WhatIsSentBeforeAScanIsThereWithIt) {
  for (std::uint32_t tick = 3; tick < 10; ++tick) {
    Speak(tick);
    ASSERT_TRUE(vehicle_.WaitForScan(std::chrono::seconds(10)));
    const Inputs inputs = vehicle_.Take(SteadyTime{0}).inputs;
    ASSERT_TRUE(inputs.radar != nullptr && inputs.lidar != nullptr && inputs.camera != nullptr);
    EXPECT_EQ(inputs.radar->tick, Tick{tick});
    EXPECT_EQ(inputs.lidar->tick, Tick{tick});
    EXPECT_EQ(inputs.camera->tick, Tick{tick});
    ASSERT_THAT(inputs.signals, ElementsAre(IsSignal(1)));
    EXPECT_EQ(inputs.signals[0].tick, Tick{tick});
  }
}

TEST_F(FullyFitted, OfSeveralTheNewestIsUsedAndOfNothingNewNothing) {
  RadarScan radar = ScanAt<RadarScan>(3);
  radar.count = 1;
  radar.detections[0] = {5, 0.1, -0.5, true};
  world_.SendRadar(ScanAt<RadarScan>(2));
  world_.SendRadar(radar);
  world_.SendSignal(SignalAt(2, 3));
  world_.SendSignal(SignalAt(1, 2));
  world_.SendSignal(SignalAt(1, 3));
  HearAll(4);
  world_.SendScan(ScanAt<RangeScan>(5));
  world_.SendRadar(radar);
  ASSERT_TRUE(Eventually([&] {
    const Inputs inputs = vehicle_.Take(SteadyTime{0}).inputs;
    if (inputs.radar == nullptr) return false;
    EXPECT_EQ(inputs.radar->tick, Tick{3});
    EXPECT_EQ(inputs.radar->count, 1U);
    EXPECT_EQ(inputs.radar->detections[0].range_rate_m_s, -0.5);
    EXPECT_EQ(inputs.lidar, nullptr);
    EXPECT_EQ(inputs.camera, nullptr);
    EXPECT_TRUE(inputs.signals.empty());
    return true;
  }));
}

TEST_F(FullyFitted, SilenceIsOneMissASensorAndOneASignalHead) {
  world_.SendSignal(SignalAt(2, 3));
  HearAll(3);
  const link::VehicleLinkCounters before = vehicle_.Counters();
  Repeat(milliseconds(1500), [&] { vehicle_.Take(SteadyTime{0}); });
  const link::VehicleLinkCounters after = vehicle_.Counters();
  EXPECT_EQ(after.ranges_deadline_missed, before.ranges_deadline_missed + 1);
  EXPECT_EQ(after.sensors_deadline_missed, before.sensors_deadline_missed + 3);
  EXPECT_EQ(after.signals_deadline_missed, before.signals_deadline_missed + 2);
  EXPECT_EQ(after.events_dropped, 0U);
}

TEST_F(FullyFitted, OneSilentHeadAmongSpeakingOnesIsOneMiss) {
  world_.SendSignal(SignalAt(2, 3));
  HearAll(3);
  const std::uint32_t before = vehicle_.Counters().signals_deadline_missed;
  ASSERT_TRUE(Eventually([&] {
    world_.SendSignal(SignalAt(1, 4));
    vehicle_.Take(SteadyTime{0});
    return vehicle_.Counters().signals_deadline_missed > before;
  }));
  Repeat(milliseconds(1000), [&] {
    world_.SendSignal(SignalAt(1, 4));
    vehicle_.Take(SteadyTime{0});
  });
  EXPECT_EQ(vehicle_.Counters().signals_deadline_missed, before + 1);
}

TEST_F(FullyFitted, WhatIsNotSoundIsRefusedAndCounted) {
  RawWorld raw(OptionsIn(domain_));
  wire::RadarScan radar = link::ToWire(ScanAt<RadarScan>(3));
  radar.detections().resize(1);  // one too many is refused by the writer itself
  radar.detections()[0].range_m(kNan);
  wire::LidarScan lidar = link::ToWire(ScanAt<LidarScan>(3));
  lidar.range_m()[90] = kNan;
  wire::CameraScan camera = link::ToWire(ScanAt<CameraScan>(3));
  camera.objects().resize(1);
  camera.objects()[0].seen_class(static_cast<wire::SeenClass>(77));
  wire::RangeScan ranges = link::ToWire(ScanAt<RangeScan>(3));
  ranges.fired_before_s()[0] = kNan;
  const auto refused = [&](const std::function<bool()>& send) {
    const std::uint32_t before = vehicle_.Counters().refused.unreadable_samples;
    return Eventually([&] {
      send();
      const Inputs inputs = vehicle_.Take(SteadyTime{0}).inputs;
      EXPECT_FALSE(inputs.scan.has_value() || inputs.radar != nullptr || inputs.lidar != nullptr ||
                   inputs.camera != nullptr || !inputs.signals.empty());
      return vehicle_.Counters().refused.unreadable_samples > before;
    });
  };
  EXPECT_TRUE(refused([&] { return raw.radar.Write(radar); }));
  EXPECT_TRUE(refused([&] { return raw.lidar.Write(lidar); }));
  EXPECT_TRUE(refused([&] { return raw.camera.Write(camera); }));
  EXPECT_TRUE(refused([&] { return raw.ranges.Write(ranges); }));
  wire::SignalState signal = link::ToWire(SignalAt(3, 3));
  signal.to_change_s(kNan);
  EXPECT_TRUE(refused([&] { return raw.signal.Write(signal); }));
  const wire::SignalState nameless = link::ToWire(SignalAt(0, 3));
  EXPECT_TRUE(refused([&] { return raw.signal.Write(nameless); }));
}

TEST_F(FullyFitted, AScanInAnotherVehiclesNameIsRefusedAndCounted) {
  RawWorld raw(OptionsIn(domain_));
  wire::LidarScan misnamed = link::ToWire(ScanAt<LidarScan>(3));
  misnamed.vehicle(8);
  EXPECT_TRUE(Eventually([&] {
    raw.lidar.Write(misnamed);
    EXPECT_EQ(vehicle_.Take(SteadyTime{0}).inputs.lidar, nullptr);
    return vehicle_.Counters().refused.wrong_name_scans > 0;
  }));
}

TEST(Sensors, HaveReadersOnlyWhereFittedAndSignalsOnlyWhereThereAreAny) {
  const DomainLock domain;
  RawWorld world(OptionsIn(domain));
  {
    link::VehicleLink plain(OptionsIn(domain));
    plain.Open(kSeven);
    ASSERT_TRUE(Eventually([&] { return world.ranges.HasReader(); }));
    // Endpoints of one participant are discovered in the order they were made, ranges before the
    // others: what is not there a moment later is not there.
    Repeat(milliseconds(200), [] {});
    EXPECT_FALSE(world.radar.HasReader());
    EXPECT_FALSE(world.lidar.HasReader());
    EXPECT_FALSE(world.camera.HasReader());
    EXPECT_FALSE(world.signal.HasReader());
  }
  ASSERT_TRUE(Eventually([&] { return !world.ranges.HasReader(); }));
  link::VehicleLink seeing(OptionsIn(domain));
  seeing.Open(kSeven, Fitted(false, true, false), true);
  EXPECT_TRUE(Eventually([&] { return world.lidar.HasReader() && world.signal.HasReader(); }));
  EXPECT_FALSE(world.radar.HasReader());
  EXPECT_FALSE(world.camera.HasReader());
}

TEST(Sensors, AreMatchedOnlyWhenTheVehicleReadsThemAll) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  world.OpenVehicle(kSeven, Fitted(true, true, false));
  world.OpenVehicle(VehicleId{8}, Fitted(true, false, false));
  link::VehicleLink lacking(OptionsIn(domain));
  link::VehicleLink whole(OptionsIn(domain));
  lacking.Open(kSeven, Fitted(true, false, false), false);
  whole.Open(VehicleId{8}, Fitted(true, false, false), false);
  EXPECT_TRUE(Eventually([&] { return world.IsMatched(VehicleId{8}); }));
  Repeat(milliseconds(200), [&] { EXPECT_FALSE(world.IsMatched(kSeven)); });
}

TEST(Signals, ReachEveryVehicleAndTheObserver) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::ObserverLink observer(OptionsIn(domain));
  std::vector<std::unique_ptr<link::VehicleLink>> fleet;
  for (std::uint32_t id = 1; id <= 5; ++id) {
    fleet.push_back(std::make_unique<link::VehicleLink>(OptionsIn(domain)));
    fleet.back()->Open(VehicleId{id}, RobotModel{}, true);
  }
  std::vector<std::set<std::uint32_t>> heard(fleet.size());
  std::set<std::uint32_t> observed;
  EXPECT_TRUE(Eventually([&] {
    for (std::uint32_t head = 1; head <= 4; ++head) world.SendSignal(SignalAt(head, 1));
    for (std::size_t i = 0; i < fleet.size(); ++i) {
      for (const SignalState& state : fleet[i]->Take(SteadyTime{0}).inputs.signals) {
        heard[i].insert(Number(state.id));
      }
    }
    for (const SignalState& state : observer.Take().signals) observed.insert(Number(state.id));
    return observed.size() == 4 && std::all_of(heard.begin(), heard.end(),
                                               [](const auto& heads) { return heads.size() == 4; });
  }));
}

}  // namespace
}  // namespace giveway::test
