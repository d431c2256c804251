#include <gmock/gmock.h>

#include <map>
#include <utility>
#include <vector>

#include "services/types/math/random.h"
#include "tests/bench/baseline/tiles.h"

namespace giveway::bench {
namespace {

using testing::ElementsAre;

constexpr Ground kField = {{0, 0}, {4, 3}, 0.5};  // eight columns, six rows

std::vector<Tile> Under(const TileBook& book, Vec2 centre, double radius_m) {
  std::vector<Tile> tiles;
  book.TilesUnder(centre, radius_m, &tiles);
  return tiles;
}

TEST(Tiles, ADiscCoversTheTilesItTouchesAndNotTheCornersItMisses) {
  const TileBook book(kField);
  EXPECT_THAT(Under(book, {0.75, 0.75}, 0.2), ElementsAre(9));
  EXPECT_THAT(Under(book, {0.75, 0.75}, 0.3), ElementsAre(1, 8, 9, 10, 17));
  EXPECT_THAT(Under(book, {0.75, 0.75}, 0.4), ElementsAre(0, 1, 2, 8, 9, 10, 16, 17, 18));
}

TEST(Tiles, WhatLiesOutsideTheGroundIsNobodys) {
  const TileBook book(kField);
  EXPECT_THAT(Under(book, {0, 0}, 0.2), ElementsAre(0));
  EXPECT_TRUE(Under(book, {-1, -1}, 0.2).empty());
}

TEST(Tiles, OneTakenTileRefusesAll) {
  TileBook book(kField);
  EXPECT_TRUE(book.Book(std::vector<Tile>{3, 4}, 7));
  EXPECT_FALSE(book.Book(std::vector<Tile>{4, 5}, 7));
  EXPECT_FALSE(book.IsTaken(5, 7));
  EXPECT_TRUE(book.Book(std::vector<Tile>{4, 5}, 8));
}

TEST(Tiles, WhereOneStandsNobodyElseMayBeLater) {
  TileBook book(kField);
  const std::vector<Tile> place = {3};
  ASSERT_TRUE(book.BookFrom(place, 5));
  EXPECT_TRUE(book.Book(place, 4));
  EXPECT_FALSE(book.Book(place, 5));
  EXPECT_FALSE(book.Book(place, 500));
  EXPECT_FALSE(book.BookFrom(place, 900));
}

TEST(Tiles, NobodyMayStayWhereSomeoneComesLater) {
  TileBook book(kField);
  const std::vector<Tile> place = {3};
  ASSERT_TRUE(book.Book(place, 9));
  EXPECT_FALSE(book.BookFrom(place, 9));
  EXPECT_FALSE(book.IsTaken(3, 20));
  EXPECT_TRUE(book.BookFrom(place, 10));
}

TEST(Tiles, APlaceGivenBackIsFree) {
  TileBook book(kField);
  const std::vector<Tile> place = {3};
  ASSERT_TRUE(book.BookFrom(place, 0));
  book.GiveBack(place);
  EXPECT_TRUE(book.Book(place, 6));
}

TEST(Tiles, NoTileIsEverBookedTwice) {
  TileBook book(kField);
  Random dice(4);
  std::map<std::pair<Tile, Step>, int> owner;
  int granted = 0;
  for (int asker = 0; asker < 3000; ++asker) {
    const Step step = static_cast<Step>(dice.Next() % 40);
    const std::vector<Tile> tiles =
        Under(book, {dice.Uniform(0, 4), dice.Uniform(0, 3)}, dice.Uniform(0.1, 0.8));
    if (!book.Book(tiles, step)) continue;
    ++granted;
    for (const Tile tile : tiles) {
      ASSERT_TRUE(owner.emplace(std::pair{tile, step}, asker).second) << tile << " at " << step;
    }
  }
  EXPECT_GT(granted, 200);
  EXPECT_LT(granted, 2900);
}

}  // namespace
}  // namespace giveway::bench
