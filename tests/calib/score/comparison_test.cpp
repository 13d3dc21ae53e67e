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

}  // namespace rigcal::calib
