#include "report/store/table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"

using rigcal::report::parse_table;
using rigcal::report::Table;

TEST_CASE("table: numbers come back, empty fields as NaN, comments are skipped", "[report]") {
  const Table table = parse_table("# status: failed: why\ntime_s,a\n0.5,1e-3\n1,\n", "t.csv");
  REQUIRE(table.find("a") != nullptr);
  CHECK(*table.find("time_s") == std::vector<double>{0.5, 1.0});
  CHECK(table.find("a")->at(0) == 1e-3);
  CHECK(std::isnan(table.find("a")->at(1)));
  CHECK(table.find("b") == nullptr);
}

TEST_CASE("table: without a final newline, and without rows", "[report]") {
  CHECK(parse_table("x\n1\n2", "t.csv").columns.front().size() == 2);
  CHECK(parse_table("x,y\n", "t.csv").columns.size() == 2);
  CHECK(parse_table("", "t.csv").columns.empty());
  CHECK(parse_table("x,y", "t.csv").columns.size() == 2);
}

TEST_CASE("table: a name in quotes may contain a comma", "[report]") {
  const Table table = parse_table("time_s,\"leak[33,3 %]\"\n0,2\n", "t.csv");
  REQUIRE(table.find("leak[33,3 %]") != nullptr);
  CHECK(table.find("leak[33,3 %]")->front() == 2.0);
}

TEST_CASE("table: says where it is broken", "[report]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(parse_table("a,b\n1,2\n3,x\n", "t.csv"), Contains("t.csv:3:3"));
  CHECK_THROWS_WITH(parse_table("a,b\n1,2\n3\n", "t.csv"), Contains("t.csv:3"));
  CHECK_THROWS_WITH(parse_table("a,b\n1,2,3\n", "t.csv"),
                    Contains("t.csv:2:5") && Contains("2 fields"));
  CHECK_THROWS_AS(parse_table("a\ninf\n", "t.csv"), rigcal::InputError);
  CHECK_THROWS_AS(parse_table("a\n1;2\n", "t.csv"), rigcal::InputError);
}

TEST_CASE("table: instants are there and increase", "[report]") {
  CHECK_NOTHROW(parse_table("time_s,a\n-1,\n0,2\n1e-3,\n", "t.csv"));
  for (const char* time : {"", "0", "1", "-1", "nan", "1e-300"}) {
    CAPTURE(time);
    const std::string text = std::string("a,time_s\n1,0\n2,1\n3,") + time + "\n4,3\n";
    CHECK_THROWS_WITH(parse_table(text, "t.csv"),
                      Catch::Contains("t.csv:4:") && Catch::Contains("'time_s'"));
  }
  CHECK_NOTHROW(parse_table("other_s\n1\n0\n", "t.csv"));
}
