#include "diagnosis/leak_estimate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace rigcal::diagnosis;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// share = C / 10: straight, so that errors carry over one to one.
LeakCurve straight() {
  std::vector<LeakPoint> points;
  for (const double c : {0.0, 0.5, 1.0, 2.0, 4.0, 8.0})
    points.push_back({c, 0.1 * c, 1e-5 * c, 0.0});
  return LeakCurve(points);
}

/// A record whose coefficient is known within `se`, with all degrees of freedom one could wish for.
LeakFit fit_of(double coefficient, double se) {
  LeakFit fit;
  fit.coefficient = coefficient;
  fit.scatter_se = se;
  fit.scatter_freedom = 1'000'000;
  fit.effect_m = 1e-3;
  fit.share_slope = 0.1;
  return fit;
}

double probability(const LeakEstimate& estimate, LeakClass leak_class) {
  return estimate.probability[static_cast<std::size_t>(leak_class)];
}

const rigcal::datasets::DiagnosisSettings kSettings;

}  // namespace

TEST_CASE("LeakCurve: through its points, monotone, nothing leaks backwards", "[diagnosis]") {
  const LeakCurve curve({{0.0, 0.0, 0.0, 3.0},
                         {0.1, 0.05, 1e-6, 1.0},
                         {0.4, 0.14, 3e-6, 2.0},
                         {0.6, 0.15, 4e-6, 4.0},
                         {0.9, 0.35, 8e-6, 5.0}});
  CHECK(curve.share(-1.0) == 0.0);
  CHECK_THAT(curve.share(0.4), WithinRel(0.14, 1e-12));
  CHECK(curve.best_coefficient() == 0.1);
  double last = 0.0;
  for (double c = 0.01; c < 1.2; c += 0.01) {
    CHECK(curve.share(c) > last);
    last = curve.share(c);
  }
  CHECK_THROWS_AS(LeakCurve({{0.0, 0.0, 0.0, 0.0}}), std::invalid_argument);
}

TEST_CASE("estimate_leak: class probabilities follow the interval", "[diagnosis]") {
  const auto sure = estimate_leak(fit_of(1.5, 0.02), straight(), {}, 1, 0, kSettings);
  CHECK(sure.most_probable == LeakClass::medium);
  CHECK(probability(sure, LeakClass::medium) > 0.999);
  CHECK_THAT(sure.share, WithinRel(0.15, 1e-9));
  // Normal quantile 1.96 of 0.02, a tenth of which is the share's; 401 draws resolve a hundredth.
  CHECK_THAT(sure.share_ci95.first, WithinAbs(0.15 - 0.00392, 1e-4));
  CHECK_THAT(sure.ci95.second, WithinAbs(1.5 + 0.0392, 1e-5));

  const auto torn = estimate_leak(fit_of(1.0, 0.1), straight(), {}, 1, 0, kSettings);
  CHECK_THAT(probability(torn, LeakClass::slight), WithinAbs(0.5, 2e-3));
  CHECK_THAT(probability(torn, LeakClass::medium), WithinAbs(0.5, 2e-3));
  CHECK_THAT(std::accumulate(torn.probability.begin(), torn.probability.end(), 0.0),
             WithinAbs(1.0, 1e-12));
}

TEST_CASE("estimate_leak: given that a leak is not negative", "[diagnosis]") {
  // Phi(1) - Phi(0) = 0.3413 lies below 1 % and 0.1587 above; normal is as wide as slight, nine
  // times itself: 0.3413 9 / (0.3413 9 + 0.1587) = 0.9509.
  const auto none = estimate_leak(fit_of(0.0, 0.1), straight(), {}, 1, 0, kSettings);
  CHECK_THAT(probability(none, LeakClass::normal), WithinAbs(0.9509, 2e-3));
  CHECK(none.ci95.first == 0.0);
  CHECK(none.share_ci95.first > 0.0);
  CHECK_FALSE(none.leak_detected);
  const auto negative = estimate_leak(fit_of(-0.5, 0.1), straight(), {}, 1, 0, kSettings);
  CHECK(negative.share == 0.0);
  CHECK(probability(negative, LeakClass::normal) > 0.99);
}

TEST_CASE("estimate_leak: every source of error is in the interval", "[diagnosis]") {
  LeakFit fit = fit_of(1.5, 0.03);
  fit.rig_se = 0.04;
  SignalErrors errors;
  errors.repeat_m = 0.12e-3;  // 0.12 of the coefficient
  errors.repeat_freedom = 16;
  errors.healthy_m = 0.05e-3;
  const auto single = estimate_leak(fit, straight(), errors, 1, 0, kSettings);
  CHECK_THAT(single.standard_error,
             WithinRel(std::sqrt(0.03 * 0.03 + 0.04 * 0.04 + 0.12 * 0.12 + 0.05 * 0.05), 1e-9));
  const auto mean = estimate_leak(fit, straight(), errors, 4, 0, kSettings);
  CHECK_THAT(mean.standard_error,
             WithinRel(std::sqrt(0.03 * 0.03 + 0.04 * 0.04 + 0.06 * 0.06 + 0.05 * 0.05), 1e-9));
  CHECK(single.freedom > 16.0);
  CHECK(single.freedom < 100.0);
}

TEST_CASE("estimate_leak: a reference adds its own scatter and takes the model's off",
          "[diagnosis]") {
  SignalErrors errors;
  errors.repeat_m = 0.12e-3;  // 0.12 of the coefficient
  errors.repeat_freedom = 16;
  errors.healthy_m = 0.05e-3;
  const LeakFit fit = fit_of(1.5, 0.03);
  const auto corrected = estimate_leak(fit, straight(), errors, 1, 3, kSettings);
  CHECK_THAT(corrected.standard_error,
             WithinRel(std::sqrt(0.03 * 0.03 + 0.12 * 0.12 * (1.0 + 1.0 / 3.0)), 1e-9));
  // Welch and Satterthwaite: what the repeats tell has 16 degrees of freedom, the scatter 1e6.
  const double repeats = 0.12 * 0.12 * (1.0 + 1.0 / 3.0);
  CHECK_THAT(corrected.freedom, WithinRel(std::pow(0.03 * 0.03 + repeats, 2) /
                                              (repeats * repeats / 16.0 + std::pow(0.03, 4) / 1e6),
                                          1e-9));
}

TEST_CASE("estimate_leak: a leak is detected from the level of false alarms on", "[diagnosis]") {
  // The normal quantile of 1 % false alarms is 2.3263.
  REQUIRE(kSettings.false_alarms == 0.01);
  CHECK_FALSE(estimate_leak(fit_of(0.232, 0.1), straight(), {}, 1, 0, kSettings).leak_detected);
  CHECK(estimate_leak(fit_of(0.233, 0.1), straight(), {}, 1, 0, kSettings).leak_detected);
  CHECK_THAT(estimate_leak(fit_of(0.233, 0.1), straight(), {}, 1, 0, kSettings).leak_score,
             WithinRel(2.33, 1e-12));
}

TEST_CASE("estimate_leak: the rig's error blurs the share", "[diagnosis]") {
  LeakFit fit = fit_of(1.5, 1e-9);
  fit.share_rig_se = 0.01;
  const auto found = estimate_leak(fit, straight(), {}, 1, 0, kSettings);
  // 1.96 standard errors; the search stops at 1e-15 of the range.
  CHECK_THAT(found.share_ci95.first, WithinAbs(0.15 - 0.0195996, 1e-6));
  CHECK_THAT(found.share_ci95.second, WithinAbs(0.15 + 0.0195996, 1e-6));
}

TEST_CASE("LeakCurve: a cubic between points is exact where its slopes are", "[diagnosis]") {
  // Beyond the last point it goes on straight, with the last secant.
  const LeakCurve curve(
      {{0.0, 0.0, 0.0, 0.0}, {1.0, 0.1, 1e-6, 0.0}, {3.0, 0.5, 3e-6, 0.0}, {4.0, 0.6, 4e-6, 0.0}});
  CHECK_THAT(curve.share(6.0), WithinRel(0.8, 1e-12));
  CHECK_THAT(curve.leak_flow_m3_per_s(2.2), WithinRel(2.2e-6, 1e-12));
  // Slopes of Fritsch and Butland: (a + b) / (a / 0.1 + b / 0.2) with a = 2 2 + 1, b = 2 + 2 1 at
  // 1, likewise with 0.2 and 0.1 at 3; Hermite's middle is the mean plus (left - right) width / 8.
  const double left = 9.0 / (5.0 / 0.1 + 4.0 / 0.2);
  const double right = 9.0 / (4.0 / 0.2 + 5.0 / 0.1);
  CHECK_THAT(curve.share(2.0), WithinRel(0.3 + (left - right) * 2.0 / 8.0, 1e-12));
  const double first = 0.1;
  CHECK_THAT(curve.share(0.5), WithinRel(0.05 + (first - left) / 8.0, 1e-12));
  CHECK(curve.share(-1e-3) == 0.0);
}

TEST_CASE("detection_limit: Currie's sum of both quantiles", "[diagnosis]") {
  const auto healthy = estimate_leak(fit_of(0.0, 0.01), straight(), {}, 1, 0, kSettings);
  const auto limit = detection_limit(healthy, straight(), kSettings);
  // 2.3263 + 1.6449
  CHECK_THAT(limit.coefficient, WithinRel(0.039712, 1e-4));
  CHECK_THAT(limit.leak_flow_m3_per_s, WithinRel(0.039712e-5, 1e-3));
}

TEST_CASE("keep_larger: the limit of the larger flow, whatever comes first", "[diagnosis]") {
  const DetectionLimit small{0.5, 1e-6, 0.02};
  const DetectionLimit large{0.1, 2e-6, 0.01};
  for (const bool small_first : {false, true}) {
    std::optional<DetectionLimit> kept;
    keep_larger(small_first ? small : large, kept);
    keep_larger(small_first ? large : small, kept);
    REQUIRE(kept);
    CHECK(kept->leak_flow_m3_per_s == 2e-6);
  }
}

TEST_CASE("class_of: a share at a limit is above it", "[diagnosis]") {
  CHECK(class_of(kSettings, 0.0) == LeakClass::normal);
  CHECK(class_of(kSettings, 0.01) == LeakClass::slight);
  CHECK(class_of(kSettings, 0.0999) == LeakClass::slight);
  CHECK(class_of(kSettings, 0.25) == LeakClass::critical);
  CHECK(class_of(kSettings, 2.0) == LeakClass::supercritical);
}
