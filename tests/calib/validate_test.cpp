#include <catch2/catch.hpp>

#include "calib/fit.hpp"
#include "calib/score/acceptance.hpp"
#include "calib/score/scorecard.hpp"
#include "calib/search/multi_start.hpp"
#include "common/error.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::DecisionRule;
using datasets::Scope;
using datasets::Use;
using datasets::Waveform;

/// Leakage for each level, and a position offset for each condition that is estimated again in
/// validation.
Twin two_days() {
  Twin twin;
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.free("leakage_coefficient", 0.2, 0.0, 5.0, Scope::leak_level);
  twin.free("position_offset", 0.0, -5e-3, 5e-3, Scope::condition).nuisance = true;
  twin.level_leakage = {{"low", 0.2}, {"high", 0.6}};
  twin.offsets["day1_low"] = {Twin::index("position_offset"), 1e-3};
  twin.offsets["day2"] = {Twin::index("position_offset"), -2e-3};
  twin.add("day1_low", Waveform::square, 2.0, 0.01, "low");
  twin.add("day1_high", Waveform::sine, 2.0, 0.01, "high");
  twin.add("day2", Waveform::sine, 3.0, 0.01, "low", Use::validate);
  return twin;
}

std::vector<datasets::FittedValue> truth() {
  return {{Twin::index("valve_gain"), Scope::rig, "", 0.0406e-3},
          {Twin::index("leakage_coefficient"), Scope::leak_level, "low", 0.2},
          {Twin::index("leakage_coefficient"), Scope::leak_level, "high", 0.6}};
}

ConditionScore scored(double rho2) {
  ConditionScore score;
  ChannelScore channel;
  channel.metrics.rho2 = rho2;
  channel.metrics.absolute_error_percent = 2.0;
  score.channels.push_back(channel);
  return score;
}

datasets::AcceptanceLimit limit(const std::string& metric, double fail,
                                std::optional<double> warn = std::nullopt) {
  return {datasets::Channel::position, metric, fail, warn};
}

}  // namespace

TEST_CASE("fit: validate conditions are scored with their own nuisance offset", "[calib]") {
  const Twin twin = two_days();
  const Fit found = fit(twin.campaign, twin.records(400, 500.0, 5), {});
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.conditions.size() == 3);
  CHECK(found.conditions[2].id == "day2");
  CHECK(found.conditions[2].use == Use::validate);
  const FittedParameter& offset = parameter(found, "position_offset", "day2");
  CHECK(offset.nuisance);
  CHECK(std::abs(offset.value + 2e-3) < 3.5 * offset.standard_error.value());
  const ChannelScore& score = found.conditions[2].channels.at(0);
  CHECK(score.metrics.ccc > 0.999);  // ccc would detect a wrong offset of 2 mm
  REQUIRE(score.noise_floor.has_value());
  CHECK_THAT(score.metrics.gain_ratio.value(), WithinAbs(1.0, 0.01));
}

TEST_CASE("validate: estimates nothing but nuisance parameters", "[calib]") {
  const Twin twin = two_days();
  const auto values = truth();
  const Fit found = validate(twin.campaign, twin.records(400, 500.0, 5), &values, {});
  CHECK(found.status == FitStatus::converged);
  CHECK(found.conditions.size() == 3);
  for (const FittedParameter& each : found.parameters) {
    CAPTURE(each.key);
    CHECK(each.fitted == each.nuisance);
    // A known value has neither bounds nor a grade.
    CHECK(each.lower.has_value() == each.fitted);
    CHECK(each.upper.has_value() == each.fitted);
    CHECK(each.identifiability.has_value() == each.fitted);
    CHECK(each.index == Twin::index(each.key));
  }
  const FittedParameter& offset = parameter(found, "position_offset", "day1_low");
  CHECK(std::abs(offset.value - 1e-3) < 3.5 * offset.standard_error.value());
}

TEST_CASE("validate: tells the values that it used, not those of the campaign", "[calib]") {
  const Twin twin = two_days();
  const auto values = truth();
  const Fit found = validate(twin.campaign, twin.records(400, 500.0, 5), &values, {});
  const auto of = [&](std::string_view key, const std::string& level) {
    std::vector<double> told;
    for (const FittedParameter& each : found.parameters) {
      if (each.index == Twin::index(key) && each.level.value_or("") == level)
        told.push_back(each.value);
    }
    return told;
  };
  CHECK(of("valve_gain", "") == std::vector{0.0406e-3});
  CHECK(of("leakage_coefficient", "").empty());
  CHECK(of("leakage_coefficient", "low") == std::vector{0.2});
  CHECK(of("leakage_coefficient", "high") == std::vector{0.6});
}

TEST_CASE("validate: without values, those of the campaign hold", "[calib]") {
  Twin twin = two_days();
  for (auto& each : twin.campaign.parameters) each.fit = false;
  const Fit found = validate(twin.campaign, twin.records(400, 500.0, 5), nullptr, {});
  CHECK(found.status == FitStatus::converged);
  CHECK(found.evaluations == 0);
  CHECK(found.conditions.at(0).channels.at(0).metrics.rho2 < 0.999);  // scored with the start value
}

TEST_CASE("validate: a leak level that the fit does not have is an error", "[calib]") {
  Twin twin = two_days();
  auto values = truth();
  values.pop_back();
  const auto records = twin.records(50, 500.0, 5);
  CHECK_THROWS_WITH(validate(twin.campaign, records, &values, {}),
                    Contains("leak level \"high\"") && Contains("leakage_coefficient") &&
                        Contains("only for \"low\""));
  SECTION("unless the campaign knows its value") {
    twin.campaign.leak_levels["high"].emplace_back(Twin::index("leakage_coefficient"), 0.6);
    CHECK(validate(twin.campaign, records, &values, {}).conditions.size() == 3);
  }
}

TEST_CASE("fit: a validate condition at a leak level of its own is an error", "[calib]") {
  Twin twin = two_days();
  twin.campaign.conditions[2].leak_level = "new";
  CHECK_THROWS_AS(fit(twin.campaign, twin.records(50, 500.0, 5), {}), InputError);
}

TEST_CASE("validate: a parameter that the fit lacks is an error", "[calib]") {
  const Twin twin = two_days();
  auto values = truth();
  values.erase(values.begin());
  CHECK_THROWS_WITH(validate(twin.campaign, twin.records(50, 500.0, 5), &values, {}),
                    Contains("no value for valve_gain"));
}

TEST_CASE("scorecard: a condition is judged by limits of its own if it has any", "[calib]") {
  Twin twin = two_days();
  twin.campaign.acceptance = {limit("rho2", 2.0, 2.0)};
  twin.campaign.conditions[1].acceptance = {{limit("rho2", 0.5, 0.5)}};
  twin.campaign.conditions[2].acceptance.emplace();
  const auto values = truth();
  const Fit found = validate(twin.campaign, twin.records(400, 500.0, 5), &values, {});
  CHECK(found.conditions.at(0).verdict == Verdict::fail);
  CHECK(found.conditions.at(1).verdict == Verdict::pass);
  CHECK_FALSE(found.conditions.at(2).verdict.has_value());
}

TEST_CASE("scorecard: a constant record has a problem in words, no number", "[calib]") {
  Twin twin;
  twin.noise_sd_m = 0.0;
  twin.add("still", Waveform::sine, 2.0, 0.0);
  const Fit found = validate(twin.campaign, twin.records(100, 500.0, 1), nullptr, {});
  const ChannelScore& score = found.conditions.at(0).channels.at(0);
  CHECK(std::isnan(score.metrics.rho2));
  CHECK_THAT(score.metrics.problem.value(), Contains("constant"));
}

TEST_CASE("scorecard: better than the noise allows is called overfitting", "[calib]") {
  ConditionScore score = scored(0.9999);
  score.id = "a";
  score.samples = 10000;
  score.channels[0].noise_floor = metrics::NoiseFloor{0.999, 0.999, 0.1};
  REQUIRE(overfitting_warnings({score}).size() == 1);
  CHECK_THAT(overfitting_warnings({score})[0], Contains("\"a\"") && Contains("overfitting"));
  score.channels[0].metrics.rho2 = 0.99901;
  CHECK(overfitting_warnings({score}).empty());
}

TEST_CASE("acceptance: FAIL beyond the limit, WARN between, PASS above both", "[calib]") {
  const std::vector<datasets::AcceptanceLimit> limits{limit("rho2", 0.99, 0.995)};
  for (const auto& [rho2, verdict] :
       {std::pair{0.98, Verdict::fail}, std::pair{0.992, Verdict::warn},
        std::pair{0.995, Verdict::pass}}) {
    ConditionScore score = scored(rho2);
    judge(limits, DecisionRule::simple, score);
    CHECK(score.verdict == verdict);
    CHECK(score.reasons.empty() == (verdict == Verdict::pass));
  }
  ConditionScore failing = scored(0.98);
  judge(limits, DecisionRule::simple, failing);
  CHECK_THAT(failing.reasons.at(0), Contains("rho2 = 0.98") && Contains("0.99"));
}

TEST_CASE("acceptance: how much of a tolerance is used, and the worst of several limits",
          "[calib]") {
  ConditionScore score = scored(0.995);
  judge({limit("rho2", 0.99, 0.993), limit("absolute_error_percent", 8.0, 6.0)},
        DecisionRule::simple, score);
  REQUIRE(score.limit_checks.size() == 2);
  CHECK_THAT(score.limit_checks[0].tolerance_used.value(), WithinRel(0.5, 1e-9));  // 0.005 of 0.01
  CHECK_THAT(score.limit_checks[1].tolerance_used.value(), WithinRel(0.25, 1e-9));
  CHECK(score.verdict == Verdict::pass);
  for (const double worse : {1.0, 2.0}) {
    ConditionScore mixed = scored(0.995);
    judge({limit("rho2", 0.99, 0.993), limit("absolute_error_percent", worse, 0.5)},
          DecisionRule::simple, mixed);
    CHECK(mixed.verdict == (worse < 2.0 ? Verdict::fail : Verdict::warn));  // 2 is on the limit
  }
}

TEST_CASE("acceptance: lower is better for errors, and no limit means no verdict", "[calib]") {
  ConditionScore score = scored(1.0);
  judge({limit("absolute_error_percent", 1.0, 0.5)}, DecisionRule::simple, score);
  CHECK(score.verdict == Verdict::fail);
  CHECK_THAT(score.reasons.at(0), Contains("above 1"));
  ConditionScore unjudged = scored(0.1);
  judge({}, DecisionRule::simple, unjudged);
  CHECK_FALSE(unjudged.verdict.has_value());
}

TEST_CASE("acceptance: by the guard band a limit is kept by more than the uncertainty, or WARN",
          "[calib]") {
  const std::vector<datasets::AcceptanceLimit> limits{limit("rho2", 0.99)};
  const auto judged = [&](double rho2, std::optional<double> uncertainty, DecisionRule rule) {
    ConditionScore score = scored(rho2);
    if (uncertainty) {
      score.channels[0].expanded_uncertainty.emplace();
      score.channels[0].expanded_uncertainty->rho2 = *uncertainty;
    }
    judge(limits, rule, score);
    return score;
  };
  const auto guarded = [&](double rho2, std::optional<double> uncertainty) {
    return judged(rho2, uncertainty, DecisionRule::guard_band);
  };
  CHECK(guarded(0.995, 0.004).verdict == Verdict::pass);
  CHECK(guarded(0.995, 0.006).verdict == Verdict::warn);
  CHECK(guarded(0.995, std::nullopt).verdict == Verdict::warn);
  CHECK(guarded(0.98, 0.1).verdict == Verdict::fail);  // a large uncertainty does not help
  CHECK(judged(0.995, 0.006, DecisionRule::simple).verdict == Verdict::pass);
  const ConditionScore near = guarded(0.995, 0.006);
  CHECK(near.limit_checks.at(0).in_guard_band);
  CHECK(near.limit_checks.at(0).expanded_uncertainty == 0.006);
  CHECK_THAT(near.reasons.at(0), Contains("keeps 0.99, but not by more than") && Contains("0.006"));
  CHECK_THAT(guarded(0.995, std::nullopt).reasons.at(0), Contains("uncertainty is unknown"));
}

TEST_CASE("acceptance: the guard band of an error lies below its limit", "[calib]") {
  ConditionScore score = scored(1.0);
  score.channels[0].expanded_uncertainty.emplace();
  score.channels[0].expanded_uncertainty->absolute_error_percent = 0.5;
  const double error = score.channels[0].metrics.absolute_error_percent;
  for (const double allowed : {error + 0.4, error + 0.6}) {
    ConditionScore each = score;
    judge({limit("absolute_error_percent", allowed)}, DecisionRule::guard_band, each);
    CHECK(each.verdict == (allowed < error + 0.5 ? Verdict::warn : Verdict::pass));
  }
}

TEST_CASE("acceptance: what could not be simulated or evaluated fails", "[calib]") {
  const std::vector<datasets::AcceptanceLimit> limits{limit("rho2", 0.99, 0.995)};
  ConditionScore broken;
  broken.failure = "too many steps";
  judge(limits, DecisionRule::simple, broken);
  CHECK(broken.verdict == Verdict::fail);
  ConditionScore constant = scored(1.0);
  constant.channels[0].metrics = ChannelMetrics{};
  constant.channels[0].metrics.problem = "constant";
  judge(limits, DecisionRule::simple, constant);
  CHECK(constant.verdict == Verdict::fail);
  CHECK_THAT(constant.reasons.at(0), Contains("cannot be evaluated") && Contains("constant"));
}

TEST_CASE("latin hypercube: one point in every stratum, from the seed alone", "[calib]") {
  const auto points = latin_hypercube(10, 3, 42);
  for (std::size_t d = 0; d < 3; ++d) {
    std::vector<int> hits(10);
    for (const auto& point : points) ++hits.at(static_cast<std::size_t>(point[d] * 10.0));
    CHECK(hits == std::vector<int>(10, 1));
  }
  CHECK(points == latin_hypercube(10, 3, 42));
  CHECK(points != latin_hypercube(10, 3, 43));
}

}  // namespace rigcal::calib
