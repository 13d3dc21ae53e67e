#include "diagnosis/record/leak_curve.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal::diagnosis;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// share = C^3 - C^2 + 0.5 C, flow = 1e-5 C^2. A cubic with exact slopes must reproduce these.
LeakPoint cubic(double c) {
  return {c, c * c * c - c * c + 0.5 * c, 1e-5 * c * c, 3.0 * c * c - 2.0 * c + 0.5, 2e-5 * c};
}

/// share = 1 - exp(-C).
LeakPoint saturating(double c) { return {c, -std::expm1(-c), 1e-5 * c, std::exp(-c), 1e-5}; }

}  // namespace

TEST_CASE("LeakCurve: a cubic of exact slopes is followed exactly", "[diagnosis]") {
  const LeakCurve curve({cubic(0.5), cubic(1.0), cubic(3.0)});
  for (const double c : {0.5, 0.7, 1.0, 1.3, 2.9}) {
    CAPTURE(c);
    CHECK_THAT(curve.share(c), WithinRel(cubic(c).share, 1e-12));
    CHECK_THAT(curve.share_slope(c), WithinAbs(cubic(c).share_slope, 1e-12));
    CHECK_THAT(curve.leak_flow_m3_per_s(c), WithinRel(1e-5 * c * c, 1e-12));
  }
  // The curve is a straight line beyond both ends, and a leak is never negative.
  CHECK_THAT(curve.share(4.0), WithinRel(cubic(3.0).share + cubic(3.0).share_slope, 1e-12));
  CHECK_THAT(curve.share_slope(4.0), WithinRel(cubic(3.0).share_slope, 1e-12));
  CHECK_THAT(curve.leak_flow_m3_per_s(0.4), WithinRel(1e-5 * (0.25 - 0.1), 1e-12));
  CHECK(curve.share(0.0) == 0.0);
  CHECK(curve.share(-1.0) == 0.0);
  CHECK(curve.leak_flow_m3_per_s(-1.0) == 0.0);
  // The share at zero is zero even if a straight line from the first point would give another
  // value.
  CHECK(LeakCurve({saturating(0.5), saturating(1.0)}).share(0.0) == 0.0);
}

TEST_CASE("LeakCurve: points that do not increase are refused", "[diagnosis]") {
  CHECK_THROWS_AS(LeakCurve({cubic(1.0)}), std::invalid_argument);
  CHECK_THROWS_AS(LeakCurve({cubic(1.0), cubic(1.0)}), std::invalid_argument);
  CHECK_THROWS_AS(LeakCurve({cubic(-1.0), cubic(1.0)}), std::invalid_argument);
}

TEST_CASE("curve_about: simulated at the estimate and at both ends", "[diagnosis]") {
  std::vector<double> simulated;
  const auto leak_at = [&](double c) {
    simulated.push_back(c);
    return saturating(c);
  };
  const LeakCurve curve = curve_about(leak_at, 1.0, 0.25);
  CHECK(simulated == std::vector<double>{0.75, 1.0, 1.25});
  CHECK(curve.share(1.0) == saturating(1.0).share);
  // The error of a cubic is the fourth derivative (at most 1) times width^4 / 384.
  for (double c = 0.75; c < 1.25; c += 0.05)
    CHECK_THAT(curve.share(c), WithinAbs(saturating(c).share, std::pow(0.25, 4) / 384.0));
}

TEST_CASE("curve_about: from no leak on where that is within reach", "[diagnosis]") {
  const LeakCurve curve = curve_about(saturating, -0.05, 0.1);
  REQUIRE(curve.points().size() == 2);
  CHECK(curve.points().front().coefficient == 0.0);
  CHECK(curve.points().front().share == 0.0);
  // The slope is that of the power of two below a fiftieth of the range: (1 - exp(-x)) / x.
  const double small = std::exp2(-9.0);
  CHECK_THAT(curve.share_slope(0.0), WithinRel(-std::expm1(-small) / small, 1e-12));
  CHECK_THAT(curve.points().back().coefficient, WithinRel(0.1, 1e-12));
}

TEST_CASE("point_about: a limit of detection costs one simulation, and is that of its curve",
          "[diagnosis]") {
  int simulated = 0;
  const LeakAt simulate = [&](double c) {
    ++simulated;
    return saturating(c);
  };
  // Limits far above the least reach, near it, and so far below that they have no point.
  for (const double limit : {2.0, 0.3, 0.1, 0.004}) {
    const double reach = std::max(limit, 0.25);
    const LeakCurve curve = curve_about(saturating, limit, reach);
    simulated = 0;
    const LeakPoint point = point_about(simulate, limit, reach);
    CAPTURE(limit);
    CHECK(simulated == (limit > 0.005 ? 1 : 2));
    CHECK(point.coefficient == limit);
    CHECK(point.share == curve.share(limit));
    CHECK(point.leak_flow_m3_per_s == curve.leak_flow_m3_per_s(limit));
  }
}
