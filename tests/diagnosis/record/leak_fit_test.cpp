#include "diagnosis/record/leak_fit.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "tests/diagnosis/healthy_sine.hpp"

using namespace rigcal;
using Catch::WithinAbs;
using Catch::WithinRel;
using test::healthy_sine;
using test::HealthySine;
using test::rig_of;

TEST_CASE("fit_leak: a healthy reference takes the rig's error off a healthy record",
          "[diagnosis]") {
  const HealthySine made = healthy_sine();
  const diagnosis::RigFit rig = rig_of(made.campaign);
  const diagnosis::LeakProblem problem(made.campaign, rig);
  const auto error = [&](int reference) {
    const auto fit =
        diagnosis::fit_leak(problem.up_to(1.0), rig, problem.campaign.conditions.front(),
                            made.record, std::nullopt, reference, nullptr, nullptr);
    REQUIRE(fit.ok());
    return fit.rig_se;
  };
  // If nothing leaks, a wrong rig causes the same error with and without the leak. Without a
  // reference, 1 % of the valve gain is mistaken for a leak.
  CHECK(error(0) > 1e-3);
  CHECK(error(5) < 0.2 * error(0));
}

TEST_CASE("fit_leak: a supply that differs between repeats is part of the error", "[diagnosis]") {
  HealthySine made = healthy_sine();
  datasets::Campaign& campaign = made.campaign;
  const int supply = model::parameter_index(campaign.rig.plant, "supply_pressure");
  const int leak = model::parameter_index(campaign.rig.plant, "leakage_coefficient");
  constexpr double kTrue = 0.3;
  constexpr int kRepeats = 40;
  campaign.conditions.front().overrides = {{leak, kTrue}};
  campaign.synthetic_settings->repeats = kRepeats;
  campaign.synthetic_settings->variation[supply] = 0.02;
  const datasets::Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::Repeat> repeats;
  for (auto& each : datasets::synthetic_repeats(truth, truth.conditions.front(), nullptr, 5))
    repeats.push_back(std::move(each.record));
  const auto records = datasets::repeat_records(campaign, campaign.conditions.front(), repeats);

  /// Root mean square of (estimate - truth) / standard error.
  const auto rms_score = [&](int reference) {
    const diagnosis::RigFit rig = rig_of(campaign);
    const diagnosis::LeakProblem problem =
        diagnosis::LeakProblem(campaign, rig).up_to(1.0).corrected_by(reference, 1);
    double squares = 0.0;
    for (const datasets::Record& record : records.singles) {
      const auto fit = diagnosis::fit_leak(problem, rig, problem.campaign.conditions.front(),
                                           record, std::nullopt, 0, nullptr, nullptr);
      REQUIRE(fit.ok());
      const double score = (fit.coefficient - kTrue) / fit.white_se;
      squares += score * score;
    }
    return std::sqrt(squares / kRepeats);
  };
  CHECK(rms_score(0) > 3.0);
  for (auto& setting : campaign.parameters) {
    if (setting.index != supply) continue;
    setting.lower = setting.upper = std::numeric_limits<double>::quiet_NaN();
    datasets::differ_between_repeats(model::parameter_spec(campaign.rig.plant, supply),
                                     0.02 * setting.value, setting);
  }
  // For 40 independent scores, the 0.1 and 99.9 % quantiles of the rms are 0.68 and 1.35.
  const double score = rms_score(0);
  CHECK(score > 0.68);
  CHECK(score < 1.35);
  // A reference with one repeat adds the same variation once more, whereas the record itself partly
  // determines its supply pressure.
  CHECK(rms_score(1) < score);
}

TEST_CASE("fit_leak: noise may carry a healthy record below zero, by any number of errors",
          "[diagnosis]") {
  HealthySine made = healthy_sine();
  datasets::Campaign& campaign = made.campaign;
  constexpr int kRepeats = 100;
  campaign.synthetic_settings->repeats = kRepeats;
  const datasets::Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::Repeat> repeats;
  for (auto& each : datasets::synthetic_repeats(truth, truth.conditions.front(), nullptr, 8))
    repeats.push_back(std::move(each.record));
  const auto records = datasets::repeat_records(campaign, campaign.conditions.front(), repeats);
  const diagnosis::RigFit rig = rig_of(campaign);
  const diagnosis::LeakProblem problem(campaign, rig);
  int below = 0;
  // A search that starts near zero may end just above it.
  for (const double start : {0.0, 1e-6}) {
    diagnosis::LeakScan scan;
    scan.best_coefficient = start;
    for (const datasets::Record& record : records.singles) {
      const auto fit =
          diagnosis::fit_leak(problem.up_to(1.0), rig, problem.campaign.conditions.front(), record,
                              std::nullopt, 0, &scan, nullptr);
      INFO(fit.failure);
      REQUIRE(fit.ok());
      below += fit.coefficient < -fit.white_se ? 1 : 0;
    }
  }
  // A sixth of normal errors is below minus one standard error.
  CHECK(below > 20);
}

TEST_CASE("fit_leak: the simulation without a leak serves all records that have the same",
          "[diagnosis]") {
  HealthySine made = healthy_sine();
  datasets::Campaign& campaign = made.campaign;
  const int leak = model::parameter_index(campaign.rig.plant, "leakage_coefficient");
  campaign.conditions.front().overrides = {{leak, 0.3}};
  campaign.synthetic_settings->repeats = 3;
  const datasets::Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::Repeat> repeats;
  for (auto& each : datasets::synthetic_repeats(truth, truth.conditions.front(), nullptr, 3))
    repeats.push_back(std::move(each.record));
  const auto records = datasets::repeat_records(campaign, campaign.conditions.front(), repeats);
  const diagnosis::RigFit rig = rig_of(campaign);
  const diagnosis::LeakProblem problem = diagnosis::LeakProblem(campaign, rig).up_to(2.0);
  const datasets::Condition& condition = problem.campaign.conditions.front();
  const auto fit = [&](const datasets::Record& record, std::optional<diagnosis::LeakRuns>* runs) {
    const auto result = diagnosis::fit_leak(problem, rig, condition, record, std::nullopt, 0,
                                            nullptr, nullptr, nullptr, runs);
    REQUIRE(result.ok());
    return result;
  };
  std::optional<diagnosis::LeakRuns> runs;
  fit(records.average, &runs);
  REQUIRE(runs);
  for (const datasets::Record& single : records.singles) {
    const diagnosis::LeakFit alone = fit(single, nullptr);
    const diagnosis::LeakFit shared = fit(single, &runs);
    CHECK_THAT(shared.coefficient, WithinAbs(alone.coefficient, 0.03 * alone.white_se));
    CHECK_THAT(shared.white_se, WithinRel(alone.white_se, 0.01));
    CHECK_THAT(shared.rig_se, WithinRel(alone.rig_se, 0.01));
    CHECK_THAT(shared.parity_rms_m, WithinRel(alone.parity_rms_m, 1e-5));
  }
  // The runs of a record with another leak are no worse a start.
  std::optional<diagnosis::LeakRuns> far;
  fit(healthy_sine(0.25).record, &far);
  const diagnosis::LeakFit from_far = fit(records.average, &far);
  const diagnosis::LeakFit average = fit(records.average, nullptr);
  CHECK_THAT(from_far.coefficient, WithinAbs(average.coefficient, 0.03 * average.white_se));
  // Modified outputs reveal a reused run. It must not be reused for another drive, state, time or
  // value.
  const datasets::Record& single = records.singles.front();
  const double alone = fit(single, nullptr).parity_rms_m;
  runs->healthy.outputs.array() += 0.1;
  CHECK(fit(single, &runs).parity_rms_m > 10.0 * alone);
  std::optional<diagnosis::LeakRuns> changed = runs;
  changed->driving[datasets::Channel::supply_pressure] = {1.0};
  CHECK(fit(single, &changed).parity_rms_m == alone);
  changed = runs;
  changed->initial = model::InitialState::given;
  CHECK(fit(single, &changed).parity_rms_m == alone);
  changed = runs;
  changed->time_s.back() += 1e-3;
  CHECK(fit(single, &changed).parity_rms_m == alone);
  changed = runs;
  changed->values.set(model::parameter_index(campaign.rig.plant, "mass"), 90.0);
  CHECK(fit(single, &changed).parity_rms_m == alone);
}

TEST_CASE("RigFit: an effect and what the fit has mistaken for it go together", "[diagnosis]") {
  diagnosis::RigFit rig;
  rig.indices = {4, 1};
  rig.covariance = Eigen::Vector2d(9.0, 4.0).asDiagonal();
  calib::EstimateCovariance spread;
  spread.estimates = {{1, datasets::Scope::rig, ""},
                      {1, datasets::Scope::condition, "sine"},
                      {4, datasets::Scope::rig, ""}};
  spread.effects.keys = {"leakage_coefficient", "ki"};
  spread.effects.root = Eigen::Vector2d(0.1, 2.0).asDiagonal();
  spread.effects.moves = Eigen::MatrixXd::Zero(3, 2);
  spread.effects.moves.row(0) << 100.0, 5.0;
  spread.effects.moves.row(1) << 100.0, 100.0;
  spread.effects.moves.row(2) << 100.0, -3.0;
  const diagnosis::RigFit before = rig;
  rig.consider(spread);
  // The leak is what a diagnosis looks for, so it is not one of the effects.
  REQUIRE(rig.effects.keys == std::vector<std::string>{"ki"});
  Eigen::Matrix3d expected;
  expected << 9.0 + 36.0, -60.0, -12.0,  //
      -60.0, 4.0 + 100.0, 20.0,          //
      -12.0, 20.0, 4.0;
  CHECK((rig.covariance - expected).norm() < 1e-12);

  // The effect acts by itself and through both values: 0.5 - 3 * 0.1 + 5 * 0.2 = 1.2, times its
  // size of 2. The values alone have the variances 9 and 4.
  const Eigen::Vector3d moves(0.1, 0.2, 0.5);
  const auto lines = rig.contributions(moves);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].kind == "known_value");
  CHECK_THAT(lines[0].uncertainty, WithinRel(std::sqrt(0.01 * 9.0 + 0.04 * 4.0), 1e-9));
  CHECK(lines[1].source == "ki");
  CHECK(lines[1].kind == "effect");
  CHECK_THAT(lines[1].uncertainty, WithinRel(2.4, 1e-9));
  CHECK_THAT(std::hypot(lines[0].uncertainty, lines[1].uncertainty),
             WithinRel(rig.error(moves), 1e-12));
  CHECK(diagnosis::RigFit{}.contributions(Eigen::VectorXd::Zero(0)).empty());

  // If the diagnosed leak is laminar, a leak through an orifice is an effect like others.
  diagnosis::RigFit laminar = before;
  spread.effects.keys = {"leakage_coefficient", "laminar_leakage"};
  laminar.consider(spread, datasets::LeakLaw::laminar);
  CHECK(laminar.effects.keys == std::vector<std::string>{"leakage_coefficient"});
}

TEST_CASE("fit_leak: an effect that the model lacks moves a coefficient as far as is stated",
          "[diagnosis]") {
  constexpr double kSize = 1e-12;
  const HealthySine made = healthy_sine(0.3);
  const int laminar = model::parameter_index(made.campaign.rig.plant, "laminar_leakage");
  const HealthySine with = healthy_sine(0.3, {{laminar, kSize}});
  diagnosis::RigFit rig = rig_of(made.campaign);
  calib::EstimateCovariance spread;
  spread.effects.keys = {"laminar_leakage"};
  spread.effects.root = Eigen::MatrixXd::Constant(1, 1, kSize);
  spread.effects.moves = Eigen::MatrixXd::Zero(0, 1);
  rig.consider(spread);
  const diagnosis::LeakProblem problem = diagnosis::LeakProblem(made.campaign, rig).up_to(1.0);
  const datasets::Condition& condition = problem.campaign.conditions.front();
  const auto scan = diagnosis::leak_scan_of(problem, condition, made.record);
  diagnosis::HealthyEffects healthy;
  const auto effects =
      diagnosis::leak_effects_of(problem, rig, condition, made.record, scan, healthy);
  REQUIRE(effects != nullptr);
  const auto fit = [&](const HealthySine& of, int reference) {
    const auto found = diagnosis::fit_leak(problem, rig, condition, of.record, std::nullopt,
                                           reference, &scan, nullptr, effects.get());
    REQUIRE(found.ok());
    return found;
  };
  const auto without = fit(made, 0);
  REQUIRE(without.rig_moves.size() == 2);
  const double moved = fit(with, 0).coefficient - without.coefficient;
  CHECK_THAT(without.rig_moves(1) * kSize, WithinRel(moved, 0.1));
  CHECK(moved > 0.0);
  // A healthy reference includes the effect, too.
  CHECK(std::abs(fit(made, 5).rig_moves(1)) < 0.5 * std::abs(without.rig_moves(1)));
  // Without the error in the valve gain, only the effect is left.
  rig.covariance(0, 0) = 0.0;
  CHECK_THAT(fit(made, 0).rig_se, WithinRel(std::abs(without.rig_moves(1)) * kSize, 1e-9));
}

TEST_CASE("share_rig_moves: an effect that leaks itself changes the true share, too",
          "[diagnosis]") {
  constexpr double kSize = 1e-12;
  const HealthySine made = healthy_sine(0.3);
  const int laminar = model::parameter_index(made.campaign.rig.plant, "laminar_leakage");
  diagnosis::RigFit rig = rig_of(made.campaign);
  calib::EstimateCovariance spread;
  spread.effects.keys = {"laminar_leakage"};
  spread.effects.root = Eigen::MatrixXd::Constant(1, 1, kSize);
  spread.effects.moves = Eigen::MatrixXd::Zero(0, 1);
  rig.consider(spread);
  rig.covariance(0, 0) = 0.0;  // only the effect is uncertain
  const diagnosis::LeakProblem problem = diagnosis::LeakProblem(made.campaign, rig).up_to(1.0);
  const datasets::Condition& condition = problem.campaign.conditions.front();
  const auto scan = diagnosis::leak_scan_of(problem, condition, made.record);
  diagnosis::HealthyEffects healthy;
  const auto effects =
      diagnosis::leak_effects_of(problem, rig, condition, made.record, scan, healthy);
  REQUIRE(effects != nullptr);
  const auto fit = diagnosis::fit_leak(problem, rig, condition, made.record, std::nullopt, 0, &scan,
                                       nullptr, effects.get());
  REQUIRE(fit.ok());
  const auto share = [&](double coefficient, double leakage) {
    auto values = rig.values;
    values.push_back({laminar, datasets::Scope::rig, "", leakage});
    values.push_back({problem.leak, datasets::Scope::condition, condition.id, coefficient});
    return diagnosis::share_at(problem.campaign, condition, made.record, values);
  };
  const double slope = (share(1.01 * fit.coefficient, 0.0) - share(0.99 * fit.coefficient, 0.0)) /
                       (0.02 * fit.coefficient);
  // The estimate takes the effect for a larger leak, and the true share includes the effect.
  const double seen = slope * fit.rig_moves(1) * kSize;
  const double itself = share(fit.coefficient, kSize) - share(fit.coefficient, 0.0);
  REQUIRE(itself > 0.0);
  diagnosis::LeakMemo memo(rig.indices);
  const double error = rig.error(diagnosis::share_rig_moves(problem, rig, condition, made.record,
                                                            fit, slope, memo, 0.0, effects.get()));
  CHECK_THAT(error, WithinAbs(std::abs(seen - itself), 0.2 * itself));
}

TEST_CASE("fit_leak: the noise of the reference is not the record's own", "[diagnosis]") {
  const HealthySine made = healthy_sine();
  const diagnosis::RigFit rig = rig_of(made.campaign);
  const diagnosis::LeakProblem problem = diagnosis::LeakProblem(made.campaign, rig).up_to(1.0);
  const auto noise_se = [&](int reference) {
    return diagnosis::fit_leak(problem, rig, problem.campaign.conditions.front(), made.record,
                               std::nullopt, reference, nullptr, nullptr)
        .noise_se;
  };
  // After subtracting the mean of four, the noise of a record is sqrt(5/4) times as large.
  CHECK_THAT(noise_se(0) / noise_se(4), WithinRel(std::sqrt(1.25), 1e-9));
}

TEST_CASE("share_rig_moves: what the rig moves, with the coefficient and by itself",
          "[diagnosis]") {
  const HealthySine made = healthy_sine();
  const diagnosis::RigFit rig = rig_of(made.campaign);
  const diagnosis::LeakProblem problem(made.campaign, rig);
  const datasets::Condition& condition = problem.campaign.conditions.front();
  diagnosis::LeakFit fit;
  fit.coefficient = 0.3;
  const auto share = [&](double valve_gain) {
    auto values = rig.values;
    values.push_back({rig.indices.front(), datasets::Scope::rig, "", valve_gain});
    values.push_back({problem.leak, datasets::Scope::condition, condition.id, fit.coefficient});
    return diagnosis::share_at(problem.campaign, condition, made.record, values);
  };
  const double gain = 4.06e-5;
  // With a tenth of this step, the tolerance of the simulation is 0.2 % of the difference.
  const double step = 1e-2 * gain;
  const double itself = (share(gain + step) - share(gain - step)) / (2.0 * step);
  const double sd = 4.06e-7;
  const double share_slope = 0.5;
  fit.rig_moves = Eigen::VectorXd::Zero(1);
  diagnosis::LeakMemo memo(rig.indices);
  const auto error = [&] {
    return rig.error(
        diagnosis::share_rig_moves(problem, rig, condition, made.record, fit, share_slope, memo));
  };
  CHECK_THAT(error(), WithinRel(std::abs(itself) * sd, 1e-3));
  fit.rig_moves(0) = 3.0 * itself / share_slope;
  CHECK_THAT(error(), WithinRel(4.0 * std::abs(itself) * sd, 1e-3));
  // If nothing leaks, a share changes only through the coefficient.
  fit.coefficient = -0.1;
  CHECK_THAT(error(), WithinRel(3.0 * std::abs(itself) * sd, 1e-9));
}

TEST_CASE("leak_scan_of: the best leak is found beyond the share of the last class",
          "[diagnosis]") {
  HealthySine made = healthy_sine(1.5);
  const diagnosis::LeakProblem problem(made.campaign, rig_of(made.campaign));
  const auto& condition = problem.campaign.conditions.front();
  const auto scan = diagnosis::leak_scan_of(problem, condition, made.record);
  CHECK_THAT(scan.best_coefficient, WithinRel(1.5, 0.2));
  CHECK(scan.largest_coefficient > scan.best_coefficient);
}

TEST_CASE("leaks: whatever simulates them ends with the flag", "[diagnosis]") {
  const HealthySine made = healthy_sine(0.2);
  const diagnosis::RigFit rig = rig_of(made.campaign);
  diagnosis::LeakProblem problem(made.campaign, rig);
  const datasets::Condition& condition = problem.campaign.conditions.front();
  std::atomic<bool> flag{false};
  problem.cancel = &flag;
  diagnosis::LeakFit leak;
  leak.coefficient = 0.2;
  leak.rig_moves = Eigen::VectorXd::Zero(1);
  const auto make_all = [&](const auto& check) {
    diagnosis::LeakMemo memo;
    diagnosis::LeakMemo of_rig(rig.indices);
    check([&] { diagnosis::leak_scan_of(problem, condition, made.record); });
    check([&] { diagnosis::leak_curve_of(problem, condition, made.record, 0.2, 0.01, memo); });
    check([&] {
      diagnosis::share_rig_moves(problem, rig, condition, made.record, leak, 0.5, of_rig);
    });
    check([&] { diagnosis::healthy_residuals(problem, condition, made.record, {&made.record}); });
    check([&] {
      diagnosis::share_at(problem.campaign, condition, made.record, rig.values, problem.cancel);
    });
  };
  make_all([](const auto& make) { CHECK_NOTHROW(make()); });
  flag = true;
  make_all([](const auto& make) { CHECK_THROWS_AS(make(), NoResultError); });
}
