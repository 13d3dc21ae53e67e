#include "report/figure/monotone_curve.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

using Catch::WithinAbs;
using rigcal::report::DrawnCurve;
using rigcal::report::monotone_curve;

namespace {

double value_at(const DrawnCurve& curve, double x) {
  const auto found = std::find(curve.x.begin(), curve.x.end(), x);
  REQUIRE(found != curve.x.end());
  return curve.y[static_cast<std::size_t>(found - curve.x.begin())];
}

}  // namespace

TEST_CASE("monotone_curve: passes through its points, with the slopes of the method", "[report]") {
  const std::vector<double> x{-2.0, -1.0, 0.0, 1.0, 2.0};
  const std::vector<double> y{4.0, 1.0, 0.0, 1.0, 4.0};
  const DrawnCurve curve = monotone_curve(x, y);
  REQUIRE(curve.x.size() == curve.y.size());
  CHECK(std::is_sorted(curve.x.begin(), curve.x.end()));
  for (std::size_t i = 0; i < x.size(); ++i)
    CHECK_THAT(value_at(curve, x[i]), WithinAbs(y[i], 1e-14));
  // The slopes are 0 at 0, the harmonic mean 1.5 of 1 and 3 at 1, and 4 at the end.
  CHECK_THAT(value_at(curve, 0.5), WithinAbs(0.5 - 1.5 / 8.0, 1e-14));
  CHECK_THAT(value_at(curve, 1.5), WithinAbs(2.5 + (1.5 - 4.0) / 8.0, 1e-14));
  CHECK_THAT(value_at(curve, -1.5), WithinAbs(2.5 + (1.5 - 4.0) / 8.0, 1e-14));
}

TEST_CASE("monotone_curve: never leaves the values of neighbours", "[report]") {
  const std::vector<double> x{0.0, 0.1, 1.0, 1.1, 5.0, 5.5};
  const std::vector<double> y{0.0, 3.0, 3.1, 0.2, 0.1, 4.0};
  const DrawnCurve curve = monotone_curve(x, y);
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    const auto after = std::upper_bound(x.begin() + 1, x.end() - 1, curve.x[k]) - x.begin();
    const auto [low, high] =
        std::minmax(y[static_cast<std::size_t>(after) - 1], y[static_cast<std::size_t>(after)]);
    CAPTURE(curve.x[k]);
    CHECK(curve.y[k] >= low - 1e-12);
    CHECK(curve.y[k] <= high + 1e-12);
  }
}

TEST_CASE("monotone_curve: too few points, or two at one place, stay as they are", "[report]") {
  CHECK(monotone_curve(std::vector{1.0, 2.0}, std::vector{3.0, 4.0}).y ==
        std::vector<double>{3.0, 4.0});
  CHECK(monotone_curve(std::vector{1.0, 1.0, 2.0}, std::vector{3.0, 4.0, 5.0}).y ==
        std::vector<double>{3.0, 4.0, 5.0});
  CHECK(monotone_curve({}, {}).x.empty());
}
