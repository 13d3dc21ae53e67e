#include "model/known_periods.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace rigcal::model;

namespace {

/// Two periods of three samples are known; two and a third are to come.
const KnownPeriods kTwoOfThree{6, 3};
std::vector<double> two_periods() {
  return {1.0, 2.0, 3.0, 5.0, 4.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
}

}  // namespace

TEST_CASE("known_periods: without a share the last period is repeated", "[model]") {
  std::vector<double> column = two_periods();
  continue_periods(kTwoOfThree, std::vector{0.0, 0.0, 0.0}, column);
  CHECK(column == std::vector{1.0, 2.0, 3.0, 5.0, 4.0, 3.0, 5.0, 4.0, 3.0, 5.0, 4.0, 3.0, 5.0});
}

TEST_CASE("known_periods: each period adds its share of the last change", "[model]") {
  std::vector<double> column = two_periods();
  continue_periods(kTwoOfThree, std::vector{0.5, 0.75, 1.0}, column);
  CHECK(column == std::vector{1.0, 2.0, 3.0, 5.0, 4.0, 3.0, 7.0, 5.0, 3.0, 8.0, 5.5, 3.0, 9.0});
}

TEST_CASE("known_periods: the changes of one column are added to another", "[model]") {
  std::vector<double> column(13, 1.0);
  add_changes(kTwoOfThree, std::vector{1.0, 0.0, -1.0}, two_periods(), column);
  CHECK(column == std::vector{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 5.0, 3.0, 1.0, 1.0, 1.0, 1.0, -3.0});
}
