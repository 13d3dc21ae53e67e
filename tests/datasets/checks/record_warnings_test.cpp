#include "datasets/checks/record_warnings.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::datasets;

TEST_CASE("gathered_warnings: each text once, with its conditions", "[datasets]") {
  Record a;
  a.condition = "a";
  a.warnings = {"one", "all"};
  Record b;
  b.condition = "b";
  b.warnings = {"all"};
  Record c = b;
  c.condition = "c";
  const auto gathered = gathered_warnings({&a, &b, &c});
  REQUIRE(gathered.size() == 2);
  CHECK(gathered[0].with_conditions() == "recording of a: one");
  CHECK(gathered[1].with_conditions() == "recordings of 3 conditions (a, ...): all");
  CHECK(gathered[1].conditions == std::vector<std::string>{"a", "b", "c"});
  CHECK(gathered_warnings({}).empty());
}
