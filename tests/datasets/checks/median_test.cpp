#include "datasets/checks/median.hpp"

#include <catch2/catch.hpp>

using rigcal::datasets::median;

TEST_CASE("median: the middle, or the mean of the middle two", "[datasets]") {
  CHECK(median({7.0}) == 7.0);
  CHECK(median({10.0, 2.0, 3.0}) == 3.0);
  CHECK(median({10.0, 1.0, 3.0, 2.0}) == 2.5);
}
