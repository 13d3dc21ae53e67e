#include "metrics/trend.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <random>
#include <stdexcept>
#include <vector>

using Catch::WithinAbs;
using Catch::WithinRel;
using namespace rigcal::metrics;

namespace {

using Values = std::vector<double>;
using Errors = std::vector<EstimateError>;

constexpr int kTrials = 4000;

/// Fraction of `trials` in which a trend is significant at 5 %. Points at 0, 1, 2, ... have an
/// error of 1, a day effect with standard deviation `day_sd` that the errors do not include, and a
/// slope of `slope_in_errors` times its standard error.
double share_found(std::size_t points, double day_sd, double slope_in_errors,
                   bool days_counted = false, int trials = kTrials) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  Values x;
  double middle = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    x.push_back(static_cast<double>(i));
    middle += x.back() / static_cast<double>(points);
  }
  double squares = 0.0;
  for (const double each : x) squares += (each - middle) * (each - middle);
  const double slope = slope_in_errors / std::sqrt(squares);
  DaysOfPoints days;
  days.counted = days_counted;
  int found = 0;
  for (int i = 0; i < trials; ++i) {
    Values y;
    for (const double each : x)
      y.push_back(slope * each + std::hypot(1.0, day_sd) * normal(random));
    found += weighted_trend(x, y, Errors(points, {1.0}), {}, days).p_value < 0.05 ? 1 : 0;
  }
  return static_cast<double>(found) / trials;
}

}  // namespace

TEST_CASE("trend: the exact line where the points lie on one", "[metrics]") {
  const Values x{0.0, 1.0, 4.0, 6.0};
  Values y;
  for (const double each : x) y.push_back(2.0 - 0.5 * each);
  const Trend trend = weighted_trend(x, y, Errors(4, {0.1}));
  CHECK_THAT(trend.slope, WithinRel(-0.5, 1e-12));
  CHECK_THAT(trend.intercept, WithinRel(2.0, 1e-12));
  // sum (x - 2.75)^2 = 22.75, so the error is 0.1 / sqrt(22.75), with the normal distribution.
  CHECK_THAT(trend.slope_standard_error, WithinRel(0.1 / std::sqrt(22.75), 1e-12));
  CHECK_THAT(trend.reduced_chi_square, WithinAbs(0.0, 1e-20));
  CHECK_THAT(trend.ci95_high + 0.5, WithinRel(1.959963985 * trend.slope_standard_error, 1e-8));
  CHECK(trend.widened == 1.0);
}

TEST_CASE("trend: few false alarms where the errors tell the scatter", "[metrics]") {
  const std::size_t points = GENERATE(3U, 4U, 5U);
  // Some errors are widened unnecessarily, so slightly fewer than 5 % are found.
  const double found = share_found(points, 0.0, 0.0);
  CAPTURE(points, found);
  CHECK(found > 0.02);
  CHECK(found < 0.055);
}

TEST_CASE("trend: a day effect that no error tells makes few false alarms", "[metrics]") {
  // Three points leave one degree of freedom for the deviations.
  struct Case {
    std::size_t points;
    double most;
  };
  const Case each = GENERATE(Case{3, 0.16}, Case{4, 0.11}, Case{5, 0.09});
  for (const double day_sd : {0.5, 1.0, 2.0, 5.0, 30.0}) {
    const double found = share_found(each.points, day_sd, 0.0);
    CAPTURE(each.points, day_sd, found);
    CHECK(found < each.most);
  }
}

TEST_CASE("trend: a steep line is found from three points on", "[metrics]") {
  CHECK(share_found(3, 0.0, 6.0) > 0.7);
  CHECK(share_found(4, 0.0, 6.0) > 0.8);
  CHECK(share_found(5, 0.0, 6.0) > 0.9);
}

TEST_CASE("trend: where days are counted, a slope of four errors is found", "[metrics]") {
  // The expected values are 4.5 % without a slope, and 88, 88 and 89 % with one. Their standard
  // deviations are 0.3 and 0.5 %.
  const std::size_t points = GENERATE(3U, 4U, 5U);
  const double falsely = share_found(points, 0.0, 0.0, true);
  const double found = share_found(points, 0.0, 4.0, true);
  CAPTURE(points, falsely, found);
  CHECK(falsely > 0.033);
  CHECK(falsely < 0.058);
  CHECK(found > 0.86);
  CHECK(found < 0.92);
}

TEST_CASE("trend: days that are counted too small make few false trends", "[metrics]") {
  // Days that differ by another error each: 11.4 % is expected of four points.
  const double found = share_found(4, 1.0, 0.0, true);
  CAPTURE(found);
  CHECK(found < 0.13);
}

TEST_CASE("trend: less scatter widens where no error counts the days", "[metrics]") {
  // Points at 0, a, 0, a have a chi-square of 0.8 a^2, with a probability of exp(-0.4 a^2).
  const auto widened = [](double a, bool days_counted) {
    DaysOfPoints days;
    days.counted = days_counted;
    return weighted_trend(Values{0, 1, 2, 3}, Values{0, a, 0, a}, Errors(4, {1.0}), {}, days)
        .widened;
  };
  CHECK(widened(1.8, false) == 1.0);                                  // 27 %
  CHECK_THAT(widened(2.0, false), WithinRel(std::sqrt(1.6), 1e-12));  // 20 %
  CHECK(widened(2.0, true) == 1.0);
  CHECK(widened(2.3, true) == 1.0);                                  // 12 %
  CHECK_THAT(widened(2.5, true), WithinRel(std::sqrt(2.5), 1e-12));  // 8 %
}

TEST_CASE("trend: the scatter of many points tells errors that are stated too small", "[metrics]") {
  const double found = share_found(8, std::sqrt(8.0), 0.0);  // errors three times too small
  // The expected value is 5 %, with a standard deviation of 0.35 %.
  CHECK(found > 0.036);
  CHECK(found < 0.064);
}

TEST_CASE("trend: points off the line widen it by Birge's ratio, tested by t with n - 2",
          "[metrics]") {
  // The values are 0, 6, 0, 6 errors. Around the line 1.2 x + 1.2, chi-square is 28.8, with 2
  // degrees of freedom.
  const Trend trend = weighted_trend(Values{0, 1, 2, 3}, Values{0, 6, 0, 6}, Errors(4, {1.0}));
  CHECK_THAT(trend.slope, WithinRel(1.2, 1e-12));
  CHECK_THAT(trend.chi_square, WithinRel(28.8, 1e-12));
  CHECK_THAT(trend.widened, WithinRel(std::sqrt(14.4), 1e-12));
  CHECK(trend.freedom == 2.0);
  CHECK_THAT(trend.slope_standard_error, WithinRel(std::sqrt(14.4 / 5.0), 1e-12));
  // t = 0.7071. Its tail probability with 2 degrees of freedom is 1/2 - t / (2 sqrt(2 + t^2)).
  CHECK_THAT(trend.p_value, WithinRel(1.0 - std::sqrt(0.5 / 2.5), 1e-9));
}

TEST_CASE("trend: errors of few degrees of freedom are those of t", "[metrics]") {
  // The points are on a line, and the ends have 4 degrees of freedom each. The middle point has no
  // weight in the slope.
  const Trend trend =
      weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Errors{{0.3, 4.0}, {0.5, 1.0}, {0.3, 4.0}});
  CHECK_THAT(trend.freedom, WithinRel(8.0, 1e-9));
  // 97.5 % quantile of t with 8 degrees of freedom, as printed in tables.
  CHECK_THAT(trend.ci95_high - trend.slope,
             WithinRel(2.306004135 * trend.slope_standard_error, 1e-8));
}

TEST_CASE("trend: an error that all points share is none of the slope", "[metrics]") {
  const Values x{0, 1, 2};
  const Values y{0.3, 0.4, 0.5};
  const Trend alone = weighted_trend(x, y, Errors(3, {0.01}));
  const Trend shared =
      weighted_trend(x, y, Errors(3, {0.01}), Eigen::MatrixXd::Constant(3, 3, 0.04));
  CHECK_THAT(shared.slope_standard_error, WithinRel(alone.slope_standard_error, 1e-6));
  CHECK_THAT(shared.slope, WithinRel(0.1, 1e-9));
}

TEST_CASE("trend: a common error that differs between points adds to the freedom", "[metrics]") {
  // The common error moves each point in proportion to x, and the slope by as much as the errors of
  // the two ends do. The variance doubles, so their 8 degrees of freedom count four times.
  const Eigen::Vector3d move(0.0, 1.0, 2.0);
  const double own = 0.3 * 0.3 / 2.0;
  const Trend trend = weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Errors(3, {0.3, 4.0}),
                                     own * move * move.transpose());
  CHECK_THAT(trend.slope_standard_error, WithinRel(0.3, 1e-9));
  CHECK_THAT(trend.freedom, WithinRel(32.0, 1e-4));
}

TEST_CASE("trend: the days add their variance, with its degrees of freedom", "[metrics]") {
  // The days double the variance of the slope. Half of it has three degrees of freedom.
  DaysOfPoints days;
  days.counted = true;
  days.covariance = 0.09 * Eigen::Matrix3d::Identity();
  days.freedom = 3.0;
  const Trend trend = weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Errors(3, {0.3}), {}, days);
  CHECK_THAT(trend.slope_standard_error, WithinRel(0.3, 1e-9));
  CHECK_THAT(trend.freedom, WithinRel(12.0, 1e-4));
}

TEST_CASE("trend: of errors that are too far apart there is none", "[metrics]") {
  for (const double size : {1e-160, 1e-170}) {
    CAPTURE(size);
    CHECK_THROWS_AS(weighted_trend(Values{0, 1, 2}, Values{0, 1, 3}, Errors{{1.0}, {size}, {size}}),
                    std::domain_error);
  }
  CHECK_THROWS_AS(weighted_trend(Values{0, 1, 2}, Values{0, 1, 0}, Errors(3, {1e-100})),
                  std::domain_error);
  CHECK(weighted_trend(Values{0, 1, 2}, Values{0, 1, 0}, Errors(3, {1e-20})).p_value > 0.9);
}

TEST_CASE("trend: needs three points at different places", "[metrics]") {
  CHECK_THROWS_AS(weighted_trend(Values{0, 1}, Values{0, 1}, Errors(2, {1.0})),
                  std::invalid_argument);
  CHECK_THROWS_AS(weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Errors{{1.0}, {0.0}, {1.0}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Errors(3, {1.0}),
                                 Eigen::MatrixXd::Zero(2, 2)),
                  std::invalid_argument);
  DaysOfPoints two;
  two.covariance = Eigen::MatrixXd::Zero(2, 2);
  CHECK_THROWS_AS(weighted_trend(Values{0, 1, 2}, Values{0, 1, 2}, Errors(3, {1.0}), {}, two),
                  std::invalid_argument);
  CHECK_THROWS_AS(weighted_trend(Values{1, 1, 1}, Values{0, 1, 2}, Errors(3, {1.0})),
                  std::domain_error);
}

// Prints the tables of docs/diagnosis.md and docs/decisions/0058-trends-whose-days-are-counted.md:
// metrics_tests "[trend-study]"
TEST_CASE("trend: size and power", "[.][trend-study]") {
  constexpr int kMany = 200000;
  for (const bool counted : {false, true}) {
    for (const std::size_t points : {3U, 4U, 5U, 8U}) {
      std::cout << (counted ? "days counted, " : "days not counted, ") << points << " points: size "
                << share_found(points, 0.0, 0.0, counted, kMany) << ", a slope of four errors "
                << share_found(points, 0.0, 4.0, counted, kMany) << ", uncounted days of one error "
                << share_found(points, 1.0, 0.0, counted, kMany) << ", of two "
                << share_found(points, 2.0, 0.0, counted, kMany) << "\n";
    }
  }
}
