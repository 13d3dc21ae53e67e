#include "calib/score/comparison.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace rigcal::calib {

using Catch::WithinRel;

TEST_CASE("comparison: what days add to an error is known exactly", "[calib]") {
  const metrics::EstimateError both = with_days({3.0, 4.0}, 4.0);
  CHECK_THAT(both.standard_error, WithinRel(5.0, 1e-14));
  // Satterthwaite: (9 + 16)^2 / (9^2 / 4 + 16^2 / 1e6)
  CHECK_THAT(both.freedom, WithinRel(625.0 / (81.0 / 4.0 + 256.0 / metrics::kManyDegrees), 1e-12));
}

TEST_CASE("comparison: a trend relies on errors that all count their days", "[calib]") {
  // Chi-square is 3.2 with 2 degrees of freedom: 20 %, which widens where days are not counted.
  const auto widened = [](bool first_counted, bool others_counted) {
    std::vector<PlacedEstimate> estimates;
    for (int i = 0; i < 4; ++i)
      estimates.push_back({1.0 * i, 2.0 * (i % 2), {1.0}, i == 0 ? first_counted : others_counted});
    return trend_of(estimates, false).widened.value();
  };
  CHECK(widened(true, true) == 1.0);
  for (const bool first : {false, true}) {
    for (const bool others : {false, true}) {
      if (first && others) continue;
      CAPTURE(first, others);
      CHECK_THAT(widened(first, others), WithinRel(std::sqrt(1.6), 1e-12));
    }
  }
}

TEST_CASE("comparison: the band of a line is narrowest at the weighted mean of its places",
          "[calib]") {
  std::vector<PlacedEstimate> estimates;
  for (const double place : {20000.0, 20010.0, 20020.0, 20030.0})
    estimates.push_back({place, 0.1 * place, {2.0}, true});
  estimates.back().error.standard_error = 1.0;  // weights 1/4, 1/4, 1/4 and 1
  const EstimateTrend trend = trend_of(estimates, false);
  const double middle = 20000.0 + (0.25 * (10.0 + 20.0) + 30.0) / 1.75;
  const auto width = [&](double place) {
    return half_width_of_band(trend, estimates, place).value();
  };
  // The mean has a variance of 1 / 1.75.
  CHECK_THAT(width(middle), WithinRel(1.959964 / std::sqrt(1.75), 1e-5));
  CHECK(width(middle - 1.0) > width(middle));
  CHECK_THAT(width(middle + 5.0), WithinRel(width(middle - 5.0), 1e-9));
  // Far away, the error of the slope dominates.
  CHECK_THAT(width(middle + 1e6), WithinRel(1e6 * (trend.ci95->high - trend.slope.value()), 1e-6));
  CHECK_FALSE(half_width_of_band(EstimateTrend(), estimates, 0.0).has_value());
  CHECK_FALSE(half_width_of_band(trend, {}, 0.0).has_value());
}

}  // namespace rigcal::calib
