#include "services/fleetctl/soak/soak_watch.h"

#include <gmock/gmock.h>

#include "services/fleetctl/soak/soak_verdict.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

VehicleStatus Driving(VehicleId vehicle) {
  VehicleStatus status;
  status.vehicle = vehicle;
  status.decision = {Mode::kCooperative, Rule::kCruise};
  status.forward_m_s = 0.3;
  return status;
}

faults::Fault On(VehicleId vehicle, faults::Kind kind, double for_s) {
  faults::Fault fault;
  fault.kind = kind;
  fault.for_s = for_s;
  fault.target.vehicle = vehicle;
  return fault;
}

class SoakWatchTest : public testing::Test {
 protected:
  void Publish(const VehicleStatus& status, SteadyTime now) {
    link::Observed observed;
    observed.statuses.push_back(status);
    watch_.Fold(observed, now);
  }
  std::optional<SteadyTime> NoticedBy(Mechanism mechanism) const {
    return watch_.Courses()[0].noticed[static_cast<std::size_t>(mechanism)];
  }
  faults::Schedule schedule_{On(kOne, faults::Kind::kPause, 2), On(kTwo, faults::Kind::kLoss, 2),
                             On(kTwo, faults::Kind::kKill, 0)};
  SoakWatch watch_{{kOne, kTwo}, schedule_};
};

TEST_F(SoakWatchTest, HasTheHeapOfAFreshStatusThatSaysIt) {
  EXPECT_EQ(watch_.HeapOf(kOne, seconds(1)), std::nullopt);
  VehicleStatus status = Driving(kOne);
  Publish(status, seconds(1));
  EXPECT_EQ(watch_.HeapOf(kOne, seconds(1)), std::nullopt);
  status.heap_bytes = 4096;
  Publish(status, seconds(2));
  EXPECT_EQ(watch_.HeapOf(kOne, seconds(3)), 4096);
  EXPECT_EQ(watch_.HeapOf(kOne, seconds(3) + milliseconds(1)), std::nullopt);
  EXPECT_EQ(watch_.HeapOf(kTwo, seconds(2)), std::nullopt);
}

// A corruption of 2 % of the packets that a cut kept away, all but ten, was said to have no effect.
TEST(SoakWatch, AFaultThatMetTooFewPacketsToActOnIsNotOneWithoutEffect) {
  const auto why = [](faults::Kind kind, double share, std::uint64_t packets, std::uint64_t cut) {
    faults::Schedule schedule{On(kTwo, kind, 2)};
    schedule[0].parameters.probability = share;
    SoakWatch watch({kOne, kTwo}, schedule);
    const auto publish = [&](SteadyTime now) {
      VehicleStatus status = Driving(kTwo);
      if (now > seconds(2)) status.impaired = {.packets = packets, .dropped_blackout = cut};
      link::Observed observed;
      observed.statuses.push_back(status);
      watch.Fold(observed, now);
    };
    publish(seconds(1));
    watch.NoteBegin(0, seconds(2));
    watch.NoteEnd(0, seconds(4));
    publish(seconds(4) + milliseconds(100));
    EXPECT_EQ(watch.Courses()[0].effect, "");
    return watch.Courses()[0].met_nothing;
  };
  EXPECT_EQ(why(faults::Kind::kCorrupt, 0.02, 1000, 990),
            "it met 10 packets, and acts on a share of 0.02");
  EXPECT_EQ(why(faults::Kind::kCorrupt, 0.02, 1000, 0), "");
  EXPECT_EQ(why(faults::Kind::kLoss, 0.3, 1000, 990),
            "it met 10 packets, and acts on a share of 0.3");
  EXPECT_EQ(why(faults::Kind::kLoss, 0.3, 1000, 900), "");
  EXPECT_NE(why(faults::Kind::kDelay, 0, 1000, 1000), "");
  EXPECT_EQ(why(faults::Kind::kDelay, 0, 1000, 999), "");
}

TEST(SoakWatch, OneIsWellThatDrivesOrStandsAsTrafficHasIt) {
  VehicleStatus status = Driving(kOne);
  EXPECT_TRUE(IsWell(status));
  status.forward_m_s = 0;
  EXPECT_FALSE(IsWell(status)) << "cruises, and does not move";
  status.decision.rule = Rule::kGiveWay;
  EXPECT_TRUE(IsWell(status));
  for (const Rule rule :
       {Rule::kRangesStale, Rule::kUnidentifiedMotion, Rule::kPeerLost, Rule::kNotRunning}) {
    status.decision.rule = rule;
    EXPECT_FALSE(IsWell(status)) << Name(rule);
  }
  status = Driving(kOne);
  status.decision.mode = Mode::kHalt;
  EXPECT_FALSE(IsWell(status));
}

TEST_F(SoakWatchTest, WhoIsSilentForASecondIsNotWell) {
  Publish(Driving(kOne), seconds(1));
  Publish(Driving(kTwo), milliseconds(1900));
  EXPECT_TRUE(watch_.AreAllWell(seconds(2)));
  EXPECT_THAT(watch_.Unwell(milliseconds(2100)), ElementsAre(kOne));
}

TEST_F(SoakWatchTest, OfWhoIsAwayNothingIsExpectedAndOfNobodyNothingIsWell) {
  Publish(Driving(kOne), seconds(1));
  watch_.SetAway(kTwo, true);
  EXPECT_TRUE(watch_.AreAllWell(seconds(1)));
  watch_.SetAway(kOne, true);
  EXPECT_FALSE(watch_.AreAllWell(seconds(1)));
  EXPECT_EQ(watch_.Living(), 0U);
}

TEST_F(SoakWatchTest, AFaultIsNoticedWhenTheFirstPeerSaysSo) {
  watch_.NoteBegin(0, seconds(10));
  watch_.Fold(kTwo, {seconds(9), LogEventKind::kBeaconStale, kOne});
  watch_.Fold(kOne, {milliseconds(10100), LogEventKind::kDeadlineMissed, kOne});
  watch_.Fold(kTwo, {milliseconds(10100), LogEventKind::kBeaconHeard, kOne});
  EXPECT_FALSE(NoticedBy(Mechanism::kDeadline));
  watch_.Fold(kTwo, {milliseconds(10200), LogEventKind::kDeadlineMissed, kOne});
  watch_.Fold(kTwo, {milliseconds(10300), LogEventKind::kLivelinessLost, kOne});
  watch_.Fold(kTwo, {milliseconds(10400), LogEventKind::kDeadlineMissed, kOne});
  EXPECT_EQ(NoticedBy(Mechanism::kDeadline), milliseconds(10200));
  EXPECT_EQ(NoticedBy(Mechanism::kLiveliness), milliseconds(10300));
  EXPECT_FALSE(NoticedBy(Mechanism::kBeaconAge));
}

TEST_F(SoakWatchTest, AFaultIsOverForItsVictimWhenThatIsWellAgain) {
  Publish(Driving(kOne), seconds(9));
  watch_.NoteBegin(0, seconds(10));
  watch_.NoteEnd(0, seconds(12));
  Publish(Driving(kTwo), milliseconds(12600));
  EXPECT_FALSE(watch_.Courses()[0].recovered) << "the other one drives";
  Publish(Driving(kOne), milliseconds(12700));
  EXPECT_EQ(watch_.Courses()[0].recovered, milliseconds(12700));
}

TEST_F(SoakWatchTest, ALaterAttemptSettlesThatAFaultWasNotUndone) {
  watch_.NoteBegin(0, seconds(10));
  watch_.NoteEffect(0, "another set in effect");
  watch_.NoteNotUndone(0, "no answer", false);
  EXPECT_TRUE(watch_.Courses()[0].not_undone);
  watch_.NoteNotUndone(0, "it is gone", true);
  EXPECT_FALSE(watch_.Courses()[0].not_undone);
  watch_.NoteNotUndone(0, "no answer", false);
  watch_.AddToEffect(0, ", and its own again");
  EXPECT_FALSE(watch_.Courses()[0].not_undone);
  EXPECT_THAT(watch_.Courses()[0].failure, IsEmpty());
}

TEST_F(SoakWatchTest, ACutIsNotSeenByWhatIsLostForOtherCauses) {
  schedule_[1].kind = faults::Kind::kPartition;
  VehicleStatus status = Driving(kTwo);
  Publish(status, seconds(9));
  watch_.NoteBegin(1, seconds(10));
  status.impaired.dropped_loss = 40;
  Publish(status, seconds(11));
  EXPECT_EQ(watch_.Courses()[1].effect, "");
  status.impaired.dropped_blackout = 3;
  Publish(status, seconds(12));
  EXPECT_EQ(watch_.Courses()[1].effect, "vehicle 2 counted 3 packets");
}

TEST_F(SoakWatchTest, ALimitMayEndItsOwnProcessAlone) {
  schedule_[0].kind = faults::Kind::kMemoryLimit;
  const auto at = [](VehicleId vehicle) {
    return [vehicle](const faults::Fault& fault) { return fault.target.vehicle == vehicle; };
  };
  watch_.NoteBegin(0, seconds(10));
  watch_.NoteBegin(1, seconds(12));
  EXPECT_TRUE(watch_.MayEndProcess(at(kOne), seconds(13)));
  EXPECT_FALSE(watch_.MayEndProcess(at(kTwo), seconds(13))) << "it has another fault";
  watch_.NoteEnd(0, seconds(15));
  EXPECT_TRUE(watch_.MayEndProcess(at(kOne), seconds(24)));
  EXPECT_FALSE(watch_.MayEndProcess(at(kOne), seconds(26)));
}

TEST_F(SoakWatchTest, AFaultIsOpenUntilNothingMoreCanBeLearntOfIt) {
  watch_.NoteBegin(2, seconds(10));
  watch_.NoteBegin(0, seconds(11));
  EXPECT_THAT(watch_.Open(), ElementsAre(2, 0));
  watch_.NoteEnd(0, seconds(13));
  Publish(Driving(kTwo), milliseconds(20100));
  EXPECT_THAT(watch_.Open(), ElementsAre(0)) << "a killed vehicle does not recover";
  Publish(Driving(kOne), seconds(22));
  EXPECT_THAT(watch_.Open(), ElementsAre(0)) << "a peer may still say that it noticed";
  Publish(Driving(kOne), seconds(24));
  EXPECT_THAT(watch_.Open(), testing::IsEmpty());
}

TEST_F(SoakWatchTest, AHearersFaultIsSeenByWhatItCounts) {
  VehicleStatus status = Driving(kTwo);
  status.impaired.dropped_loss = 7;
  Publish(status, seconds(9));
  watch_.NoteBegin(1, seconds(10));
  Publish(status, milliseconds(10500));
  EXPECT_EQ(watch_.Courses()[1].effect, "");
  VehicleStatus other = Driving(kOne);
  other.impaired.dropped_loss = 100;
  Publish(other, milliseconds(10600));
  EXPECT_EQ(watch_.Courses()[1].effect, "") << "not the target";
  status.impaired.dropped_loss = 9;
  Publish(status, seconds(11));
  EXPECT_THAT(watch_.Courses()[1].effect, HasSubstr("counted 2 packets"));
}

TEST_F(SoakWatchTest, ALimitedRateIsSeenWhereOtherFaultsLeaveLessThanItPasses) {
  const faults::Schedule schedule{On(kTwo, faults::Kind::kRate, 2)};
  SoakWatch watch({kTwo}, schedule);
  link::Observed observed;
  const auto say = [&](std::uint64_t metered, SteadyTime now) {
    observed.statuses = {Driving(kTwo)};
    observed.statuses.front().impaired.metered = metered;
    observed.statuses.front().impaired.dropped_blackout = 1000 + metered;
    watch.Fold(observed, now);
  };
  say(0, seconds(9));
  watch.NoteBegin(0, seconds(10));
  say(0, seconds(11));
  EXPECT_EQ(watch.Courses()[0].effect, "");
  say(40, seconds(12));
  EXPECT_THAT(watch.Courses()[0].effect, HasSubstr("counted 40 packets"));
}

// A vehicle's status that counts an intruder's packets.
VehicleStatus Attacked(VehicleId vehicle, PacketDrop drop, std::uint64_t packets) {
  VehicleStatus status = Driving(vehicle);
  status.packets.packets[static_cast<std::size_t>(drop)] = packets;
  return status;
}

// The effect of a fault of that kind on the second vehicle, from a status before it and one after.
std::string EffectOf(faults::Kind kind, const VehicleStatus& before, const VehicleStatus& now) {
  const faults::Schedule schedule{On(kTwo, kind, 2)};
  SoakWatch watch({kOne, kTwo}, schedule);
  link::Observed observed;
  observed.statuses = {before};
  watch.Fold(observed, seconds(9));
  watch.NoteBegin(0, seconds(10));
  observed.statuses = {now};
  watch.Fold(observed, seconds(11));
  return watch.Courses()[0].effect;
}

TEST(SoakWatch, AFloodIsSeenByPacketsThatTheTargetsFilterDropsAsNoneOfRtps) {
  const auto none = Attacked(kTwo, PacketDrop::kNotRtps, 5);
  const auto some = Attacked(kTwo, PacketDrop::kNotRtps, 25);
  const auto other = Attacked(kTwo, PacketDrop::kMalformed, 25);
  EXPECT_THAT(EffectOf(faults::Kind::kFlooded, none, some), HasSubstr("counted 20 packets"));
  EXPECT_EQ(EffectOf(faults::Kind::kFlooded, none, none), "");
  EXPECT_EQ(EffectOf(faults::Kind::kFlooded, Driving(kTwo), other), "");
  EXPECT_EQ(
      EffectOf(faults::Kind::kFlooded, Driving(kOne), Attacked(kOne, PacketDrop::kNotRtps, 9)), "")
      << "not the target";
}

TEST(SoakWatch, MalformedPacketsAreSeenByWhateverTheFilterDropsThemFor) {
  for (const PacketDrop drop :
       {PacketDrop::kMalformed, PacketDrop::kListTooLong, PacketDrop::kStatistics}) {
    EXPECT_THAT(EffectOf(faults::Kind::kMalformed, Driving(kTwo), Attacked(kTwo, drop, 3)),
                HasSubstr("counted 3 packets"))
        << Name(drop);
  }
  for (const PacketDrop drop :
       {PacketDrop::kNone, PacketDrop::kNotRtps, PacketDrop::kSequenceJump}) {
    EXPECT_EQ(EffectOf(faults::Kind::kMalformed, Driving(kTwo), Attacked(kTwo, drop, 3)), "")
        << Name(drop);
  }
}

TEST(SoakWatch, ASpoofedVehicleIsSeenByWhatItsPeersRefuse) {
  const auto refused_by = [](VehicleId vehicle) {
    VehicleStatus status = Driving(vehicle);
    status.beacons.rejected_wrong_name = 4;
    status.beacons.rejected_own = 3;
    return status;
  };
  EXPECT_THAT(EffectOf(faults::Kind::kSpoofed, Driving(kOne), refused_by(kOne)),
              HasSubstr("vehicle 1 counted 7 beacons"));
  EXPECT_EQ(EffectOf(faults::Kind::kSpoofed, Driving(kTwo), refused_by(kTwo)), "");
}

TEST(SoakWatch, NoCounterShowsAReplay) {
  VehicleStatus status = Attacked(kTwo, PacketDrop::kNone, 900);
  status.beacons.rejected_replayed = 3;
  status.impaired.dropped_loss = 3;
  EXPECT_EQ(EffectOf(faults::Kind::kReplayed, Driving(kTwo), status), "");
}

TEST_F(SoakWatchTest, AFaultOfTheWorldIsSeenWhenTheWorldSaysSo) {
  const faults::Schedule schedule{On(kOne, faults::Kind::kSonarStuck, 2)};
  SoakWatch watch({kOne}, schedule);
  link::Observed observed;
  WorldEvent& event = observed.events.emplace_back();
  event.kind = EventKind::kFaultBegan;
  event.vehicle = kOne;
  event.text = "sonar_stuck 1 of ";
  watch.Fold(observed, seconds(1));
  EXPECT_EQ(watch.Courses()[0].effect, "") << "another fault of the rule";
  event.text = "sonar_stuck 0 of ";
  watch.Fold(observed, seconds(1));
  EXPECT_NE(watch.Courses()[0].effect, "");
}

TEST_F(SoakWatchTest, ANewLifeOfAHearerIsCountedAnew) {
  VehicleStatus status = Driving(kTwo);
  status.impaired.dropped_loss = 70;
  Publish(status, seconds(9));
  watch_.NoteBegin(1, seconds(10));
  status.impaired.dropped_loss = 1;
  Publish(status, seconds(11));
  EXPECT_EQ(watch_.Courses()[1].effect, "");
  status.impaired.dropped_loss = 2;
  Publish(status, milliseconds(11500));
  EXPECT_NE(watch_.Courses()[1].effect, "");
}

TEST_F(SoakWatchTest, ACounterThatRisesLongAfterIsNotItsEffect) {
  VehicleStatus status = Driving(kTwo);
  Publish(status, seconds(9));
  watch_.NoteBegin(1, seconds(10));
  watch_.NoteEnd(1, seconds(12));
  status.impaired.dropped_loss = 1;
  Publish(status, seconds(20));
  EXPECT_EQ(watch_.Courses()[1].effect, "");
}

// The verdict came when the monitor of pauses had forgotten those of ten minutes ago.
TEST_F(SoakWatchTest, TheMachinesPauseIsNotedWhileItIsKnown) {
  Limits limits;
  limits.beacon_period = milliseconds(50);
  limits.deadline = milliseconds(150);
  std::vector<SteadyTime> asked;
  const auto longest = [&](SteadyTime from, SteadyTime to) {
    asked.insert(asked.end(), {from, to});
    return asked.size() == 2 ? milliseconds(500) : milliseconds(0);
  };
  watch_.NoteBegin(0, seconds(10));
  const SteadyTime latest = LatestReport(seconds(10), ExpectedOf(schedule_[0], limits).at(0));
  watch_.NotePauses(limits, latest, longest);
  EXPECT_THAT(asked, IsEmpty()) << "a pause may not be over";
  watch_.NotePauses(limits, latest + seconds(1), longest);
  watch_.NotePauses(limits, latest + seconds(2), longest);
  EXPECT_THAT(asked, ElementsAre(seconds(10), latest));
  const auto& paused = watch_.Courses()[0].paused;
  EXPECT_EQ(paused[static_cast<std::size_t>(Mechanism::kDeadline)], milliseconds(500));
  EXPECT_FALSE(paused[static_cast<std::size_t>(Mechanism::kLiveliness)]) << "off in this set";
}

TEST_F(SoakWatchTest, AFailureIsSettledByAnEffectAndOneToUndoItByWhatFollows) {
  watch_.NoteBegin(1, seconds(10));
  watch_.NoteFailure(1, "refused");
  watch_.AddToEffect(1, ", and undone");
  EXPECT_EQ(watch_.Courses()[1].effect, "") << "there was none to add to";
  watch_.NoteFailure(1, "refused");
  watch_.NoteEffect(1, "taken");
  EXPECT_EQ(watch_.Courses()[1].failure, "");
  watch_.NoteFailure(1, "not undone");
  EXPECT_EQ(watch_.Courses()[1].failure, "not undone");
  watch_.AddToEffect(1, ", and undone");
  EXPECT_EQ(watch_.Courses()[1].effect, "taken, and undone");
  EXPECT_EQ(watch_.Courses()[1].failure, "");
}

}  // namespace
}  // namespace giveway::fleetctl
