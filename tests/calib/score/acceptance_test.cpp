#include "calib/score/acceptance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "metrics/metric_table.hpp"

// Scores exactly on a limit, just outside and just inside.

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinRel;
using datasets::AcceptanceLimit;
using datasets::Channel;
using datasets::DecisionRule;

using Value = std::optional<double>;

ConditionScore scored(const std::string& metric, double value) {
  ConditionScore score;
  ChannelScore channel;
  channel.channel = Channel::position;
  for (const metrics::MetricSpec& spec : metrics::kMetrics)
    if (spec.name == metric) channel.metrics.*spec.value = value;
  score.channels = {channel};
  return score;
}

struct Question {
  std::string metric = "rho2";
  Value limit, warn;
  DecisionRule rule = DecisionRule::simple;
};

LimitCheck answer(const Question& question, ConditionScore score) {
  judge({{Channel::position, question.metric, question.limit, question.warn}}, question.rule,
        score);
  REQUIRE(score.limit_checks.size() == 1);
  CHECK(score.verdict == score.limit_checks[0].verdict);
  CHECK(score.reasons.empty() == (score.verdict == Verdict::pass));
  return score.limit_checks[0];
}
Verdict verdict(const Question& question, double value) {
  return answer(question, scored(question.metric, value)).verdict;
}

double above(double value) { return std::nextafter(value, 1e9); }
double below(double value) { return std::nextafter(value, -1e9); }

}  // namespace

TEST_CASE("acceptance: a score on its limit keeps it", "[calib]") {
  const Question rho2{"rho2", 0.99, 0.995};
  CHECK(verdict(rho2, below(0.99)) == Verdict::fail);
  CHECK(verdict(rho2, 0.99) == Verdict::warn);
  CHECK(verdict(rho2, below(0.995)) == Verdict::warn);
  CHECK(verdict(rho2, 0.995) == Verdict::pass);
  CHECK(verdict(rho2, 1.0) == Verdict::pass);
  const Question error{"absolute_error_percent", 2.0, 1.0};
  CHECK(verdict(error, above(2.0)) == Verdict::fail);
  CHECK(verdict(error, 2.0) == Verdict::warn);
  CHECK(verdict(error, above(1.0)) == Verdict::warn);
  CHECK(verdict(error, 1.0) == Verdict::pass);
  CHECK(verdict(error, 0.0) == Verdict::pass);
  for (const char* metric : {"r", "ccc", "nrmse_fit_percent"}) {
    CHECK(verdict({metric, 0.5, {}}, 0.4) == Verdict::fail);
    CHECK(verdict({metric, 0.5, {}}, 0.6) == Verdict::pass);
  }
  for (const char* metric : {"rmse", "maximum_error"}) {
    CHECK(verdict({metric, 0.5, {}}, 0.6) == Verdict::fail);
    CHECK(verdict({metric, 0.5, {}}, 0.4) == Verdict::pass);
  }
}

TEST_CASE("acceptance: a limit alone, or a warning limit alone", "[calib]") {
  CHECK(verdict({"rho2", 0.99, {}}, 0.9899) == Verdict::fail);
  CHECK(verdict({"rho2", 0.99, {}}, 0.9901) == Verdict::pass);
  CHECK(verdict({"rho2", {}, 0.995}, 0.5) == Verdict::warn);
  CHECK(verdict({"rho2", {}, 0.995}, 0.996) == Verdict::pass);
}

TEST_CASE("acceptance: the tolerance is that of the limit, of the warning limit where it is alone",
          "[calib]") {
  const auto used = [](const Question& question, double value) {
    return answer(question, scored(question.metric, value)).tolerance_used.value();
  };
  CHECK_THAT(used({"rho2", 0.98, 0.99}, 0.99), WithinRel(0.5, 1e-9));
  CHECK_THAT(used({"rho2", 0.98, 0.99}, 0.96), WithinRel(2.0, 1e-9));
  CHECK_THAT(used({"rho2", {}, 0.99}, 0.995), WithinRel(0.5, 1e-9));
  CHECK_THAT(used({"absolute_error_percent", 4.0, 2.0}, 1.0), WithinRel(0.25, 1e-12));
  CHECK_THAT(used({"absolute_error_percent", 4.0, 2.0}, 8.0), WithinRel(2.0, 1e-12));
  CHECK_THAT(used({"nrmse_fit_percent", 90.0, {}}, 95.0), WithinRel(0.5, 1e-12));  // ideal: 100
  CHECK_THAT(used({"rmse", 2e-3, {}}, 5e-4), WithinRel(0.25, 1e-12));
  // A limit equal to the ideal value.
  CHECK(used({"rho2", 1.0, {}}, 1.0) == 0.0);
  CHECK(std::isinf(used({"rho2", 1.0, {}}, 0.999)));
  CHECK(used({"absolute_error_percent", 0.0, {}}, 0.0) == 0.0);
}

TEST_CASE("acceptance: the guard band ends where the uncertainty does", "[calib]") {
  // The numbers are sums of powers of two, so that a score can be exactly at the end of its guard
  // band.
  const auto guarded = [](double value, Value uncertainty, const Question& question) {
    ConditionScore score = scored(question.metric, value);
    if (uncertainty) {
      score.channels[0].expanded_uncertainty.emplace();
      for (const metrics::MetricSpec& spec : metrics::kMetrics)
        if (spec.name == question.metric)
          (*score.channels[0].expanded_uncertainty).*spec.value = *uncertainty;
    }
    return answer(question, score);
  };
  const Question rho2{"rho2", 0.5, {}, DecisionRule::guard_band};
  CHECK(guarded(0.75, 0.25, rho2).verdict == Verdict::pass);
  CHECK(guarded(0.75, above(0.25), rho2).verdict == Verdict::warn);
  CHECK(guarded(0.75, 0.125, rho2).verdict == Verdict::pass);
  CHECK_FALSE(guarded(0.75, 0.25, rho2).in_guard_band);
  CHECK(guarded(0.5, 0.0, rho2).verdict == Verdict::pass);
  CHECK(guarded(0.5, 1e-9, rho2).in_guard_band);
  CHECK(guarded(0.25, 10.0, rho2).verdict == Verdict::fail);  // a large uncertainty does not help
  CHECK_FALSE(guarded(0.25, 10.0, rho2).in_guard_band);
  const Question error{"absolute_error_percent", 2.0, {}, DecisionRule::guard_band};
  CHECK(guarded(1.5, 0.5, error).verdict == Verdict::pass);
  CHECK(guarded(1.5, 0.5 + 1e-9, error).verdict == Verdict::warn);
  CHECK(guarded(2.5, 10.0, error).verdict == Verdict::fail);
  // Without an uncertainty the guard band cannot be evaluated.
  CHECK(guarded(0.99, std::nullopt, rho2).in_guard_band);
  CHECK(guarded(0.99, std::nullopt, rho2).verdict == Verdict::warn);
  CHECK_FALSE(guarded(0.99, std::nullopt, rho2).expanded_uncertainty.has_value());
  CHECK(guarded(0.75, 0.125, rho2).expanded_uncertainty == 0.125);
  // Only the limit has a guard band; the warning limit has none.
  const Question both{"rho2", 0.5, 0.75, DecisionRule::guard_band};
  CHECK_FALSE(guarded(0.625, 0.5, both).in_guard_band);
  CHECK(guarded(0.625, 0.5, both).verdict == Verdict::warn);
  CHECK(guarded(0.875, 0.25, both).verdict == Verdict::pass);
  CHECK(guarded(0.875, 0.5, both).in_guard_band);
  CHECK(guarded(0.875, 0.5, {"rho2", {}, 0.75, DecisionRule::guard_band}).verdict == Verdict::pass);
  CHECK(guarded(0.875, 0.5, {"rho2", 0.5, {}, DecisionRule::simple}).verdict == Verdict::pass);
}

TEST_CASE("acceptance: the noise is blamed where it alone keeps a score from its limit",
          "[calib]") {
  const auto words = [](const Question& question, double value, metrics::NoiseFloor floor) {
    ConditionScore score = scored(question.metric, value);
    score.channels[0].noise_floor = floor;
    return answer(question, score).words;
  };
  const std::string blamed = "; the noise of the record allows ";
  CHECK_THAT(words({"rho2", 0.99, {}}, 0.9, {0.98, 1.0, 0.0}),
             Contains("rho2 = 0.9000 is below 0.99" + blamed + "0.9800 at best"));
  CHECK_THAT(words({"rho2", 0.99, {}}, 0.9, {0.991, 0.1, 9.0}), !Contains(blamed));
  CHECK_THAT(words({"rho2", 0.99, {}}, 0.9, {0.99, 0.1, 9.0}), !Contains(blamed));
  CHECK_THAT(words({"ccc", 0.99, {}}, 0.9, {1.0, 0.97, 0.0}), Contains(blamed + "0.9700 at best"));
  CHECK_THAT(words({"ccc", 0.99, {}}, 0.9, {0.1, 0.995, 9.0}), !Contains(blamed));
  const Question error{"absolute_error_percent", 2.0, {}};
  CHECK_THAT(words(error, 3.0, {1.0, 1.0, 2.5}),
             Contains("= 3 is above 2" + blamed + "2.5 at best"));
  CHECK_THAT(words(error, 3.0, {0.0, 0.0, 1.5}), !Contains(blamed));
  CHECK_THAT(words(error, 3.0, {0.0, 0.0, 2.0}), !Contains(blamed));
  CHECK_THAT(words({"rmse", 1.0, {}}, 3.0, {0.0, 0.0, 9.0}), !Contains(blamed));
  // A warning is compared with the warning limit.
  CHECK_THAT(words({"rho2", 0.9, 0.99}, 0.95, {0.98, 1.0, 0.0}),
             Contains("is below 0.99" + blamed + "0.9800"));
}

TEST_CASE("acceptance: a check tells what it was made of", "[calib]") {
  const LimitCheck check = answer({"rho2", 0.9, 0.95}, scored("rho2", 0.97));
  CHECK(check.channel == Channel::position);
  CHECK(check.metric == "rho2");
  CHECK(check.value == 0.97);
  CHECK(check.limit == 0.9);
  CHECK(check.warn == 0.95);
  CHECK(check.words.empty());
  CHECK_THROWS_AS(answer({"rho", 0.9, {}}, scored("rho2", 0.97)), std::invalid_argument);
}

TEST_CASE("acceptance: the verdict is the worst, of the channels that have a limit", "[calib]") {
  ConditionScore score = scored("rho2", 0.97);
  ChannelScore pressure = score.channels[0];
  pressure.channel = Channel::load_pressure;
  pressure.metrics.rho2 = 0.5;
  score.channels.push_back(pressure);
  const AcceptanceLimit position{Channel::position, "rho2", 0.9, 0.98};
  const AcceptanceLimit load{Channel::load_pressure, "rho2", 0.4, std::nullopt};
  ConditionScore of_position = score;
  judge({position}, DecisionRule::simple, of_position);
  CHECK(of_position.verdict == Verdict::warn);
  CHECK(of_position.limit_checks.size() == 1);
  for (const auto& limits : {std::vector{position, load}, std::vector{load, position}}) {
    ConditionScore both = score;
    judge(limits, DecisionRule::simple, both);
    CHECK(both.limit_checks.size() == 2);
    CHECK(both.verdict == Verdict::warn);
    CHECK(both.reasons.size() == 1);
  }
  ConditionScore unrecorded = score;
  judge({{Channel::pressure_a, "rho2", 0.4, std::nullopt}}, DecisionRule::simple, unrecorded);
  CHECK_FALSE(unrecorded.verdict.has_value());
}

TEST_CASE("acceptance: what could not be simulated fails without checks", "[calib]") {
  ConditionScore score = scored("rho2", 1.0);
  score.failure = "too many steps";
  judge({{Channel::position, "rho2", 0.4, std::nullopt}}, DecisionRule::simple, score);
  CHECK(score.verdict == Verdict::fail);
  CHECK(score.limit_checks.empty());
  REQUIRE(score.reasons.size() == 1);
  CHECK_THAT(score.reasons[0], Contains("could not be simulated: too many steps"));
  ConditionScore unlimited = score;
  unlimited.verdict.reset();
  judge({}, DecisionRule::simple, unlimited);
  CHECK_FALSE(unlimited.verdict.has_value());
}

}  // namespace rigcal::calib
