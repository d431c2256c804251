#include "services/fleetctl/record/export_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace giveway::fleetctl {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(ExportCsv, FieldsWithinOthersAreJoinedByDots) {
  EXPECT_THAT(
      Flattened(Json::parse(R"({"a":1,"p":{"x_m":-1.5,"y_m":2.0},"l":[1,2],"t":"a,b","f":true})")),
      ElementsAre(Pair("a", "1"), Pair("p.x_m", "-1.5"), Pair("p.y_m", "2"), Pair("l", "[1,2]"),
                  Pair("t", "a,b"), Pair("f", "true")));
}

TEST(ExportCsv, WhatDoesNotExistHasNoField) {
  Json sample;
  sample["a"] = nullptr;
  sample["b"]["c"] = std::numeric_limits<double>::quiet_NaN();
  sample["d"] = "null";
  EXPECT_THAT(Flattened(sample), ElementsAre(Pair("d", "null")));
}

TEST(ExportCsv, ARowStaysALineWhateverATextHolds) {
  Json sample;
  sample["t"] = "a \"b\" \\ \n\x01\xff";
  EXPECT_THAT(Flattened(sample), ElementsAre(Pair("t", "a \"b\" \\ \\n\\u0001\xef\xbf\xbd")));
}

TEST(ExportCsv, AFieldThatOnlyLaterRowsHaveKeepsItsColumn) {
  const FlatFields first{{"a", "1"}};
  const FlatFields second{{"a", "2"}, {"c", "3"}};
  CsvColumns columns;
  columns.Add(first);
  columns.Add(second);
  EXPECT_EQ(columns.Head(), "a,c\n");
  EXPECT_EQ(columns.Row(first), "1,\n");
  EXPECT_EQ(columns.Row(second), "2,3\n");
}

TEST(ExportCsv, CellsWithCommasAndQuotesAreQuoted) {
  CsvColumns columns;
  columns.Add({{"a", "1"}, {"b", "x"}});
  EXPECT_EQ(columns.Row({{"b", "x,\"y\""}}), ",\"x,\"\"y\"\"\"\n");
}

}  // namespace
}  // namespace giveway::fleetctl
