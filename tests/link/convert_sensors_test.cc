// Radar, lidar, camera and signals go to the wire and back unchanged, and values that are not
// finite, not known or too many are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/link/travel.h"

namespace giveway::test {
namespace {

using link::FromWire;
using link::ToWire;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Scan>
Scan Named() {
  Scan scan;
  scan.vehicle = VehicleId{1};
  scan.epoch = WorldEpoch{2};
  scan.tick = Tick{3};
  return scan;
}

template <typename Scan>
void ExpectNamed(const Scan& scan) {
  EXPECT_EQ(scan.vehicle, VehicleId{1});
  EXPECT_EQ(scan.epoch, WorldEpoch{2});
  EXPECT_EQ(scan.tick, Tick{3});
}

RadarScan FullRadar() {
  RadarScan scan = Named<RadarScan>();
  scan.count = kMaxDetections;
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    const auto x = static_cast<double>(i);
    scan.detections[i] = {0.1 * x, -0.2 * x, 0.3 * x, i % 2 == 1};
  }
  return scan;
}

LidarScan FullLidar() {
  LidarScan scan = Named<LidarScan>();
  for (std::size_t i = 0; i < kLidarBeams; ++i) {
    scan.echo[i] = static_cast<Echo>(i % 3);
    scan.range_m[i] = 0.01 * static_cast<double>(i);
  }
  return scan;
}

CameraScan FullCamera() {
  CameraScan scan = Named<CameraScan>();
  scan.count = kMaxDetections;
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    const auto x = static_cast<double>(i);
    scan.objects[i] = {static_cast<SeenClass>(i % 5), 0.1 * x, 0.2 * x};
  }
  return scan;
}

SignalState YellowSignal() {
  return {.id = SignalId{1},
          .epoch = WorldEpoch{2},
          .tick = Tick{3},
          .line_from_world = {4, 5},
          .line_to_world = {6, 7},
          .travel_rad = -1.5,
          .phase = SignalPhase::kYellow,
          .to_change_s = 2.5};
}

// True if a reader would let the wire sample through.
template <typename Ours, typename Wire>
bool Passes(const Wire& sample) {
  Ours back;
  return FromWire(Travelled(sample), back);
}

TEST(ConvertSensors, RadarComesBackFullAndEmpty) {
  const RadarScan sent = FullRadar();
  const RadarScan back = RoundTrip(sent);
  ExpectNamed(back);
  ASSERT_EQ(back.count, kMaxDetections);
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    EXPECT_EQ(back.detections[i].range_m, sent.detections[i].range_m) << i;
    EXPECT_EQ(back.detections[i].bearing_rad, sent.detections[i].bearing_rad) << i;
    EXPECT_EQ(back.detections[i].range_rate_m_s, sent.detections[i].range_rate_m_s) << i;
    EXPECT_EQ(back.detections[i].long_range, sent.detections[i].long_range) << i;
  }
  EXPECT_EQ(RoundTrip(Named<RadarScan>()).count, 0U);
}

TEST(ConvertSensors, LidarComesBackWithEveryBeam) {
  const LidarScan sent = FullLidar();
  const LidarScan back = RoundTrip(sent);
  ExpectNamed(back);
  EXPECT_EQ(back.echo, sent.echo);
  EXPECT_EQ(back.range_m, sent.range_m);
}

TEST(ConvertSensors, CameraComesBackFullAndEmpty) {
  const CameraScan sent = FullCamera();
  const CameraScan back = RoundTrip(sent);
  ExpectNamed(back);
  ASSERT_EQ(back.count, kMaxDetections);
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    EXPECT_EQ(back.objects[i].seen_class, sent.objects[i].seen_class) << i;
    EXPECT_EQ(back.objects[i].bearing_rad, sent.objects[i].bearing_rad) << i;
    EXPECT_EQ(back.objects[i].half_width_rad, sent.objects[i].half_width_rad) << i;
  }
  EXPECT_EQ(RoundTrip(Named<CameraScan>()).count, 0U);
}

TEST(ConvertSensors, ASignalComesBackInEveryPhase) {
  for (int phase = 0; phase <= static_cast<int>(SignalPhase::kGreen); ++phase) {
    SignalState sent = YellowSignal();
    sent.phase = static_cast<SignalPhase>(phase);
    const SignalState back = RoundTrip(sent);
    EXPECT_EQ(back.id, sent.id);
    EXPECT_EQ(back.epoch, sent.epoch);
    EXPECT_EQ(back.tick, sent.tick);
    EXPECT_EQ(back.line_from_world, sent.line_from_world);
    EXPECT_EQ(back.line_to_world, sent.line_to_world);
    EXPECT_EQ(back.travel_rad, sent.travel_rad);
    EXPECT_EQ(back.phase, sent.phase);
    EXPECT_EQ(back.to_change_s, sent.to_change_s);
  }
}

TEST(ConvertSensors, WhatIsNotFiniteIsRefused) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (auto field : {&RadarDetection::range_m, &RadarDetection::bearing_rad,
                       &RadarDetection::range_rate_m_s}) {
      RadarScan radar = FullRadar();
      radar.detections[kMaxDetections - 1].*field = bad;
      EXPECT_FALSE(Passes<RadarScan>(ToWire(radar)));
    }
    LidarScan lidar = FullLidar();
    lidar.range_m[kLidarBeams - 1] = bad;
    EXPECT_FALSE(Passes<LidarScan>(ToWire(lidar)));
    for (auto field : {&CameraObject::bearing_rad, &CameraObject::half_width_rad}) {
      CameraScan camera = FullCamera();
      camera.objects[kMaxDetections - 1].*field = bad;
      EXPECT_FALSE(Passes<CameraScan>(ToWire(camera)));
    }
    for (auto field : {&SignalState::travel_rad, &SignalState::to_change_s}) {
      SignalState signal = YellowSignal();
      signal.*field = bad;
      EXPECT_FALSE(Passes<SignalState>(ToWire(signal)));
    }
    for (auto point : {&SignalState::line_from_world, &SignalState::line_to_world}) {
      for (auto axis : {&Vec2::x, &Vec2::y}) {
        SignalState signal = YellowSignal();
        signal.*point.*axis = bad;
        EXPECT_FALSE(Passes<SignalState>(ToWire(signal)));
      }
    }
    RangeScan ranges;
    ranges.readings[kSensorCount - 1].fired_before_s = bad;
    EXPECT_FALSE(Passes<RangeScan>(ToWire(ranges)));
  }
}

TEST(ConvertSensors, OneMoreThanTheBoundIsRefused) {
  wire::RadarScan radar = ToWire(FullRadar());
  EXPECT_TRUE(Passes<RadarScan>(radar));
  radar.detections().resize(kMaxDetections + 1);
  EXPECT_FALSE(Passes<RadarScan>(radar));
  wire::CameraScan camera = ToWire(FullCamera());
  EXPECT_TRUE(Passes<CameraScan>(camera));
  camera.objects().resize(kMaxDetections + 1);
  EXPECT_FALSE(Passes<CameraScan>(camera));
}

TEST(ConvertSensors, AnEnumeratorItDoesNotKnowIsRefused) {
  wire::LidarScan lidar = ToWire(FullLidar());
  lidar.echo()[kLidarBeams - 1] = static_cast<wire::EchoKind>(3);
  EXPECT_FALSE(Passes<LidarScan>(lidar));
  wire::CameraScan camera = ToWire(FullCamera());
  camera.objects()[0].seen_class(static_cast<wire::SeenClass>(256));
  EXPECT_FALSE(Passes<CameraScan>(camera));
  wire::SignalState signal = ToWire(YellowSignal());
  signal.phase(static_cast<wire::SignalPhase>(4));
  EXPECT_FALSE(Passes<SignalState>(signal));
}

// Everything a brain would get of `scan` is a number.
bool IsFinite(const RadarScan& scan) {
  double sum = 0;
  for (std::uint32_t i = 0; i < scan.count; ++i) {
    sum += 0 * scan.detections[i].range_m + 0 * scan.detections[i].bearing_rad +
           0 * scan.detections[i].range_rate_m_s;
  }
  return sum == 0;
}

bool IsFinite(const CameraScan& scan) {
  double sum = 0;
  for (std::uint32_t i = 0; i < scan.count; ++i) {
    sum += 0 * scan.objects[i].bearing_rad + 0 * scan.objects[i].half_width_rad;
  }
  return sum == 0;
}

// Corrupts up to four bytes of a valid sample `kRounds` times; whatever then passes is valid too.
// Returns how many did not pass.
template <typename Ours>
int CorruptAndCountRefusals(const Ours& sound) {
  constexpr int kRounds = 20000;
  auto sample = ToWire(sound);
  using Wire = decltype(sample);
  typename link::TopicOf<Wire>::Type type;
  link::rtps::SerializedPayload_t payload(link::SerializedSize(type, &sample));
  EXPECT_TRUE(link::Serialize(type, &sample, payload));
  const std::uint32_t whole = payload.length;
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < kRounds; ++round) {
    payload.length = whole;
    EXPECT_TRUE(link::Serialize(type, &sample, payload));
    const unsigned bytes = random() % 4 + 1;
    for (unsigned i = 0; i < bytes; ++i) {
      payload.data[4 + random() % (whole - 4)] =
          static_cast<link::rtps::octet>(random() % 2 == 0 ? 0xff : random());
    }
    if (random() % 8 == 0) payload.length = static_cast<std::uint32_t>(random()) % whole;
    Wire arrived;
    Ours back;
    if (!link::Deserialize(type, payload, &arrived) || !FromWire(arrived, back)) {
      ++refused;
      continue;
    }
    EXPECT_LE(back.count, kMaxDetections);
    EXPECT_TRUE(IsFinite(back));
  }
  return refused;
}

TEST(ConvertSensors, SpoiltBytesNeverComeThroughAsAnUnsoundScan) {
  EXPECT_GT(CorruptAndCountRefusals(FullRadar()), 1000);
  EXPECT_GT(CorruptAndCountRefusals(FullCamera()), 1000);
}

TEST(ConvertSensors, ALidarScanFitsOneDatagramWithRoomToSpare) {
  wire::LidarScan sample = ToWire(FullLidar());
  link::TopicOf<wire::LidarScan>::Type type;
  EXPECT_EQ(link::SerializedSize(type, &sample), 4 + 2184U);  // 4: the representation
}

}  // namespace
}  // namespace giveway::test
