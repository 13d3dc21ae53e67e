#include "metrics/metric_table.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

using namespace rigcal::metrics;

TEST_CASE("kMetrics: a row for every member of Agreement, in its order", "[metrics]") {
  STATIC_REQUIRE(sizeof(Agreement) == kMetrics.size() * sizeof(double));
  Agreement numbered;
  double number = 0.0;
  for (const MetricSpec& metric : kMetrics) numbered.*metric.value = ++number;
  CHECK(numbered.rho2 == 1.0);
  CHECK(numbered.maximum_error == number);
}

TEST_CASE("kMetrics: names as in the results, unit at the end of the name", "[metrics]") {
  std::vector<std::string> names;
  for (const MetricSpec& metric : kMetrics) names.emplace_back(metric.name);
  CHECK(names == std::vector<std::string>{"rho2", "r", "ccc", "absolute_error_percent", "rmse",
                                          "nrmse_fit_percent", "maximum_error"});
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    CHECK(metric.name.ends_with("_percent") == (metric.unit == "%"));
    CHECK(std::set<std::string_view>{"1", "%", "channel"}.count(metric.unit) == 1);
    CHECK_FALSE(metric.title.empty());
    CHECK_FALSE(metric.formula.empty());
    CHECK(metric.formula.find('\n') == std::string_view::npos);
  }
}

TEST_CASE("kMetrics: higher_is_better points from the worse simulation to the better one",
          "[metrics]") {
  const std::vector<double> measured{0.0, 1.0, 0.0, -1.0};
  const std::vector<double> better{0.0, 0.875, 0.125, -1.0};
  const std::vector<double> worse{0.5, 0.25, 0.5, -0.25};
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    CHECK((metric.compute(measured, better) > metric.compute(measured, worse)) ==
          metric.higher_is_better);
  }
}

TEST_CASE("kMetrics: a scaled channel scales the metrics in its unit and no other", "[metrics]") {
  const std::vector<double> measured{0.0, 1.0, 0.0, -1.0}, simulated{0.5, 0.25, 0.5, -0.25};
  std::vector<double> measured_4 = measured, simulated_4 = simulated;
  for (double& value : measured_4) value *= 4.0;
  for (double& value : simulated_4) value *= 4.0;
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    // Multiplying by four does not round.
    CHECK(metric.compute(measured_4, simulated_4) ==
          metric.compute(measured, simulated) * (metric.unit == "channel" ? 4.0 : 1.0));
  }
}
TEST_CASE("score_text: digits that show the distance from the best value and the side of a limit",
          "[metrics]") {
  const MetricSpec& rho2 = *find_metric("rho2");
  const MetricSpec& error = *find_metric("absolute_error_percent");
  CHECK(score_text(rho2, 0.99987) == "0.99987");
  CHECK(score_text(rho2, 0.778966) == "0.7790");
  CHECK(score_text(rho2, 1.0) == "1.0000");
  CHECK(score_text(rho2, 0.989996, 0.99) == "0.989996");
  CHECK(score_text(rho2, 0.990004, 0.99) == "0.9900");
  CHECK(score_text(error, 10.7863, 1.0) == "10.79");
  CHECK(score_text(error, 1.00004, 1.0) == "1.00004");
  CHECK(score_text(error, 0.99996, 1.0) == "1");  // at its limit it is kept, too
  CHECK(find_metric("rho3") == nullptr);
  for (const MetricSpec& metric : kMetrics) {
    for (const double limit : {0.9, 0.99, 1.0}) {
      for (const double off : {-1e-7, -3e-5, 2e-6, 4e-3}) {
        const double read = std::stod(score_text(metric, limit + off, limit));
        CAPTURE(metric.name, limit, off, read);
        CHECK(keeps(metric, read, limit) == keeps(metric, limit + off, limit));
      }
    }
  }
}
