#include "calib/trust/prediction_band.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "calib/score/scorecard.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {

using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Channel;

namespace {

/// Two unknowns, and a condition that is only predicted.
Twin predicting_twin() {
  Twin twin;
  twin.free("valve_gain", 4e-5, 1e-5, 2e-4);
  twin.free("bulk_modulus", 8e8, 1e8, 3e9);
  twin.add("fitted", datasets::Waveform::square, 2.0, 0.01);
  twin.add("predicted", datasets::Waveform::sine, 3.0, 0.01, {}, datasets::Use::validate);
  return twin;
}

const ConditionScore& score_of(const Fit& fit, const std::string& id) {
  for (const ConditionScore& each : fit.conditions)
    if (each.id == id) return each;
  throw std::runtime_error("no condition " + id);
}

const std::vector<double>& band_of(const Fit& fit, const std::string& id) {
  return score_of(fit, id).prediction_sd.at(Channel::position);
}

/// Returns the contribution of the estimates to the band, as the rms over the record.
double from_estimates(const Fit& fit, const std::string& id, double noise_sd) {
  double sum = 0.0;
  for (const double sd : band_of(fit, id)) sum += sd * sd - noise_sd * noise_sd;
  return std::sqrt(sum / static_cast<double>(band_of(fit, id).size()));
}

}  // namespace

TEST_CASE("prediction_sd: estimates and noise add up as variances", "[calib]") {
  Eigen::MatrixXd gradient(2, 2);
  gradient << 3.0, 0.0, 1.0, 1.0;
  Eigen::MatrixXd root(2, 2);  // standard deviations 1 and 2, correlation -1
  root << 1.0, 0.0, -2.0, 0.0;
  const auto sd = prediction_sd(gradient, root, 4.0);
  REQUIRE(sd.size() == 2);
  CHECK_THAT(sd[0], WithinAbs(5.0, 1e-12));
  CHECK_THAT(sd[1], WithinAbs(std::sqrt(1.0 + 16.0), 1e-12));
  CHECK(prediction_sd(Eigen::MatrixXd(3, 0), Eigen::MatrixXd(0, 0), 4.0) ==
        std::vector<double>{4.0, 4.0, 4.0});
}

TEST_CASE("prediction band: holds 95 % of the samples of fitted and new records", "[calib]") {
  Twin twin = predicting_twin();
  twin.campaign.considered.none = true;  // effects would widen the band of a record not fitted
  for (const char* id : {"fitted", "predicted"}) {
    int within = 0;
    int all = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const Fit found = fit(twin.campaign, twin.records(500, 500.0, seed), FitOptions());
      REQUIRE(found.status == FitStatus::converged);
      const auto& [measured, simulated] = score_of(found, id).series.at(Channel::position);
      for (std::size_t i = 0; i < measured.size(); ++i) {
        within += std::abs(measured[i] - simulated[i]) <= 1.96 * band_of(found, id)[i] ? 1 : 0;
        ++all;
      }
    }
    CAPTURE(id);
    // With 2000 samples the binomial standard deviation is 0.5 %.
    CHECK_THAT(100.0 * within / all, WithinAbs(95.0, 2.0));
  }
}

TEST_CASE("test_predictions: an estimate off by its error is no error of the model", "[calib]") {
  Twin twin;
  twin.add("predicted", datasets::Waveform::sine, 3.0, 0.01, {}, datasets::Use::validate);
  twin.noise_sd_m = 2e-5;
  const auto records = twin.records(1000, 500.0, 1);
  const double off = 0.98;  // factor on the valve gain
  twin.setting("valve_gain").value *= off;
  const Problem problem = problem_of(twin, records);
  const auto fails = [&](double error) {
    std::vector<ConditionScore> scores = score_conditions(problem, {}, 1);
    EstimateCovariance spread;
    spread.estimates = {{Twin::index("valve_gain"), datasets::Scope::rig, ""}};
    spread.root = Eigen::MatrixXd::Constant(1, 1, error * twin.setting("valve_gain").value / off);
    add_prediction_sd(problem, {}, spread, {}, 1, scores);
    const auto& channel = scores.front().channels.front();
    CHECK(scores.front().explained.at(channel.channel).size() ==
          problem.conditions.front().rows.size());
    test_predictions(problem, {}, scores);
    const auto& tests = channel.residual_tests.value();
    return tests.cross_correlation->failed() || tests.autocorrelation.failed();
  };
  CHECK_FALSE(fails(0.02));
  CHECK(fails(1e-5));
}

TEST_CASE("prediction band: without noise it holds the truth 95 times in a hundred", "[calib]") {
  const Twin twin = predicting_twin();
  Twin quiet = predicting_twin();
  quiet.noise_sd_m = 0.0;
  const auto truth = quiet.records(250, 500.0, 1);
  constexpr std::size_t kSample = 180;  // on a flank in the second period
  constexpr unsigned kFits = 60;
  int within = 0;
  for (unsigned seed = 1; seed <= kFits; ++seed) {
    const Fit found = fit(twin.campaign, twin.records(250, 500.0, seed), FitOptions());
    REQUIRE(found.status == FitStatus::converged);
    const double sd = band_of(found, "predicted")[kSample];
    const double estimates = std::sqrt(sd * sd - twin.noise_sd_m * twin.noise_sd_m);
    const double simulated =
        score_of(found, "predicted").series.at(Channel::position).second[kSample];
    within += std::abs(simulated - truth[1].channels.at(Channel::position).mean[kSample]) <=
                      1.96 * estimates
                  ? 1
                  : 0;
  }
  // 57 expected; the binomial standard deviation is 1.7.
  CHECK(within >= 52);
}

TEST_CASE("prediction band: grows with the covariance of the estimates", "[calib]") {
  Twin twin = predicting_twin();
  twin.campaign.considered.none = true;  // small effects do not grow with the noise
  const Fit once = fit(twin.campaign, twin.records(500, 500.0, 1), FitOptions());
  const double before = from_estimates(once, "predicted", twin.noise_sd_m);
  CHECK(before > 0.0);
  twin.noise_sd_m *= 3.0;
  const Fit noisier = fit(twin.campaign, twin.records(500, 500.0, 1), FitOptions());
  CHECK_THAT(from_estimates(noisier, "predicted", twin.noise_sd_m), WithinRel(3.0 * before, 0.3));
  // Knowing a value removes its contribution.
  Twin known_gain = predicting_twin();
  known_gain.campaign.considered.none = true;
  known_gain.setting("bulk_modulus").fit = false;
  known_gain.setting("bulk_modulus").value = 689e6;
  const Fit fewer = fit(known_gain.campaign, known_gain.records(500, 500.0, 1), FitOptions());
  CHECK(from_estimates(fewer, "predicted", known_gain.noise_sd_m) < before);
}

TEST_CASE("prediction band: an estimate of another leak level does not count", "[calib]") {
  Twin twin;
  auto& leak = twin.free("leakage_coefficient", 0.2, 0.0, 2.0, datasets::Scope::leak_level);
  leak.nuisance = false;
  twin.level_leakage = {{"small", 0.1}, {"large", 0.4}};
  twin.add("small", datasets::Waveform::square, 2.0, 0.01, "small");
  twin.add("large", datasets::Waveform::square, 2.0, 0.01, "large");
  const auto records = twin.records(250, 500.0, 2);
  const Problem problem = problem_of(twin, records);
  const std::vector<double> z(2, 0.2);
  EstimateCovariance spread;
  spread.estimates = {{Twin::index("leakage_coefficient"), datasets::Scope::leak_level, "small"},
                      {Twin::index("leakage_coefficient"), datasets::Scope::leak_level, "large"}};
  spread.root = Eigen::MatrixXd::Zero(2, 2);
  spread.root(1, 1) = 0.1;  // only for the leak level "large"
  std::vector<ConditionScore> scores(2);
  for (std::size_t i = 0; i < 2; ++i) scores[i].time_s = records[i].time_s;
  add_prediction_sd(problem, z, spread, {}, 1, scores);
  const auto widest = [&](std::size_t i) {
    const auto& sd = scores[i].prediction_sd.at(Channel::position);
    return *std::max_element(sd.begin(), sd.end());
  };
  CHECK_THAT(widest(0), WithinRel(twin.noise_sd_m, 1e-12));
  CHECK(widest(1) > 1.01 * twin.noise_sd_m);
}

TEST_CASE("prediction band: what the fit took for a change of the estimates is not in it twice",
          "[calib]") {
  Twin twin;
  twin.add("predicted", datasets::Waveform::sine, 3.0, 0.01, {}, datasets::Use::validate);
  const auto records = twin.records(250, 500.0, 2);
  const double gain = twin.setting("valve_gain").value;
  const auto simulated = [&](double valve_gain) {
    Twin other = twin;
    other.setting("valve_gain").value = valve_gain;
    const auto scores = score_conditions(problem_of(other, records), {}, 1);
    const std::vector<double>& run = scores.front().series.at(Channel::position).second;
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(run.data(), static_cast<Eigen::Index>(run.size())));
  };
  // An effect acts as a gain of 1 % more, which the fit has taken for one.
  const Eigen::MatrixXd change = simulated(1.005 * gain) - simulated(0.995 * gain);
  const Problem problem = problem_of(twin, records);
  const auto variance_with = [&](double taken) {
    std::vector<ConditionScore> scores = score_conditions(problem, {}, 1);
    EstimateCovariance spread;
    spread.estimates = {{Twin::index("valve_gain"), datasets::Scope::rig, ""}};
    spread.root = Eigen::MatrixXd::Zero(1, 1);
    spread.effects.root = Eigen::MatrixXd::Ones(1, 1);
    spread.effects.moves = Eigen::MatrixXd::Constant(1, 1, taken * 0.01 * gain);
    add_prediction_sd(problem, {}, spread, {{change}}, 1, scores);
    double variance = 0.0;
    for (const double sd : scores.front().prediction_sd.at(Channel::position))
      variance += sd * sd - twin.noise_sd_m * twin.noise_sd_m;
    return variance;
  };
  CHECK_THAT(variance_with(0.0), WithinRel(change.squaredNorm(), 1e-6));
  CHECK_THAT(variance_with(1.0), WithinAbs(0.0, 1e-3 * change.squaredNorm()));
}

TEST_CASE("prediction band: on another day its own deviation counts, and those of the fit's days",
          "[calib]") {
  Twin twin = predicting_twin();
  twin.campaign.conditions[1].date = "2026-03-09";
  const auto records = twin.records(250, 500.0, 2);
  const Problem problem = problem_of(twin, records);
  const auto by_days = [&](const std::vector<std::string>& dates) {
    EstimateCovariance spread;
    spread.dates = dates;
    std::vector<ConditionScore> scores = score_conditions(problem, problem.start(), 1);
    add_prediction_sd(problem, problem.start(), spread, {}, 1, scores);
    double variance = 0.0;
    for (const double sd : scores[1].prediction_sd.at(Channel::position))
      variance += sd * sd - twin.noise_sd_m * twin.noise_sd_m;
    return variance;
  };
  const double one = by_days({"2026-03-01"});
  CHECK(one > 0.0);
  CHECK_THAT(by_days({"2026-03-01", "2026-03-02", "2026-03-03", "2026-03-04"}),
             WithinRel(one * (1.0 + 1.0 / 4.0) / (1.0 + 1.0), 1e-6));
  CHECK_THAT(by_days({"2026-03-09"}), WithinAbs(0.0, 1e-9 * one));
  CHECK_THAT(by_days({}), WithinAbs(0.0, 1e-9 * one));
}

TEST_CASE("test_predictions: what differs from day to day is no error of the model", "[calib]") {
  Twin twin = predicting_twin();
  twin.campaign.conditions[1].date = "2026-03-09";
  twin.noise_sd_m = 1e-5;
  const auto truth = twin.true_values(twin.campaign.conditions[1]);
  for (const char* key : {"valve_gain", "bulk_modulus"})
    twin.setting(key).value = truth.value[static_cast<std::size_t>(Twin::index(key))];
  const auto model_error = [&](const char* key, double value,
                               const std::vector<std::string>& dates) {
    twin.offsets["predicted"] = {Twin::index(key), value};
    const auto records = twin.records(1000, 500.0, 2);
    const Problem problem = problem_of(twin, records);
    EstimateCovariance spread;
    spread.dates = dates;
    std::vector<ConditionScore> scores = score_conditions(problem, problem.start(), 1);
    add_prediction_sd(problem, problem.start(), spread, {}, 1, scores);
    test_predictions(problem, dates, scores);
    return scores[1].channels.front().lack_of_fit.value().ratio - 1.0;
  };
  // Two of the usual standard deviations of the supply, 0.5 %.
  const double supply = 1.01 * twin.setting("supply_pressure").value;
  CHECK(model_error("supply_pressure", supply, {"2026-03-01"}) < 0.2);
  CHECK(model_error("supply_pressure", supply, {"2026-03-09"}) > 1.0);
  CHECK(model_error("supply_pressure", supply, {}) > 1.0);
  // The usual standard deviation of the zero is 0.03 mm.
  CHECK(model_error("position_offset", 0.05e-3, {"2026-03-01"}) < 0.2);
  CHECK(model_error("position_offset", 1e-3, {"2026-03-01"}) > 1.0);
}

TEST_CASE("open prediction: the variance by the estimates, and which of them", "[calib]") {
  // y = a + b t + c t, with b and c known only as b + c, and t = -1, 0, 1.
  Eigen::MatrixXd gradient(3, 3);
  gradient << 1, -1, -1, 1, 0, 0, 1, 1, 1;
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(3, 2);
  root(0, 0) = 5.0;                     // a constant moves no rho2
  root(1, 1) = 0.7, root(2, 1) = -0.3;  // together 0.4 t
  const Eigen::Vector3d measured(0.0, 3.0, 3.0);
  const OpenPrediction open = open_prediction(gradient, root, {"a", "b", "c"}, measured);
  CHECK_THAT(open.variance_fraction, WithinRel(0.16 * 2.0 / 6.0, 1e-12));
  CHECK(open.through == std::vector<std::string>{"b"});
  root(2, 1) = -0.6;
  CHECK(open_prediction(gradient, root, {"a", "b", "c"}, measured).through ==
        std::vector<std::string>{"b", "c"});
}

TEST_CASE("prediction band: none of what was not scored or could not be simulated", "[calib]") {
  const Twin twin = predicting_twin();
  const auto records = twin.records(250, 500.0, 2);
  const Problem problem = problem_of(twin, records);
  std::vector<ConditionScore> scores(2);
  scores[0].failure = "too many steps";
  scores[1].not_scored = "stopped";
  add_prediction_sd(problem, problem.start(), {}, {}, 1, scores);
  CHECK(scores[0].prediction_sd.empty());
  CHECK(scores[1].prediction_sd.empty());
}

}  // namespace rigcal::calib
