#include "calib/trust/between_repeats.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "calib/trust/known_uncertainty.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "metrics/distributions.hpp"
#include "tests/calib/twin.hpp"
#include "tests/support/sanitized.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const MatrixXd kNoPriors = MatrixXd::Zero(1, 1);
const MatrixXd kOne = MatrixXd::Identity(1, 1);

ScoreContribution scatter(double variance, double freedom) {
  ScoreContribution result;
  result.covariance = MatrixXd::Constant(1, 1, variance);
  result.freedom = VectorXd::Constant(1, freedom);
  return result;
}

MatrixXd row(std::initializer_list<double> values) {
  MatrixXd result(1, static_cast<Index>(values.size()));
  Index column = 0;
  for (const double value : values) result(0, column++) = value;
  return result;
}

TEST_CASE("between repeats: variance of the mean, freedom by Satterthwaite", "[calib]") {
  // sum s^2 / (R (R - 1)): 2 / 2 and 8 / 6.
  const auto found = repeat_variance({row({1.0, -1.0}), row({2.0, 0.0, -2.0})},
                                     {scatter(9.0, 9.0), scatter(9.0, 9.0)}, kNoPriors, kOne, 0);
  CHECK_THAT(found.variance, WithinRel(1.0 + 4.0 / 3.0, 1e-12));
  CHECK_THAT(found.freedom, WithinRel(std::pow(7.0 / 3.0, 2) / (1.0 + 16.0 / 18.0), 1e-12));

  // A condition with one repeat adds the variance from its residuals. A prior adds its own
  // variance.
  const auto mixed =
      repeat_variance({row({1.0, -1.0}), MatrixXd()}, {scatter(9.0, 9.0), scatter(3.0, 4.0)},
                      MatrixXd::Constant(1, 1, 0.5), kOne, 0);
  CHECK_THAT(mixed.variance, WithinRel(4.5, 1e-12));
  CHECK_THAT(mixed.freedom, WithinRel(4.5 * 4.5 / (1.0 + 9.0 / 4.0), 1e-12));
}

TEST_CASE("between repeats: a known random effect of a linear model", "[calib]") {
  // Repeat r measures an additional a_r g, so that the estimate from the mean is off by
  // mean(a) g . j.
  const VectorXd j = VectorXd::LinSpaced(50, 0.0, 1.0).normalized();
  const VectorXd g = VectorXd::Constant(50, 2.0);
  const std::vector<double> a{3.0, -1.0, 0.5, 1.5};
  MatrixXd measured(50, 4);
  for (Index r = 0; r < 4; ++r) measured.col(r) = a[static_cast<std::size_t>(r)] * g;
  const MatrixXd deviations = measured.colwise() - measured.rowwise().mean();
  const auto found =
      repeat_variance({repeat_scores(j, deviations)}, {scatter(1.0, 1.0)}, kNoPriors, kOne, 0);
  const double spread = (4.0 + 4.0 + 0.25 + 0.25) / 3.0;  // deviations of a from its mean of 1
  CHECK_THAT(found.variance, WithinRel(spread / 4.0 * std::pow(j.dot(g), 2), 1e-12));
  CHECK_THAT(found.freedom, WithinRel(3.0, 1e-12));
  // What all repeats have in common, as after their inputs have been accounted for, is no
  // difference between them.
  const MatrixXd common = deviations.colwise() + 0.7 * g;
  CHECK((repeat_scores(j, common) - repeat_scores(j, deviations)).norm() < 1e-12);
}

TEST_CASE("between repeats: identical repeats, or none, say nothing", "[calib]") {
  const RobustVariance robust{1.0, 20.0, 0.0};
  for (const MatrixXd& scores : {MatrixXd(), row({0.0, 0.0, 0.0})}) {
    const auto found = repeat_variance({scores}, {scatter(1.0, 5.0)}, kNoPriors, kOne, 0);
    CHECK(found.freedom == 0.0);
    CHECK_FALSE(rests_on_repeats(found, robust));
    CHECK(exceedance(found, robust) == 1.0);
  }
}

TEST_CASE("between repeats: the upper quartile of F decides", "[calib]") {
  // scipy.stats.f.ppf(0.75, 4, 20) = 1.465...
  const RobustVariance robust{2.0, 20.0, 0.0};
  CHECK_FALSE(rests_on_repeats({2.0 * 1.46, 4.0}, robust));
  CHECK(rests_on_repeats({2.0 * 1.47, 4.0}, robust));
}

/// Returns the fraction of draws in which the interval includes the true value, if a slow effect of
/// this size differs between four repeats of six conditions.
double coverage(double effect_sd, int draws) {
  constexpr Index kSamples = 60;
  constexpr Index kRepeats = 4;
  constexpr Index kConditions = 6;
  boost::random::mt19937_64 random(5);
  boost::random::normal_distribution<double> normal;
  VectorXd j(kSamples);
  for (Index t = 0; t < kSamples; ++t) j(t) = std::sin(0.2 * static_cast<double>(t));
  j /= j.norm() * std::sqrt(static_cast<double>(kConditions));
  int held = 0;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<MatrixXd> measured;
    double found = 0.0;
    for (Index c = 0; c < kConditions; ++c) {
      MatrixXd& repeats = measured.emplace_back(kSamples, kRepeats);
      for (Index r = 0; r < kRepeats; ++r) {
        const double effect = effect_sd * normal(random);
        for (Index t = 0; t < kSamples; ++t) repeats(t, r) = 2.0 * normal(random) + effect * j(t);
      }
      found += j.dot(repeats.rowwise().mean());
    }
    std::vector<ScoreRows> rows;
    std::vector<MatrixXd> scores;
    for (const MatrixXd& repeats : measured) {
      const VectorXd mean = repeats.rowwise().mean();
      rows.push_back({j, mean - j * found, 1});
      scores.push_back(repeat_scores(j, repeats.colwise() - mean));
    }
    const auto by_residuals = score_contributions(rows, kNoPriors, kOne);
    const auto robust = robust_variance(by_residuals, kNoPriors, kOne, 0);
    const auto spread = repeat_variance(scores, by_residuals, kNoPriors, kOne, 0);
    const double half = rests_on_repeats(spread, robust)
                            ? student_t(spread.freedom) * std::sqrt(spread.variance)
                            : robust.quantile() * std::sqrt(robust.variance);
    held += std::abs(found) <= half ? 1 : 0;
  }
  return static_cast<double>(held) / draws;
}

TEST_CASE("between repeats: intervals cover whatever differs between repeats", "[calib]") {
  const int draws = test::kSanitized ? 200 : 800;
  const double scatter_of_share = 4.0 * std::sqrt(0.05 * 0.95 / draws);
  for (const double effect : {0.0, 5.0, 30.0})
    CHECK_THAT(coverage(effect, draws), WithinAbs(0.95, 0.02 + scatter_of_share));
}

TEST_CASE("between repeats: what aligned repeats were shifted by is theirs again", "[calib]") {
  datasets::Condition settings;
  settings.waveform = datasets::Waveform::sine;
  datasets::Record record;
  record.repeat_reports = {{"a", 0.002, 0.0, false, 0.002}, {"b", -0.002, 0.0, false, -0.002}};
  datasets::Series ramp;  // slope of 3 m/s
  for (int i = 0; i < 5; ++i) {
    record.time_s.push_back(0.01 * i);
    ramp.mean.push_back(0.03 * i);
  }
  ramp.deviations.assign(2, std::vector<double>(5, 0.0));
  record.channels[datasets::Channel::position] = ramp;
  ProblemCondition condition;
  condition.condition = &settings;
  condition.record = &record;
  condition.rows = {0, 1, 2, 3, 4};
  condition.channels.push_back({datasets::Channel::position, ramp.mean, 0.5, true, 0.12});
  const MatrixXd late = repeat_deviations(condition, {});
  REQUIRE(late.cols() == 2);
  for (Index t = 0; t < 5; ++t) {
    CHECK_THAT(late(t, 0), WithinRel(-0.002 * 3.0 / 0.5, 1e-9));
    CHECK_THAT(late(t, 1), WithinRel(0.002 * 3.0 / 0.5, 1e-9));
  }
  settings.waveform = datasets::Waveform::recorded;
  CHECK(repeat_deviations(condition, {}).isZero());
}

TEST_CASE("between repeats: starts at different times are named, a mixture is not", "[calib]") {
  Twin twin;
  twin.free("mass", 80.0, 10.0, 500.0);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  auto records = twin.records(40, 500.0, 1);
  datasets::Series& ramp = records[0].channels[datasets::Channel::position];
  for (std::size_t i = 0; i < 40; ++i) ramp.mean[i] = 3.0 * records[0].time_s[i];  // slope of 3 m/s
  const Problem problem = problem_of(twin, records);
  const double sd = problem.conditions[0].channels[0].sd;
  ScoreRows rows;
  rows.jacobian = MatrixXd(40, 3);
  for (Index t = 0; t < 40; ++t) {
    const double phase = 0.1 * static_cast<double>(t);
    rows.jacobian.row(t) << std::sin(phase), std::cos(2.0 * phase), phase * phase;
  }
  // The four repeats began at these times, whose standard deviation is sqrt(14 / 3) ms.
  const std::vector<double> late_s{3e-3, -1e-3, 0.0, -2e-3};
  MatrixXd deviations(40, 4);
  for (Index r = 0; r < 4; ++r)
    deviations.col(r).setConstant(-3.0 * late_s[static_cast<std::size_t>(r)] / sd);
  const MatrixXd scores = repeat_scores(rows.jacobian, deviations);
  const std::vector<double> start = problem.start();
  CauseEffects effects(problem, start);
  const auto found = likely_difference(effects, {rows}, {scores});
  REQUIRE(found.has_value());
  CHECK(found->cause == "start");
  CHECK_THAT(found->sd, WithinRel(1e-3 * std::sqrt(14.0 / 3.0), 1e-9));
  CHECK_THAT(found->explained, WithinRel(1.0, 1e-9));

  // With an equal amount in each direction perpendicular to the cause, no cause explains four
  // fifths.
  MatrixXd mixture = scores;
  const VectorXd along = scores.col(0).normalized();
  for (Index r = 0; r < 3; ++r) {
    VectorXd across = VectorXd::Unit(3, r) - along(r) * along;
    mixture.col(r) += scores.col(0).norm() * across.normalized();
  }
  CHECK_FALSE(likely_difference(effects, {rows}, {mixture}));
}

/// Five repeats for each condition of a rig whose supply pressure differs by 2 % from run to run.
struct DifferingSupply {
  Twin twin;
  std::vector<datasets::Record> records;

  explicit DifferingSupply(bool recorded) {
    twin.free("valve_gain", 3.5e-5, 1e-5, 1e-4);
    twin.free("mass", 100.0, 20.0, 500.0);
    twin.add("square", datasets::Waveform::square, 1.0, 0.01).duration_s = 1.0;
    twin.add("sine", datasets::Waveform::sine, 5.0, 0.02).duration_s = 0.5;
    if (recorded)
      twin.add_channel(datasets::Channel::supply_pressure, datasets::ChannelRole::input);
    auto& synthetic = twin.campaign.synthetic_settings.emplace();
    synthetic.sample_rate_hz = 1000.0;
    synthetic.noise_sd[datasets::Channel::position] = 2e-5;
    synthetic.variation[Twin::index("supply_pressure")] = 0.02;
    for (const char* key : {"valve_gain", "mass"}) {
      const auto index = static_cast<std::size_t>(Twin::index(key));
      const auto values = datasets::values_in(twin.truth, twin.campaign.conditions.front());
      synthetic.parameters.emplace_back(Twin::index(key), values.value[index]);
    }
    const auto truth = datasets::true_campaign(twin.campaign);
    for (const auto& condition : truth.conditions) {
      std::vector<datasets::Repeat> repeats;
      for (auto& each : datasets::synthetic_repeats(truth, condition, nullptr, 3))
        repeats.push_back(std::move(each.record));
      records.push_back(datasets::average_of(twin.campaign, condition, repeats, true));
    }
  }
};

TEST_CASE("between repeats: a supply that differs is seen, and named", "[calib]") {
  const DifferingSupply rig(false);
  const Fit found = fit(rig.twin.campaign, rig.records, {});
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.between_repeats);
  CHECK(found.between_repeats->differ);
  CHECK(found.between_repeats->ratio > 2.0);
  CHECK(found.between_repeats->cause == "supply_pressure");
  CHECK_THAT(found.between_repeats->cause_sd.value(), WithinAbs(0.02, 0.01));
  CHECK_THAT(fmt::format("{}", fmt::join(found.warnings, "; ")),
             Contains("as if supply_pressure varied by"));
}

TEST_CASE("between repeats: a supply that is declared to differ accounts for what differs",
          "[calib]") {
  DifferingSupply rig(false);
  const Fit without = fit(rig.twin.campaign, rig.records, {});
  datasets::ParameterSetting& supply = rig.twin.setting("supply_pressure");
  supply.lower = supply.upper = std::numeric_limits<double>::quiet_NaN();
  datasets::differ_between_repeats(model::parameter_spec(rig.twin.campaign.rig.plant, supply.index),
                                   0.02 * supply.value, supply);
  const Fit found = fit(rig.twin.campaign, rig.records, {});
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.between_repeats);
  CHECK_FALSE(found.between_repeats->differ);
  int nuisances = 0;
  for (const FittedParameter& each : found.parameters) {
    if (each.index != supply.index) continue;
    ++nuisances;
    CHECK(each.nuisance);
    CHECK(std::abs(each.value / supply.value - 1.0) < 4.0 * 0.02 / std::sqrt(5.0));
  }
  CHECK(nuisances == 2);  // one for each condition
  for (const auto& [key, truth] : {std::pair{"valve_gain", 4.06e-5}, std::pair{"mass", 85.0}}) {
    const auto& each = parameter(found, key);
    CAPTURE(key, each.value, each.ci95->low, each.ci95->high);
    CHECK(each.ci95->low < truth);
    CHECK(each.ci95->high > truth);
  }
  CHECK(found.cost < 0.5 * without.cost);
}

TEST_CASE("difference by noise: F along the direction of a cause", "[calib]") {
  const DifferingSupply rig(false);
  Twin twin = rig.twin;
  for (datasets::ParameterSetting& setting : twin.campaign.parameters) {
    for (const auto& [index, value] : rig.twin.campaign.synthetic_settings->parameters)
      if (index == setting.index) setting.value = value;
  }
  const Problem problem = problem_of(twin, rig.records);
  const auto p_of = [](const Problem& of) {
    const std::vector<double> start = of.start();
    CauseEffects effects(of, start);
    return difference_by_noise(effects, "supply_pressure");
  };
  CHECK(p_of(problem) < 1e-6);

  // With noise only, p is below 0.1 in about a tenth of 40 campaigns.
  int below = 0;
  std::vector<datasets::Record> records = rig.records;
  boost::random::mt19937_64 bits(7);
  boost::random::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    for (datasets::Record& record : records) {
      auto& deviations = record.channels.at(datasets::Channel::position).deviations;
      for (std::size_t t = 0; t < deviations.front().size(); ++t) {
        double mean = 0.0;
        for (auto& repeat : deviations) mean += repeat[t] = 2e-5 * normal(bits);
        for (auto& repeat : deviations) repeat[t] -= mean / static_cast<double>(deviations.size());
      }
      for (auto& report : record.repeat_reports) report.shifted_s = 0.0;
    }
    const Problem noisy = problem_of(twin, records);
    below += p_of(noisy) < 0.1 ? 1 : 0;
  }
  CHECK(below >= 1);  // 4 of 40 expected; 0 or more than 10 have probabilities of 1.5 % and 0.2 %
  CHECK(below <= 10);
}

TEST_CASE("difference by noise: for two repeats Student's t of twenty stretches", "[calib]") {
  // All samples weigh alike in a later start of a ramp. A repeat then deviates along it by the mean
  // of its stretches, and the noise is their variation.
  Twin twin;
  twin.free("mass", 80.0, 10.0, 500.0);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  auto records = twin.records(40, 500.0, 1);
  datasets::Series& ramp = records[0].channels[datasets::Channel::position];
  ramp.deviations.assign(2, std::vector<double>(40));
  double mean = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    ramp.mean[i] = 3.0 * records[0].time_s[i];
    const auto stretch = static_cast<double>(i / 2);
    const double deviation = 1e-5 * (0.4 + std::sin(2.0 * stretch));
    ramp.deviations[0][i] = deviation;
    ramp.deviations[1][i] = -deviation;
    mean += deviation / 40.0;
    squares += deviation * deviation / 2.0;
  }
  const double variance = (squares - 20.0 * mean * mean) / 19.0;
  const Problem problem = problem_of(twin, records);
  const std::vector<double> start = problem.start();
  CauseEffects effects(problem, start);
  const double p = metrics::fisher_f_exceedance(20.0 * mean * mean / variance, 1.0, 19.0);
  REQUIRE(p > 0.01);
  REQUIRE(p < 0.5);
  CHECK_THAT(difference_by_noise(effects, "start"), WithinRel(p, 1e-9));
}

TEST_CASE("between repeats: a deviation is shared between what is declared and noise, by variances",
          "[calib]") {
  DifferingSupply rig(false);
  datasets::ParameterSetting& supply = rig.twin.setting("supply_pressure");
  supply.lower = supply.upper = std::numeric_limits<double>::quiet_NaN();
  datasets::differ_between_repeats(model::parameter_spec(rig.twin.campaign.rig.plant, supply.index),
                                   0.02 * supply.value, supply);
  const Problem whole = problem_of(rig.twin, rig.records);
  const VectorXd felt =
      known_sensitivities(whole, 0, whole.start(), {supply.index});  // for the mean of five repeats
  // With this deviation the supply moves a single repeat as far along its effect as noise does.
  supply.prior->sd = std::sqrt(5.0) / felt.norm();
  const Problem problem = problem_of(rig.twin, rig.records);
  const MatrixXd deviations = felt * Eigen::RowVectorXd::LinSpaced(5, -2.0, 2.0);
  const MatrixXd explained = explained_by_declared(problem, 0, problem.start(), deviations);
  REQUIRE(explained.cols() == 5);
  CHECK((explained - 0.5 * deviations).norm() < 1e-6 * deviations.norm());
}

TEST_CASE("between repeats: a recorded supply accounts for what differs", "[calib]") {
  const DifferingSupply rig(true);
  const Fit found = fit(rig.twin.campaign, rig.records, {});
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(found.between_repeats);
  CHECK_FALSE(found.between_repeats->differ);
  const auto& gain = parameter(found, "valve_gain");
  CHECK(gain.ci95->low < 4.06e-5);
  CHECK(gain.ci95->high > 4.06e-5);

  const DifferingSupply hidden(false);
  const Fit without = fit(hidden.twin.campaign, hidden.records, {});
  CHECK(*gain.robust_standard_error <
        0.3 * *parameter(without, "valve_gain").robust_standard_error);
}

}  // namespace
}  // namespace rigcal::calib
