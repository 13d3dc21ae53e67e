#include "model/signal/known_periods.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace rigcal::model;

namespace {

/// Two periods of three samples are known; two and a third are to be extrapolated.
const KnownPeriods kTwoOfThree{6, 3, 1.0};
const KnownPeriods kReversed{6, 3, -1.0};
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

TEST_CASE("known_periods: each with the other sign, where that is how they repeat", "[model]") {
  const std::vector known{1.0, 2.0, 3.0, -5.0, -4.0, -3.0};
  std::vector<double> column = known;
  column.resize(13, 0.0);
  continue_periods(kReversed, std::vector{0.0, 0.0, 0.0}, column);
  CHECK(column ==
        std::vector{1.0, 2.0, 3.0, -5.0, -4.0, -3.0, 5.0, 4.0, 3.0, -5.0, -4.0, -3.0, 5.0});
  // The last period is (5, 4, 3) and the one before it (1, 2, 3), both with the sign of the first.
  column = known;
  column.resize(13, 0.0);
  continue_periods(kReversed, std::vector{0.5, 0.75, 1.0}, column);
  CHECK(column ==
        std::vector{1.0, 2.0, 3.0, -5.0, -4.0, -3.0, 7.0, 5.0, 3.0, -8.0, -5.5, -3.0, 9.0});
  std::vector<double> ones(13, 1.0);
  add_changes(kReversed, std::vector{1.0, 0.0, -1.0}, column, ones);
  CHECK(ones == std::vector{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 5.0, 3.0, 1.0, 1.0, 1.0, 1.0, -3.0});
}
