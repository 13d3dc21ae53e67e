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
  // Quantile of the normal distribution, with as many digits as printed in tables.
  CHECK_THAT(difference_p_value(-1.959963985 * 0.3, {0.3}), WithinRel(0.05, 1e-8));
  CHECK(difference_p_value(0.0, {2.0}) == 1.0);
  CHECK_THROWS_AS(difference_p_value(1.0, {0.0}), std::invalid_argument);
  CHECK_THROWS_AS(difference_p_value(std::numeric_limits<double>::quiet_NaN(), {1.0}),
                  std::invalid_argument);
}

TEST_CASE("significance: Holm's steps, in the order of the input", "[metrics]") {
  // By hand: 4 x 0.005, 3 x 0.01, 2 x 0.03, and 1 x 0.04, which must not be below 0.06.
  const std::vector<double> p = holm(std::vector<double>{0.04, 0.01, 0.03, 0.005});
  CHECK_THAT(p[3], WithinAbs(0.02, 1e-15));
  CHECK_THAT(p[1], WithinAbs(0.03, 1e-15));
  CHECK_THAT(p[2], WithinAbs(0.06, 1e-15));
  CHECK_THAT(p[0], WithinAbs(0.06, 1e-15));
  CHECK(holm(std::vector<double>{}).empty());
  CHECK(holm(std::vector<double>{0.9, 0.9}) == std::vector<double>{1.0, 1.0});
}

TEST_CASE("significance: the degrees of freedom of a quantile", "[metrics]") {
  // 97.5 % quantiles of Student's t from printed tables.
  CHECK_THAT(freedom_of_quantile(2.776445), WithinRel(4.0, 1e-5));
  CHECK_THAT(freedom_of_quantile(2.042272), WithinRel(30.0, 1e-4));
  CHECK(freedom_of_quantile(1.96) > 5e4);
  CHECK(freedom_of_quantile(1.9) == kManyDegrees);
  CHECK(freedom_of_quantile(std::numeric_limits<double>::quiet_NaN()) == kManyDegrees);
  CHECK(freedom_of_quantile(100.0) == 1.0);
}

TEST_CASE("significance: sign test counts tails of a fair coin", "[metrics]") {
  // 2 (C(10,0) + C(10,1)) / 2^10
  CHECK_THAT(sign_test_p_value(9, 1), WithinRel(22.0 / 1024.0, 1e-12));
  CHECK_THAT(sign_test_p_value(1, 9), WithinRel(22.0 / 1024.0, 1e-12));
  CHECK(sign_test_p_value(5, 5) == 1.0);
  CHECK(sign_test_p_value(0, 0) == 1.0);
  CHECK_THROWS_AS(sign_test_p_value(-1, 2), std::invalid_argument);
}

TEST_CASE("significance: a difference by few degrees of freedom is one of Student's t",
          "[metrics]") {
  // 97.5 % quantiles of t with 2 and 5 degrees of freedom, as printed in tables.
  CHECK_THAT(difference_p_value(4.302652730 * 0.2, {0.2, 2.0}), WithinRel(0.05, 1e-8));
  CHECK_THAT(difference_p_value(-2.570581836 * 0.2, {0.2, 5.0}), WithinRel(0.05, 1e-8));
  CHECK_THROWS_AS(difference_p_value(1.0, {1.0, 0.0}), std::invalid_argument);
  // By hand: (9 + 16)^2 / (81 / 4 + 256 / 9) = 12.83.
  const EstimateError both = error_of_difference({3.0, 4.0}, {4.0, 9.0});
  CHECK_THAT(both.standard_error, WithinRel(5.0, 1e-15));
  CHECK_THAT(both.freedom, WithinRel(625.0 / (81.0 / 4.0 + 256.0 / 9.0), 1e-12));
  // An exactly known value adds no uncertainty.
  CHECK_THAT(error_of_difference({3.0, 4.0}, {}).freedom, WithinRel(4.0, 1e-12));
  CHECK(error_of_difference({3.0, 1.0}, {}).freedom == 1.0);  // two repeats have no more
  CHECK(error_of_difference({3.0}, {4.0}).freedom == kManyDegrees);
  // The result does not depend on the unit.
  for (const double unit : {1e-150, 1e-90, 1e90, 1e150}) {
    CAPTURE(unit);
    CHECK_THAT(error_of_difference({3.0 * unit, 4.0}, {4.0 * unit, 9.0}).freedom,
               WithinRel(both.freedom, 1e-9));
  }
}

namespace {

/// An estimate like those from a fit to conditions with few repeats: the mean over the conditions,
/// the standard error computed from the repeats of each, and Satterthwaite's degrees of freedom.
struct Drawn {
  double value = 0.0;
  EstimateError error;
};

Drawn draw(std::mt19937_64& random, int repeats, const std::vector<double>& weights) {
  std::normal_distribution<double> normal;
  Drawn drawn;
  std::vector<ErrorPart> parts;
  double variance = 0.0;
  for (const double weight : weights) {
    std::vector<double> values;
    double mean = 0.0;
    for (int r = 0; r < repeats; ++r) {
      values.push_back(weight * normal(random));
      mean += values.back() / repeats;
    }
    double squares = 0.0;
    for (const double each : values) squares += (each - mean) * (each - mean);
    parts.push_back({squares / (repeats * (repeats - 1.0)), repeats - 1.0});
    variance += parts.back().variance;
    drawn.value += mean;
  }
  drawn.error = {std::sqrt(variance), effective_freedom(parts)};
  return drawn;
}

}  // namespace

TEST_CASE("significance: equal rigs of few repeats are told apart in 5 % of cases", "[metrics]") {
  std::mt19937_64 random(7);
  const int repeats = GENERATE(2, 3, 5);
  const std::vector<double> weights{1.0, 0.6, 0.8};
  constexpr int kPairs = 4000;
  int found = 0;
  int found_by_normal = 0;
  for (int i = 0; i < kPairs; ++i) {
    const Drawn a = draw(random, repeats, weights);
    const Drawn b = draw(random, repeats, weights);
    const EstimateError both = error_of_difference(a.error, b.error);
    found += difference_p_value(a.value - b.value, both) < 0.05 ? 1 : 0;
    found_by_normal += difference_p_value(a.value - b.value, {both.standard_error}) < 0.05 ? 1 : 0;
  }
  CAPTURE(repeats, found, found_by_normal);
  // The expected number is 200, with a standard deviation of 14. It is lower for two repeats, for
  // which the degrees of freedom are estimated, too.
  CHECK(found > (repeats == 2 ? 40 : 120));
  CHECK(found < 260);
  // The normal distribution ignores the uncertainty of the errors.
  if (repeats == 2) CHECK(found_by_normal > 400);
}
