#include "diagnosis/parity/alarm_threshold.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal;
using diagnosis::alarm_threshold;
using diagnosis::moving_rms;

TEST_CASE("alarm_threshold: the prediction bound of a logarithm", "[diagnosis]") {
  // The logarithms 1, 2, 3 have mean 2 and sd 1. The bound is t(2; 0.95) = 2.9199856 (tables) times
  // sqrt(4/3).
  const std::vector<double> healthy{std::exp(1.0), std::exp(2.0), std::exp(3.0)};
  CHECK_THAT(*alarm_threshold(healthy, 0.05),
             Catch::WithinRel(std::exp(2.0 + 2.91998558 * std::sqrt(4.0 / 3.0)), 1e-7));
  CHECK_FALSE(alarm_threshold(std::vector<double>{1.0, 2.0}, 0.05));
  CHECK_FALSE(alarm_threshold(std::vector<double>{1.0, 2.0, 0.0}, 0.05));
}

TEST_CASE("alarm_threshold: exceeded as often as stated", "[diagnosis]") {
  auto stream = datasets::random_stream(11, {"alarms"});
  for (const std::size_t n : {3, 5, 20}) {
    CAPTURE(n);
    constexpr int kTrials = 20000;
    int alarms = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> healthy(n);
      for (double& value : healthy) value = std::exp(datasets::normal(stream, 0.3));
      if (std::exp(datasets::normal(stream, 0.3)) > *alarm_threshold(healthy, 0.05)) ++alarms;
    }
    // The tolerance is four standard errors of the fraction.
    CHECK(std::abs(alarms / static_cast<double>(kTrials) - 0.05) <
          4.0 * std::sqrt(0.05 * 0.95 / kTrials));
  }
}

TEST_CASE("moving_rms: of the last samples; what is not there counts as zero", "[diagnosis]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> x{3.0, -4.0, 0.0, nan, 6.0, 8.0, 0.0};
  const auto found = moving_rms(x, 2);
  REQUIRE(found.size() == x.size());
  CHECK_THAT(found[0], Catch::WithinRel(std::sqrt(4.5), 1e-14));
  CHECK_THAT(found[1], Catch::WithinRel(std::sqrt(12.5), 1e-14));
  CHECK_THAT(found[2], Catch::WithinRel(std::sqrt(8.0), 1e-14));
  CHECK(std::isnan(found[3]));
  CHECK_THAT(found[4], Catch::WithinRel(std::sqrt(18.0), 1e-14));
  CHECK_THAT(found[5], Catch::WithinRel(std::sqrt(50.0), 1e-14));
  CHECK_THAT(found[6], Catch::WithinRel(std::sqrt(32.0), 1e-14));
  CHECK(moving_rms(x, 1)[1] == 4.0);
}

TEST_CASE("threshold_with: one cause is the prediction bound of t, several are wider than each",
          "[diagnosis]") {
  using diagnosis::CausePart;
  // sqrt(F(0.99; 1, 4)) = t(0.995; 4) = 4.6041.
  const std::array<CausePart, 1> one{CausePart{4.0, 4.0}};
  CHECK_THAT(diagnosis::threshold_with(0.0, one, 0.01), Catch::WithinRel(2.0 * 4.604095, 1e-6));
  CHECK_THAT(diagnosis::threshold_with(3.0, one, 0.01),
             Catch::WithinRel(std::hypot(3.0, 2.0 * 4.604095), 1e-6));
  CHECK(diagnosis::threshold_with(3.0, {}, 0.01) == 3.0);
  // Two equal causes that are known exactly: chi-square with two degrees of freedom exceeds 9.2103
  // in 1 % of cases.
  const std::array<CausePart, 2> two{CausePart{1.0, 1e9}, CausePart{1.0, 1e9}};
  CHECK_THAT(diagnosis::threshold_with(0.0, two, 0.01), Catch::WithinRel(std::sqrt(9.21034), 1e-4));
}
