#include "report/store/stored/stored_residual_tests.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "report/document/render_html.hpp"
#include "report/page/calibration/fit_sections.hpp"

using Catch::Contains;
using rigcal::datasets::Channel;
using rigcal::metrics::residual_tests;
using rigcal::report::Json;

namespace {

Json residual_tests_json(rigcal::metrics::ResidualTests tests, std::string_view unit) {
  rigcal::report::add_verdicts(tests, unit);
  return rigcal::report::json_of(tests);
}

std::vector<double> white(std::size_t n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(n);
  for (double& value : values) value = normal(engine);
  return values;
}

std::string words(const Json& json, const char* test) {
  return json.at(test).at("verdict").get<std::string>();
}

}  // namespace

TEST_CASE("stored residual tests: white noise passes, in the words of the field", "[report]") {
  const Json json = residual_tests_json(residual_tests(white(1000, 7), white(1000, 8), 0.01), "m");
  for (const char* test :
       {"autocorrelation", "cross_correlation", "periodogram", "normality", "drift"}) {
    CAPTURE(test);
    CHECK(json[test]["outcome"] == "passed");
    CHECK(json[test]["passed"] == true);
    CHECK(json[test]["reason"].is_null());
  }
  CHECK_THAT(words(json, "autocorrelation"), Contains("no significant autocorrelation (p = "));
  CHECK_THAT(words(json, "cross_correlation"), Contains("not significantly correlated"));
  CHECK(words(json, "drift") == "no significant offset or trend");
}

TEST_CASE("stored residual tests: what cannot be judged is neither passed nor failed", "[report]") {
  std::vector<double> slow = white(2000, 3);
  for (std::size_t i = 0; i < slow.size(); ++i)
    slow[i] = 0.01 * slow[i] + std::sin(std::numbers::pi * static_cast<double>(i) / 2000.0);
  const auto tests = residual_tests(slow, white(2000, 4), 0.001);
  const Json json = residual_tests_json(tests, "m");
  for (const char* test : {"cross_correlation", "normality", "drift"}) {
    CAPTURE(test);
    CHECK(json[test]["outcome"] == "not_judged");
    CHECK(json[test]["passed"].is_null());
    CHECK(words(json, test) == "cannot be judged: " + json[test]["reason"].get<std::string>());
  }
  CHECK(json["autocorrelation"]["passed"] == false);
  CHECK(json["autocorrelation"]["outcome"] == "failed");
  CHECK_THAT(words(json, "autocorrelation"),
             Contains("effective sample size " +
                      std::to_string(static_cast<int>(tests.effective_samples)) + " of 2000"));
}

TEST_CASE("stored residual tests: the share that the input explains", "[report]") {
  const std::vector<double> input = white(4000, 5);
  std::vector<double> residual = white(4000, 6);
  for (std::size_t i = 0; i < residual.size(); ++i) residual[i] += input[i];
  const Json json = residual_tests_json(residual_tests(residual, input, 0.01), "m");
  const Json& cross = json["cross_correlation"];
  CHECK(cross["passed"] == false);
  const double peak = cross["peak"].get<double>();
  CHECK_THAT(words(json, "cross_correlation"),
             Contains(std::to_string(std::lround(100.0 * peak * peak)) +
                      " % of the residual variance is linearly explained by the input"));
}

TEST_CASE("stored residual tests: to which side a residual is skewed, and its tails", "[report]") {
  std::vector<double> right = white(2000, 9);
  for (double& each : right) each = std::exp(0.8 * each);
  std::vector<double> left = right;
  for (double& each : left) each = -each;
  const auto of = [](const std::vector<double>& residual) {
    return words(residual_tests_json(residual_tests(residual, white(2000, 10), 0.01), "m"),
                 "normality");
  };
  CHECK_THAT(of(right), Contains("heavy tails or rare bursts, skewed to the right"));
  CHECK_THAT(of(left), Contains("heavy tails or rare bursts, skewed to the left"));
  std::vector<double> light = white(2000, 11);
  for (double& each : light) each = std::erf(each);  // almost uniform
  CHECK_THAT(of(light), Contains("light tails") && !Contains("heavy") && !Contains("skewed"));
}

TEST_CASE("stored residual tests: a trend is told over the whole record", "[report]") {
  rigcal::metrics::ResidualTests tests;
  tests.samples = 2000;
  tests.sample_interval_s = 0.01;
  tests.drift.outcome = rigcal::metrics::TestOutcome::failed;
  tests.drift.mean = 1.5e-3;
  tests.drift.slope_per_s = 2e-4;  // multiplied by 20 s
  CHECK_THAT(words(residual_tests_json(tests, "m"), "drift"),
             Contains("offset 1.5 mm") && Contains("trend 4 mm over the record"));
}

TEST_CASE("stored residual tests: curves of whiteness are stored, and may be missing", "[report]") {
  rigcal::calib::Fit fit;
  fit.conditions.emplace_back().id = "sine";
  const auto tests = residual_tests(white(1000, 21), white(1000, 22), 0.01);
  fit.conditions[0].residual_curves = {{Channel::position, tests.curves}};
  const rigcal::datasets::Campaign campaign;
  const std::vector<rigcal::datasets::Record> records;
  const rigcal::report::Provenance provenance;
  const auto curves = rigcal::report::stored_curves(
      {rigcal::report::ResultKind::fit, campaign, records, fit, provenance});
  Json json = json_of(curves);
  Json& channel = json["conditions"]["sine"]["position"];
  // Lag 1 is the first value.
  CHECK(channel["partial_autocorrelation"]["first_lag_s"] == 0.01);
  CHECK(channel["partial_autocorrelation"]["values"].size() == 50);
  CHECK(channel["partial_autocorrelation"]["band"] == channel["autocorrelation"]["band"]);
  CHECK(channel["cumulative_periodogram"]["limit"] == tests.periodogram.limit);
  CHECK(channel["cumulative_periodogram"]["fraction"].size() == 51);
  rigcal::calib::ConditionResult condition;
  condition.id = "sine";
  condition.channels.emplace_back().residual_tests = tests;
  const auto page_with = [&](const rigcal::calib::ChannelCurves& shown) {
    rigcal::report::doc::Blocks blocks;
    rigcal::report::add_residual_tests(condition, &shown, blocks);
    std::string html;
    rigcal::report::doc::render_html(blocks, html);
    return html;
  };
  auto shown = curves.conditions[0].second;
  CHECK_THAT(page_with(shown),
             Contains("At which frequencies is there too much power?") &&
                 Contains("partial autocorrelation, with the 95 % band of white noise"));
  // Files of earlier versions have no such curves.
  shown[0].second->partial_autocorrelation.reset();
  shown[0].second->cumulative_periodogram.reset();
  CHECK_THAT(page_with(shown), !Contains("too much power") && Contains("periodogram"));
}
