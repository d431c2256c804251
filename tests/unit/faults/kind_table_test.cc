// The table of kinds against what other places say of kinds and parameters.
#include "services/faults/kind_table.h"

#include <gtest/gtest.h>

#include <set>

namespace giveway::faults {
namespace {

TEST(KindTable, HasARowAKindWithAWordOfItsOwn) {
  std::set<std::string_view> words;
  for (const KindRow& row : KindTable()) {
    EXPECT_TRUE(words.insert(row.word).second) << row.word;
    EXPECT_EQ(KindOf(row.word), row.kind);
    EXPECT_EQ(ToString(row.kind), row.word);
    EXPECT_FALSE(row.what.empty()) << row.word;
    EXPECT_NE(row.targets, 0U) << row.word;
  }
  EXPECT_EQ(words.size(), kKinds);
  EXPECT_EQ(KindOf("no_such_kind"), std::nullopt);
  EXPECT_EQ(KindOf(""), std::nullopt);
}

TEST(KindTable, UsualNumbersAreInTheirRanges) {
  for (const KindRow& row : KindTable()) {
    for (const QuantityRow& taken : row.numbers) {
      EXPECT_LE(taken.low, taken.usual) << row.word;
      EXPECT_LE(taken.usual, taken.high) << row.word;
      EXPECT_EQ(RowOf(row.kind, taken.quantity), &taken);
    }
  }
}

TEST(KindTable, FillingGivesEachKindAllItTakesAndNothingElse) {
  for (const KindRow& row : KindTable()) {
    const Parameters filled = Filled(row.kind, {});
    for (std::size_t i = 0; i < kQuantities; ++i) {
      const auto quantity = static_cast<Quantity>(i);
      const QuantityRow* taken = RowOf(row.kind, quantity);
      ASSERT_EQ(Get(filled, quantity).has_value(), taken != nullptr) << row.word;
      if (taken == nullptr) continue;
      EXPECT_EQ(Get(filled, quantity), taken->usual) << row.word;
    }
    EXPECT_EQ(filled.qos, row.usual_qos);
    EXPECT_EQ(filled.from, std::nullopt);
  }
}

TEST(KindTable, FillingLeavesWhatIsThere) {
  EXPECT_EQ(Filled(Kind::kLoss, {.probability = 0.7}).probability, 0.7);
  EXPECT_EQ(Filled(Kind::kChurn, {.count = 3}).count, 3U);
  EXPECT_EQ(Filled(Kind::kQosApply, {.qos = "mine.xml"}).qos, "mine.xml");
}

TEST(KindTable, EveryQuantityHasAFieldAndIsSetAndGot) {
  std::set<std::string_view> fields;
  for (std::size_t i = 0; i < kQuantities; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    Parameters parameters;
    Set(&parameters, quantity, 3);
    EXPECT_EQ(Get(parameters, quantity), 3);
    EXPECT_TRUE(fields.insert(FieldOf(quantity)).second) << FieldOf(quantity);
  }
}

TEST(KindTable, NamesTheKindThatWasMeant) {
  EXPECT_EQ(NearestKind("los"), "loss");
  EXPECT_EQ(NearestKind("sonar-off"), "sonar_off");
  EXPECT_EQ(NearestKind("restrat"), "restart");
  EXPECT_EQ(NearestKind("one_way"), "one_way_cut");
  EXPECT_FALSE(NearestKind(std::string(100000, 'x')).empty());
}

TEST(KindTable, SaysTargetsInWords) {
  EXPECT_EQ(TargetsOf(RowOf(Kind::kChurn)), "all");
  EXPECT_EQ(TargetsOf(RowOf(Kind::kKill)), "vehicle or discovery_server");
  EXPECT_EQ(TargetsOf(RowOf(Kind::kPause)), "vehicle, world, discovery_server or all");
  EXPECT_EQ(ToString(Target{Target::What::kVehicle, VehicleId{3}}), "vehicle 3");
  EXPECT_EQ(ToString(Target{Target::What::kWorld}), "world");
}

TEST(KindTable, WhatTheWorldDoesIsDoneInVirtualTimeToo) {
  for (const KindRow& row : KindTable()) {
    EXPECT_TRUE(row.in_virtual_time || row.actor != Actor::kWorld) << row.word;
    EXPECT_FALSE(row.in_virtual_time && row.actor == Actor::kAttacker) << row.word;
  }
}

}  // namespace
}  // namespace giveway::faults
