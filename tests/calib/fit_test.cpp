#include "calib/fit.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "common/error.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Scope;
using datasets::Waveform;

/// Three signals, two leak levels, three unknowns of the rig, and the leakage of each level.
Twin six_conditions() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.free("leakage_coefficient", 0.2, 0.0, 5.0, Scope::leak_level);
  twin.level_leakage = {{"small", 0.1}, {"large", 0.6}};
  for (const std::string level : {"small", "large"}) {
    twin.add("sine1_" + level, Waveform::sine, 1.0, 0.02, level);
    twin.add("sine5_" + level, Waveform::sine, 5.0, 0.01, level);
    twin.add("square_" + level, Waveform::square, 2.0, 0.01, level);
  }
  return twin;
}

/// One short condition with mass and valve gain unknown, which is quick to fit.
Twin small_twin() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("square", Waveform::square, 2.0, 0.01);
  return twin;
}

double errors_off(const Fit& fit, std::string_view key, double truth,
                  const std::string& level = {}) {
  const FittedParameter& found = parameter(fit, key, level);
  return std::abs(found.value - truth) / found.standard_error.value();
}

bool mentions(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("fit: recovers the truth from noisy positions", "[calib]") {
  const Twin twin = six_conditions();
  const Fit found = fit(twin.campaign, twin.records(1500, 1000.0, 7), {});
  REQUIRE(found.status == FitStatus::converged);
  CHECK(found.usable());
  // At 3.5 standard errors there is a false alarm once in two thousand draws.
  CHECK(errors_off(found, "mass", 85.0) < 3.5);
  CHECK(errors_off(found, "valve_gain", 0.0406e-3) < 3.5);
  CHECK(errors_off(found, "leakage_coefficient", 0.1, "small") < 3.5);
  CHECK(errors_off(found, "leakage_coefficient", 0.6, "large") < 3.5);
  CHECK(found.rank == 4);
  CHECK(found.correlation.matrix.rows() == 4);
  // With 9000 residuals the standard deviation of chi-square is 1.5 %; the limit is five times
  // that.
  CHECK_THAT(found.reduced_chi_square.value(), WithinAbs(1.0, 0.075));
  CHECK(found.conditions.size() == 6);
  CHECK(found.conditions.front().channels.at(0).metrics.rho2 > 0.999);
  for (const ConditionScore& score : found.conditions) {
    const datasets::Condition& stated = *twin.campaign.find(score.id);
    CHECK(score.waveform.value() == stated.waveform);
    CHECK(score.frequency_hz.value() == stated.frequency_hz.value());
    CHECK(score.amplitude_m.value() == stated.amplitude.value());
    CHECK(score.leak_level.value() == stated.leak_level.value());
    CHECK(score.windows_s.value().empty());  // the whole record
  }
  CHECK(found.failure_count == 0);
}

TEST_CASE("fit: the same bits for any number of threads", "[calib]") {
  const Twin twin = six_conditions();
  const auto records = twin.records(300, 1000.0, 7);
  std::vector<Fit> fits;
  for (const int threads : {1, 2, 3}) {
    FitOptions options;
    options.threads = threads;
    options.starts = 2;
    fits.push_back(fit(twin.campaign, records, options));
  }
  for (const Fit& other : fits) {
    CHECK(std::memcmp(&other.cost, &fits[0].cost, sizeof(double)) == 0);
    REQUIRE(other.parameters.size() == fits[0].parameters.size());
    for (std::size_t j = 0; j < other.parameters.size(); ++j) {
      CHECK(other.parameters[j].value == fits[0].parameters[j].value);
      CHECK(other.parameters[j].standard_error == fits[0].parameters[j].standard_error);
      CHECK(other.parameters[j].robust_standard_error ==
            fits[0].parameters[j].robust_standard_error);
    }
    for (std::size_t s = 0; s < other.starts.size(); ++s)
      CHECK(other.starts[s].end_values == fits[0].starts[s].end_values);
  }
}

TEST_CASE("fit: intervals cover the truth as often as they say", "[calib]") {
  const Twin twin = small_twin();
  int covered = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Fit found = fit(twin.campaign, twin.records(250, 500.0, seed), {});
    CAPTURE(seed, found.message);
    REQUIRE(found.status == FitStatus::converged);
    for (const auto& [key, truth] : {std::pair{"mass", 85.0}, std::pair{"valve_gain", 0.0406e-3}}) {
      const auto interval = parameter(found, key).ci95_if_exact.value();
      covered += interval.low <= truth && truth <= interval.high ? 1 : 0;
    }
  }
  // Binomial(40, 0.95): fewer than 33 occurs about once in a thousand.
  CHECK(covered >= 33);
}

TEST_CASE("fit: a prior pulls as its standard deviation says", "[calib]") {
  Twin twin = small_twin();
  const auto records = twin.records(250, 500.0, 3);
  const Fit free = fit(twin.campaign, records, {});
  const FittedParameter alone = parameter(free, "mass");
  const double se = alone.standard_error.value();
  // A prior with the same uncertainty as the data moves the estimate halfway. The other unknowns
  // adapt, so the marginal error applies, and the model is linear over one standard error.
  twin.setting("mass").prior = datasets::Prior{alone.value + 2.0 * se, se};
  const Fit pulled = fit(twin.campaign, records, {});
  REQUIRE(pulled.status == FitStatus::converged);
  // Allows 15 % for curvature over one standard error, a chi-square other than 1, and an optimum
  // located to a hundredth of a standard error.
  CHECK_THAT(parameter(pulled, "mass").value - alone.value, WithinRel(se, 0.15));
  CHECK_THAT(parameter(pulled, "mass").standard_error.value(), WithinRel(se / std::sqrt(2.0), 0.1));
  CHECK(pulled.residual_count == free.residual_count + 1);
}

TEST_CASE("fit: an optimum outside the box is named", "[calib]") {
  Twin twin = small_twin();
  twin.free("mass", 40.0, 20.0, 60.0);
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
  const FittedParameter& mass = parameter(found, "mass");
  CHECK(found.status == FitStatus::converged);  // a constrained optimum
  CHECK(mass.at_bound);
  CHECK_THAT(mass.value, WithinRel(60.0, 1e-6));
  CHECK_THAT(mass.reason, Contains("upper bound") && Contains("the fit would improve beyond it"));
  CHECK_THAT(found.message, Contains("mass_kg"));
  CHECK(mentions(found.warnings, "mass_kg"));
}

TEST_CASE("fit: leakage at zero has a one-sided interval", "[calib]") {
  Twin twin = small_twin();
  twin.level_leakage = {{"none", 0.0}};
  twin.campaign.conditions[0].leak_level = "none";
  twin.free("leakage_coefficient", 0.2, 0.0, 5.0, Scope::leak_level);
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
  REQUIRE(found.status == FitStatus::converged);
  const FittedParameter& leakage = parameter(found, "leakage_coefficient", "none");
  CHECK(leakage.ci95.value().low == 0.0);
  CHECK(leakage.ci95.value().high > 0.0);
  CHECK(leakage.identifiability == Identifiability::bounded);
  CHECK_THAT(leakage.reason, Contains("not significantly different from zero"));
}

TEST_CASE("fit: a lag starts at zero, and is believed there", "[calib]") {
  for (const char* key : {"valve_time_constant", "position_lag"}) {
    Twin twin = small_twin();
    twin.free(key, 0.0, 0.0, 10.0);  // the bounds of a campaign that gives none
    const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
    CAPTURE(key, found.message);
    REQUIRE(found.status == FitStatus::converged);
    const FittedParameter& lag = parameter(found, key);
    CAPTURE(lag.value, lag.reason, lag.ci95.value().low, lag.ci95.value().high);
    CHECK(lag.identifiability == Identifiability::bounded);
    CHECK(lag.ci95->low == 0.0);
    CHECK(lag.ci95->high > 0.0);
    CHECK(lag.ci95_if_exact.value().high < 1e-3);
    CHECK_THAT(lag.reason, Contains("not significantly different from zero: at most"));
    CHECK(errors_off(found, "mass", 85.0) < 3.5);
    CHECK(errors_off(found, "valve_gain", 0.0406e-3) < 3.5);
  }
}

TEST_CASE("fit: a lag of a millisecond is found from zero", "[calib]") {
  for (const char* key : {"valve_time_constant", "position_lag"}) {
    Twin twin = small_twin();
    twin.free(key, 0.0, 0.0, 10.0);
    twin.truth.parameters.push_back(known(Twin::index(key), 1e-3));
    const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
    CAPTURE(key, found.message);
    REQUIRE(found.status == FitStatus::converged);
    const FittedParameter& lag = parameter(found, key);
    CAPTURE(lag.value, lag.reason);
    const auto interval = lag.ci95_if_exact.value();
    CHECK(interval.low > 0.0);
    CHECK(std::abs(lag.value - 1e-3) < 1.75 * 0.5 * (interval.high - interval.low));  // 3.5 errors
    CHECK(errors_off(found, "mass", 85.0) < 3.5);
    CHECK(errors_off(found, "valve_gain", 0.0406e-3) < 3.5);
  }
}

TEST_CASE("fit: where the only start finds no minimum others are tried", "[calib]") {
  Twin twin = small_twin();
  twin.noise_sd_m = 1e-7;
  twin.campaign.simulation.tolerance = 1e-2;  // errors far above the noise: no point is a minimum
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options;
  const Fit alone = fit(twin.campaign, records, options);
  REQUIRE(alone.status == FitStatus::failed);
  REQUIRE(alone.starts.size() == 1);
  options.further_starts = 2;
  const Fit found = fit(twin.campaign, records, options);
  CHECK(found.status == FitStatus::failed);
  CHECK(mentions(found.warnings,
                 "did not reach a minimum (" + alone.message + "): 2 further starts"));
  CHECK(found.evaluations > alone.evaluations);
  // Compares with the corresponding multi-start.
  options.starts = 3;
  const Fit several = fit(twin.campaign, records, options);
  REQUIRE(found.starts.size() == several.starts.size());
  CHECK(found.best_start == several.best_start);
  for (std::size_t i = 0; i < found.starts.size(); ++i) {
    CHECK(found.starts[i].start_values == several.starts[i].start_values);
    CHECK(found.starts[i].final_cost == several.starts[i].final_cost);
  }
  CHECK_FALSE(mentions(several.warnings, "further starts"));
}

TEST_CASE("fit: a start that cannot be simulated fails in words", "[calib]") {
  Twin twin = small_twin();
  twin.campaign.simulation.max_seconds = 1e-9;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
  CHECK(found.status == FitStatus::failed);
  CHECK_FALSE(found.usable());
  CHECK_THAT(found.message,
             Contains("\"square\"") && Contains("mass_kg = 60") && Contains("out of time"));
  CHECK(found.failure_count >= 1);
  CHECK(found.failures.at(0).condition == "square");
}

TEST_CASE("fit: a parameter without effect is named, not guessed", "[calib]") {
  Twin twin = small_twin();
  twin.setting("leakage_area").value = 0.0;
  twin.truth.parameters = twin.campaign.parameters;
  twin.setting("mass").value = 60.0;
  twin.free("leakage_coefficient", 0.3, 0.0, 5.0);
  for (auto& each : twin.truth.parameters) {
    if (each.index == Twin::index("mass")) each.value = 85.0;
  }
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
  const FittedParameter& leakage = parameter(found, "leakage_coefficient");
  CHECK_FALSE(leakage.standard_error.has_value());
  CHECK(leakage.identifiability == Identifiability::not_identifiable);
  CHECK_THAT(leakage.reason, Contains("responds to leakage_coefficient"));
  CHECK(parameter(found, "mass").standard_error.has_value());
  CHECK(found.rank == 2);
}

TEST_CASE("fit: the exact scaling symmetry is found as a rank deficiency", "[calib]") {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("damping", 900.0, 100.0, 5000.0);
  twin.free("stiffness", 1.5e4, 1e3, 1e5);
  twin.free("bulk_modulus", 8e8, 1e8, 2e9);
  twin.free("supply_pressure", 5e6, 1e6, 2e7);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.setting("leakage_coefficient").value = 0.0;  // its smoothing alone would break the symmetry
  twin.truth.parameters[11].value = 0.0;
  REQUIRE(twin.truth.parameters[11].index == Twin::index("leakage_coefficient"));
  twin.add("square", Waveform::square, 2.0, 0.01);
  twin.add("sine", Waveform::sine, 5.0, 0.01);
  const Fit found = fit(twin.campaign, twin.records(500, 500.0, 3), {});
  CHECK(found.rank == 5);
  for (const auto* key :
       {"mass", "damping", "stiffness", "bulk_modulus", "supply_pressure", "valve_gain"}) {
    CAPTURE(key);
    CHECK_FALSE(parameter(found, key).standard_error.has_value());
    CHECK_THAT(parameter(found, key).reason, Contains("combination"));
  }
  CHECK(found.correlation.matrix.size() == 0);
}

TEST_CASE("fit: limits and signals stop it with the best so far", "[calib]") {
  const Twin twin = small_twin();
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options;
  SECTION("iterations") {
    options.max_iterations = 1;
    const Fit found = fit(twin.campaign, records, options);
    CHECK(found.status == FitStatus::stopped);
    CHECK_THAT(found.message, Contains("1 iterations"));
    CHECK(found.cost < found.starts.at(0).initial_cost);
  }
  SECTION("a signal before it begins") {
    const std::atomic<bool> cancel{true};
    options.cancel = &cancel;
    const Fit found = fit(twin.campaign, records, options);
    CHECK(found.status == FitStatus::stopped);
    CHECK_THAT(found.message, Contains("on request"));
  }
  SECTION("a signal on the way") {
    std::atomic<bool> cancel{false};
    options.cancel = &cancel;
    options.progress = [&](int, int iteration, double, double, double) {
      if (iteration == 1) cancel = true;
    };
    const Fit found = fit(twin.campaign, records, options);
    CHECK(found.status == FitStatus::stopped);
    CHECK(found.cost < found.starts.at(0).initial_cost);
    // The user is waiting for the end, so robust errors are not computed at a point that is not a
    // minimum.
    CHECK_THAT(found.interval_advice, Contains("no interval is reliable"));
    CHECK(std::none_of(found.parameters.begin(), found.parameters.end(),
                       [](const auto& each) { return each.robust_standard_error.has_value(); }));
    CHECK(parameter(found, "mass").standard_error.has_value());
  }
  SECTION("a signal after the search") {
    std::atomic<bool> cancel{false};
    options.cancel = &cancel;
    const Fit whole = fit(twin.campaign, records, options);
    REQUIRE(whole.status == FitStatus::converged);
    const int last = whole.starts.at(0).iterations;
    options.progress = [&](int, int iteration, double, double, double) {
      if (iteration >= last) cancel = true;
    };
    const Fit found = fit(twin.campaign, records, options);
    CAPTURE(last, found.message);
    REQUIRE(found.status == FitStatus::converged);
    for (const auto& each : found.parameters)
      CHECK((!each.fitted || each.robust_standard_error.has_value()));
  }
  SECTION("an exception of the observer reaches the caller, not Ceres") {
    options.progress = [](int, int, double, double, double) { throw std::runtime_error("seen"); };
    CHECK_THROWS_WITH(fit(twin.campaign, records, options), Contains("seen"));
  }
}

TEST_CASE("fit: a robust loss resists outliers", "[calib]") {
  Twin twin = small_twin();
  auto records = twin.records(250, 500.0, 3);
  auto& position = records[0].channels[datasets::Channel::position].mean;
  for (std::size_t i = 40; i < 60; ++i) position[i] += 2e-3;  // 40 standard deviations
  const double squared = parameter(fit(twin.campaign, records, {}), "valve_gain").value;
  for (const auto loss : {datasets::Loss::huber, datasets::Loss::soft_l1, datasets::Loss::cauchy}) {
    twin.campaign.fit.loss = loss;
    const Fit found = fit(twin.campaign, records, {});
    CAPTURE(found.message);
    CHECK(found.status == FitStatus::converged);
    CHECK(std::abs(parameter(found, "valve_gain").value - 0.0406e-3) <
          0.3 * std::abs(squared - 0.0406e-3));
  }
}

TEST_CASE("fit: unknown noise is estimated and said so", "[calib]") {
  const Twin twin = small_twin();
  const auto records = twin.records(500, 500.0, 3, model::InitialState::rest, false);
  const Fit found = fit(twin.campaign, records, {});
  REQUIRE(found.status == FitStatus::converged);
  CHECK(mentions(found.warnings, "estimated from the residual"));
  CHECK(errors_off(found, "mass", 85.0) < 3.5);
  CHECK_THAT(found.reduced_chi_square.value(), WithinAbs(1.0, 0.05));  // by construction, to 1 %
  const Fit told = fit(twin.campaign, twin.records(500, 500.0, 3), {});
  // The sd of 500 samples is known to 3 %; the limit is four times that.
  CHECK_THAT(parameter(found, "mass").standard_error.value(),
             WithinRel(parameter(told, "mass").standard_error.value(), 0.13));
}

TEST_CASE("fit: records without noise converge to the truth", "[calib]") {
  Twin twin = small_twin();
  twin.noise_sd_m = 0.0;
  const auto records = twin.records(64, 128.0, 3, model::InitialState::rest, false);
  double tolerance = 0.1e-6 / std::sqrt(64.0);  // tolerance for a noise of 1e-6
  SECTION("the tolerance follows the noise") {}
  SECTION("the campaign fixes the tolerance") {
    tolerance = 1e-6;
    twin.campaign.simulation.tolerance = tolerance;
  }
  for (const double mass_kg : {45.0, 170.0}) {
    for (const double valve_gain : {0.02e-3, 0.08e-3}) {
      CAPTURE(tolerance, mass_kg, valve_gain);
      twin.setting("mass").value = mass_kg;
      twin.setting("valve_gain").value = valve_gain;
      const Fit found = fit(twin.campaign, records, {});
      CAPTURE(found.message);
      CHECK(found.status == FitStatus::converged);
      CHECK_THAT(found.tolerance, WithinRel(tolerance, 1e-12));
      CHECK(mentions(found.warnings, "resolve"));
      // A simulation error of the order of the tolerance moves the mass by a multiple of it.
      CHECK_THAT(parameter(found, "mass").value, WithinRel(85.0, 1e3 * tolerance));
      CHECK_THAT(parameter(found, "valve_gain").value, WithinRel(0.0406e-3, 1e2 * tolerance));
    }
  }
}

TEST_CASE("fit: with starts that were never made it is stopped, not converged", "[calib]") {
  const Twin twin = small_twin();
  std::atomic<bool> cancel{false};
  FitOptions options;
  options.starts = 3;
  options.cancel = &cancel;
  options.progress = [&](int start, int, double, double, double) {
    if (start == 2) cancel = true;
  };
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  REQUIRE(found.starts.size() == 2);
  CHECK(found.starts[0].status == FitStatus::converged);
  CHECK(found.status == FitStatus::stopped);
  CHECK_FALSE(found.usable());
  CHECK_THAT(found.message, Contains("2 of 3 starts"));
}

TEST_CASE("fit: an initial state is recovered", "[calib]") {
  Twin twin = small_twin();
  twin.campaign.initial = datasets::InitialMode::fit;
  datasets::ParameterSetting position;
  position.index = Twin::index("initial_position");
  position.value = 4e-3;
  twin.truth.parameters.push_back(position);
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3, model::InitialState::given), {});
  REQUIRE(found.status == FitStatus::converged);
  const FittedParameter& start = parameter(found, "initial_position", "square");
  CHECK(start.nuisance);
  CHECK(std::abs(start.value - 4e-3) < 3.5 * start.standard_error.value());
}

TEST_CASE("fit: starts are a table, the best of them counts", "[calib]") {
  const Twin twin = small_twin();
  FitOptions options;
  options.starts = 4;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  REQUIRE(found.starts.size() == 4);
  CHECK_THAT(found.starts[0].start_values.at(0), WithinRel(60.0, 1e-12));
  const double best = found.starts.at(static_cast<std::size_t>(found.best_start) - 1).final_cost;
  for (const StartReport& start : found.starts) {
    if (start.status == FitStatus::converged) CHECK(best <= start.final_cost);
  }
  CHECK(found.cost == best);
  CHECK(found.status == FitStatus::converged);
}

TEST_CASE("fit: of several starts the lowest cost goes on where it has not converged", "[calib]") {
  const Twin twin = small_twin();
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options;
  options.max_iterations = 3;
  const Fit alone = fit(twin.campaign, records, options);
  REQUIRE(alone.status == FitStatus::stopped);
  options.starts = 2;
  const Fit found = fit(twin.campaign, records, options);
  CAPTURE(found.message, alone.cost, found.cost);
  const StartReport& best = found.starts.at(static_cast<std::size_t>(found.best_start) - 1);
  CHECK(best.iterations > options.max_iterations);
  CHECK(best.final_cost == found.cost);
  CHECK(found.cost < alone.cost);
}

TEST_CASE("fit: what is missing is told before anything is computed", "[calib]") {
  Twin twin = small_twin();
  auto records = twin.records(50, 500.0, 3);
  SECTION("no fit condition") {
    twin.campaign.conditions[0].use = datasets::Use::validate;
    CHECK_THROWS_WITH(fit(twin.campaign, records, {}), Contains("use = \"fit\""));
  }
  SECTION("nothing free") {
    for (auto& each : twin.campaign.parameters) each.fit = false;
    CHECK_THROWS_WITH(fit(twin.campaign, records, {}), Contains("no parameter is free"));
  }
  SECTION("no record") {
    CHECK_THROWS_WITH(fit(twin.campaign, {}, {}), Contains("\"square\" has no record"));
  }
  SECTION("bad options") {
    FitOptions options;
    options.threads = 0;
    CHECK_THROWS_AS(fit(twin.campaign, records, options), std::invalid_argument);
  }
}

}  // namespace rigcal::calib
