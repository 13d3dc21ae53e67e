#include "report/residual_tests_json.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using Catch::Contains;
using rigcal::metrics::residual_tests;
using rigcal::report::Json;
using rigcal::report::residual_tests_json;

namespace {

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

TEST_CASE("residual_tests_json: white noise passes, in the words of the field", "[report]") {
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

TEST_CASE("residual_tests_json: what cannot be judged is neither passed nor failed", "[report]") {
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

TEST_CASE("residual_tests_json: the share that the input explains", "[report]") {
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
