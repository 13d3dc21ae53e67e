#include "calib/score/scorecard.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

#include "metrics/metric_table.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {

TEST_CASE("scorecard: the residual is measured minus simulated, of the longest stretch",
          "[calib]") {
  Twin twin;
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01).windows = {{0.0995, 0.2995},
                                                                   {0.3995, 0.9995}};
  auto records = twin.records(1000, 1000.0, 3);
  for (double& each : records[0].channels[datasets::Channel::position].mean) each += 1e-4;
  const Problem problem = problem_of(twin, records);
  REQUIRE(problem.conditions[0].rows.size() == 800);
  const auto scores = score_conditions(problem, problem.start(), 1);
  const auto& tests = scores.at(0).channels.at(0).residual_tests;
  REQUIRE(tests.has_value());
  CHECK(tests->samples == 600);
  // The standard error is the noise, 5e-5, divided by the square root of 600; the limit is about
  // four times that.
  CHECK_THAT(tests->drift.mean, Catch::WithinAbs(1e-4, 1e-5));
}

TEST_CASE("scorecard: the budget of a score adds up by hand to the uncertainty that is printed",
          "[calib]") {
  Twin twin;
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
  twin.campaign.channels.at(datasets::Channel::position).offset_sd = 2e-5;
  auto records = twin.records(400, 1000.0, 3);
  const Problem alone = problem_of(twin, records);
  CHECK_FALSE(score_conditions(alone, alone.start(), 1).at(0).channels.at(0).score_budgets);
  auto& deviations = records[0].channels[datasets::Channel::position].deviations;
  for (const double gain : {-0.01, 0.004, 0.006}) {
    std::vector<double>& own = deviations.emplace_back();
    for (const double y : records[0].channels[datasets::Channel::position].mean)
      own.push_back(gain * y);
  }
  EffectCovariance spread;
  spread.keys = {"position_gain", "position_lag", "ki"};
  spread.root = Eigen::Vector3d(2e-3, 1e-4, 1.0).asDiagonal();
  spread.moves = Eigen::MatrixXd::Zero(0, 3);
  const Problem problem = problem_of(twin, records);
  const ChannelScore score =
      score_conditions(problem, problem.start(), 1, spread).at(0).channels.at(0);
  REQUIRE(score.two_sided_uncertainty.has_value());
  const auto& budgets = score.score_budgets.value();
  REQUIRE(budgets.size() == metrics::kMetrics.size());
  for (std::size_t m = 0; m < budgets.size(); ++m) {
    const auto& [name, budget] = budgets[m];
    CHECK(name == metrics::kMetrics[m].name);
    double squares = 0.0;
    std::set<std::string> sources;
    for (const BudgetLine& line : budget.lines) {
      squares += line.uncertainty * line.uncertainty;
      sources.insert(line.source);
    }
    CHECK(sources == std::set<std::string>{"repeats", "noise_left", "offset_sd of position",
                                           "position_gain", "position_lag"});
    CHECK_THAT(std::sqrt(squares), Catch::WithinRel(budget.combined, 1e-9));
    CHECK_THAT(budget.coverage_factor * budget.combined, Catch::WithinRel(budget.expanded, 1e-12));
    CHECK(budget.expanded == (*score.two_sided_uncertainty).*metrics::kMetrics[m].value);
    CHECK(budget.shift == 0.0);
  }
  const Budget95& rmse = budgets.at(4).second;
  CHECK(budgets.at(4).first == "rmse");
  for (const char* kind : {"records", "known_value", "effect"})
    CHECK(rmse.contribution(kind) > 0.0);
}

TEST_CASE("scorecard: a job that was ended scores nothing more, and says why", "[calib]") {
  Twin twin;
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  const auto records = twin.records(200, 1000.0, 3);
  Problem problem = problem_of(twin, records);
  const std::atomic<bool> cancel{true};
  problem.cancel = &cancel;
  const auto scores = score_conditions(problem, problem.start(), 1);
  REQUIRE(scores.size() == 2);
  for (const ConditionScore& score : scores) {
    CHECK(score.not_scored == "stopped on request");
    CHECK_FALSE(score.failure);
    CHECK(score.channels.empty());
    CHECK(score.series.count(datasets::Channel::position) == 1);
  }
}

}  // namespace rigcal::calib
