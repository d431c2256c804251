#include "services/fleetctl/record/export_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(ExportCsv, FieldsWithinOthersAreJoinedByDots) {
  EXPECT_THAT(Flattened(R"({"a":1,"p":{"x_m":-1.5,"y_m":2},"l":[1,2],"t":"a,b","f":true})"),
              ElementsAre(Pair("a", "1"), Pair("p.x_m", "-1.5"), Pair("p.y_m", "2"),
                          Pair("l", "[1,2]"), Pair("t", "a,b"), Pair("f", "true")));
}

TEST(ExportCsv, TheHeadComesOnceAndMissingFieldsAreEmpty) {
  CsvLines lines;
  EXPECT_EQ(lines.Add({{"a", "1"}, {"b", "x,\"y\""}}), "a,b\n1,\"x,\"\"y\"\"\"\n");
  EXPECT_EQ(lines.Add({{"b", "2"}, {"c", "3"}}), ",2\n");
}

}  // namespace
}  // namespace giveway::fleetctl
