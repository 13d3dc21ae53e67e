#include "calib/score/comparison.hpp"

#include <catch2/catch.hpp>

namespace rigcal::calib {

using Catch::WithinRel;

TEST_CASE("comparison: what days add to an error is known exactly", "[calib]") {
  const metrics::EstimateError both = with_days({3.0, 4.0}, 4.0);
  CHECK_THAT(both.standard_error, WithinRel(5.0, 1e-14));
  // Satterthwaite: (9 + 16)^2 / (9^2 / 4 + 16^2 / 1e6)
  CHECK_THAT(both.freedom, WithinRel(625.0 / (81.0 / 4.0 + 256.0 / metrics::kManyDegrees), 1e-12));
}

}  // namespace rigcal::calib
