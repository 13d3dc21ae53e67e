#include "metrics/significance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

using Catch::WithinAbs;
using Catch::WithinRel;
using namespace rigcal::metrics;

TEST_CASE("significance: a difference of 1.96 standard errors has 5 %", "[metrics]") {
  // Quantile of the normal distribution, to its printed digits.
  CHECK_THAT(difference_p_value(-1.959963985 * 0.3, 0.3), WithinRel(0.05, 1e-8));
  CHECK(difference_p_value(0.0, 2.0) == 1.0);
  CHECK_THROWS_AS(difference_p_value(1.0, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(difference_p_value(std::numeric_limits<double>::quiet_NaN(), 1.0),
                  std::invalid_argument);
}

TEST_CASE("significance: Holm's steps, in the order of the input", "[metrics]") {
  // By hand: 4 x 0.005, 3 x 0.01, 2 x 0.03, 1 x 0.04 but not below 0.06.
  const std::vector<double> p = holm(std::vector<double>{0.04, 0.01, 0.03, 0.005});
  CHECK_THAT(p[3], WithinAbs(0.02, 1e-15));
  CHECK_THAT(p[1], WithinAbs(0.03, 1e-15));
  CHECK_THAT(p[2], WithinAbs(0.06, 1e-15));
  CHECK_THAT(p[0], WithinAbs(0.06, 1e-15));
  CHECK(holm(std::vector<double>{}).empty());
  CHECK(holm(std::vector<double>{0.9, 0.9}) == std::vector<double>{1.0, 1.0});
}

TEST_CASE("significance: sign test counts tails of a fair coin", "[metrics]") {
  // 2 (C(10,0) + C(10,1)) / 2^10
  CHECK_THAT(sign_test_p_value(9, 1), WithinRel(22.0 / 1024.0, 1e-12));
  CHECK_THAT(sign_test_p_value(1, 9), WithinRel(22.0 / 1024.0, 1e-12));
  CHECK(sign_test_p_value(5, 5) == 1.0);
  CHECK(sign_test_p_value(0, 0) == 1.0);
  CHECK_THROWS_AS(sign_test_p_value(-1, 2), std::invalid_argument);
}

TEST_CASE("significance: a trend is the exact line where the points lie on one", "[metrics]") {
  const std::vector<double> x{0.0, 1.0, 4.0, 6.0};
  std::vector<double> y;
  for (const double each : x) y.push_back(2.0 - 0.5 * each);
  const Trend trend = weighted_trend(x, y, std::vector<double>(4, 0.1));
  CHECK_THAT(trend.slope, WithinRel(-0.5, 1e-12));
  CHECK_THAT(trend.intercept, WithinRel(2.0, 1e-12));
  // sum (x - 2.75)^2 = 22.75; error 0.1 / sqrt(22.75)
  CHECK_THAT(trend.slope_standard_error, WithinRel(0.1 / std::sqrt(22.75), 1e-12));
  CHECK_THAT(trend.reduced_chi_square, WithinAbs(0.0, 1e-20));
  CHECK(trend.ci95_low < -0.5);
  CHECK(trend.ci95_high > -0.5);
}

TEST_CASE("significance: no slope is found significant at 5 % in 5 % of cases", "[metrics]") {
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise;
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  int found = 0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    std::vector<double> y;
    // Errors are stated three times too small: the scatter has to tell.
    for (std::size_t k = 0; k < x.size(); ++k) y.push_back(3.0 * noise(random));
    found += weighted_trend(x, y, std::vector<double>(x.size(), 1.0)).p_value < 0.05 ? 1 : 0;
  }
  // 200 expected, standard deviation 14; four of them.
  CHECK(found > 144);
  CHECK(found < 256);
}

TEST_CASE("significance: a trend needs three points at different places", "[metrics]") {
  using Values = std::vector<double>;
  CHECK_THROWS_AS(weighted_trend(Values{0, 1}, Values{0, 1}, Values{1, 1}), std::invalid_argument);
  CHECK_THROWS_AS(weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Values{1, 0, 1}),
                  std::invalid_argument);
  CHECK_THROWS_AS(weighted_trend(Values{1, 1, 1}, Values{0, 1, 2}, Values{1, 1, 1}),
                  std::domain_error);
}
