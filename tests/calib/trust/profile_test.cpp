#include "calib/trust/profile.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>

#include "calib/cross_validation.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/trust/bootstrap.hpp"
#include "calib/trust/interval_advice.hpp"
#include "tests/calib/twin.hpp"
#include "tests/support/sanitized.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinRel;
using datasets::Scope;
using datasets::Waveform;

/// Returns the estimates of a fit as a point in the unit box.
std::vector<double> place_of(const Problem& problem, const Fit& found) {
  std::vector<double> z;
  for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j)
    z.push_back(problem.map.to_unit(static_cast<int>(j), found.parameters[j].value));
  return z;
}

void without_errors(FittedParameter& parameter) {
  parameter.ci95_if_exact.reset();
  parameter.standard_error.reset();
  parameter.robust_standard_error.reset();
}

}  // namespace

TEST_CASE("profile: where the cost is all but quadratic it ends where the interval does",
          "[calib]") {
  const Twin twin = one_square();
  FitOptions options;
  options.profiles = true;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  for (const auto* key : {"mass", "valve_gain"}) {
    const FittedParameter& p = parameter(found, key);
    CAPTURE(key, p.reason);
    REQUIRE(p.profile.has_value());
    const auto interval = p.ci95_if_exact.value();
    // Allows 10 % for curvature, the quantile of t, and a crossing that is located to 2 %.
    CHECK_THAT(p.profile->high.value.value() - p.value, WithinRel(interval.high - p.value, 0.1));
    CHECK_THAT(p.value - p.profile->low.value.value(), WithinRel(p.value - interval.low, 0.1));
    CHECK_FALSE(p.profile->lower_cost_found);
  }
}

TEST_CASE("profile: an open one makes a parameter not identifiable", "[calib]") {
  Twin twin = one_square();
  twin.free("bulk_modulus", 700e6, 300e6, 1500e6);
  twin.campaign.conditions[0].waveform = Waveform::sine;
  twin.campaign.conditions[0].frequency_hz = 0.5;
  FitOptions options;
  options.profiles = true;
  const Fit found = fit(twin.campaign, twin.records(250, 100.0, 3), options);
  const FittedParameter& bulk = parameter(found, "bulk_modulus");
  REQUIRE(bulk.profile.has_value());
  CHECK_FALSE(bulk.profile->high.value.has_value());
  CHECK(bulk.identifiability == Identifiability::not_identifiable);
  CHECK_THAT(bulk.reason, Contains("profile is open"));
}

TEST_CASE("profile: one that was stopped, or cut off by a bound, says nothing of the parameter",
          "[calib]") {
  Twin twin = one_square();
  const auto records = twin.records(250, 500.0, 3);
  const Problem problem = problem_of(twin, records);
  Fit found = fit(twin.campaign, records, {});
  const Evaluation optimum = evaluate_at(problem, place_of(problem, found), 1);
  const std::atomic<bool> cancel{true};
  FitOptions options;
  Budget budget(&cancel);
  profiles(problem, records, optimum, options, found, budget);
  const FittedParameter& mass = parameter(found, "mass");
  REQUIRE(mass.profile.has_value());
  CHECK(mass.profile->low.is_lost());
  CHECK(mass.identifiability == Identifiability::identified);
  CHECK_THAT(mass.reason, Contains("not computed on either side: stopped on request"));

  twin.setting("mass").upper = mass.value + 0.2 * (mass.ci95_if_exact->high - mass.value);
  options.profiles = true;
  const Fit bounded = fit(twin.campaign, records, options);
  const FittedParameter& cut = parameter(bounded, "mass");
  REQUIRE(cut.profile.has_value());
  CHECK_FALSE(cut.profile->high.value);
  CHECK(cut.identifiability == Identifiability::identified);
  CHECK_THAT(cut.reason, Contains("profile is open above"));
}

TEST_CASE("profile: what a prior alone tells ends where the prior does", "[calib]") {
  // Valve gain and discharge coefficient only act as a product.
  Twin twin = one_square();
  twin.free("discharge_coefficient", 0.6, 0.1, 1.0).prior = datasets::Prior{0.6, 0.02};
  FitOptions options;
  options.profiles = true;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  const FittedParameter& p = parameter(found, "discharge_coefficient");
  CAPTURE(p.reason);
  CHECK_THAT(p.standard_error.value(), WithinRel(0.02, 0.02));
  REQUIRE(p.profile.has_value());
  // The prior gives 1.96 standard deviations; a crossing is located to 2 % of the rise.
  CHECK_THAT(p.profile->high.value.value() - p.value, WithinRel(1.96 * 0.02, 0.03));
  CHECK_THAT(p.value - p.profile->low.value.value(), WithinRel(1.96 * 0.02, 0.03));
}

TEST_CASE("profile: without an interval it ends where the cost says 95 %", "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(250, 500.0, 3);
  const Problem problem = problem_of(twin, records);
  const Fit found = fit(twin.campaign, records, {});
  Fit bare = found;
  for (FittedParameter& each : bare.parameters) without_errors(each);
  const std::vector<double> z = place_of(problem, found);
  const Evaluation optimum = evaluate_at(problem, z, 1);
  Budget budget;
  profiles(problem, records, optimum, {}, bare, budget);
  // If the model lacks something, its residuals are larger than the noise: here twice as large.
  Fit lacking = bare;
  lacking.reduced_chi_square = 4.0 * std::max(1.0, found.reduced_chi_square.value());
  profiles(problem, records, optimum, {}, lacking, budget);
  for (std::size_t j = 0; j < z.size(); ++j) {
    const double error = found.parameters[j].standard_error.value();
    const Profile& profile = bare.parameters[j].profile.value();
    CHECK_THAT(profile.high.value.value() - found.parameters[j].value,
               WithinRel(1.96 * error, 0.03));
    CHECK_THAT(found.parameters[j].value - profile.low.value.value(),
               WithinRel(1.96 * error, 0.03));
    CHECK_THAT(lacking.parameters[j].profile->high.value.value() - found.parameters[j].value,
               WithinRel(2.0 * 1.96 * error, 0.05));
  }
}

TEST_CASE("profile: an interval that is cut off below leaves the upper end where it is",
          "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(250, 500.0, 3);
  const Problem problem = problem_of(twin, records);
  Fit found = fit(twin.campaign, records, {});
  for (FittedParameter& each : found.parameters) {
    if (each.fitted) each.ci95_if_exact->low = 0.5 * (each.ci95_if_exact->low + each.value);
  }
  Budget budget;
  profiles(problem, records, evaluate_at(problem, place_of(problem, found), 1), {}, found, budget);
  for (const auto* key : {"mass", "valve_gain"}) {
    const FittedParameter& p = parameter(found, key);
    CHECK_THAT(p.profile->high.value.value() - p.value,
               WithinRel(p.ci95_if_exact->high - p.value, 0.1));
  }
}

TEST_CASE("profile: one that is open below is complete only if no value is smaller", "[calib]") {
  // The rig has no leak, so every smaller leak fits as well as the estimate.
  for (const double lower : {0.0, 1e-4}) {
    CAPTURE(lower);
    Twin twin = one_square();
    twin.free("leakage_coefficient", 0.1, lower, 2.0);
    twin.offsets["square"] = {Twin::index("leakage_coefficient"), 0.0};
    const auto records = twin.records(250, 500.0, 3);
    const Problem problem = problem_of(twin, records);
    Fit found = fit(twin.campaign, records, {});
    for (FittedParameter& each : found.parameters) {
      without_errors(each);
      each.identifiability = Identifiability::identified;
    }
    Budget budget;
    profiles(problem, records, evaluate_at(problem, place_of(problem, found), 1), {}, found,
             budget);
    const FittedParameter& leak = parameter(found, "leakage_coefficient");
    CAPTURE(leak.value, leak.reason);
    CHECK_FALSE(leak.profile->low.value.has_value());
    CHECK(leak.profile->high.value.has_value());
    CHECK(leak.identifiability ==
          (lower > 0.0 ? Identifiability::not_identifiable : Identifiability::identified));
  }
}

TEST_CASE("profile: a lower cost than that of the fit is told", "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(250, 500.0, 3);
  const Problem problem = problem_of(twin, records);
  Fit found = fit(twin.campaign, records, {});
  for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j) {
    FittedParameter& each = found.parameters[j];
    each.value += 5.0 * each.standard_error.value();
    each.ci95_if_exact->low += 5.0 * each.standard_error.value();
    each.ci95_if_exact->high += 5.0 * each.standard_error.value();
  }
  Budget budget;
  profiles(problem, records, evaluate_at(problem, place_of(problem, found), 1), {}, found, budget);
  for (const auto* key : {"mass", "valve_gain"}) {
    CHECK(parameter(found, key).profile->lower_cost_found);
    CHECK_THAT(parameter(found, key).reason, Contains("its profile finds a lower cost"));
  }
}

TEST_CASE("profile: the error of simulations is no lower minimum", "[calib]") {
  // In a direction that the records do not determine, the cost is flat up to simulation errors.
  Twin twin = one_square();
  twin.free("discharge_coefficient", 0.6, 0.1, 1.0);
  FitOptions options;
  options.profiles = true;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  const FittedParameter& p = parameter(found, "discharge_coefficient");
  CAPTURE(p.reason);
  REQUIRE(p.profile.has_value());
  CHECK_FALSE(p.profile->lower_cost_found);
  CHECK_THAT(p.reason, Contains("profile is open above"));
  CHECK_THAT(found.interval_advice, Contains("not identifiable, so no interval is reliable: ") &&
                                        Contains("discharge_coefficient") && !Contains("mass_kg"));
}

TEST_CASE("intervals: which of them to use", "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(250, 500.0, 3);
  const Problem problem =
      make_problem(twin.campaign, records, {&twin.campaign.conditions[0]}, false, nullptr);
  std::vector<FittedParameter> parameters(2);
  for (FittedParameter& each : parameters) {
    each.value = 85.0;
    each.ci95_if_exact = {84.9999, 85.0001};
  }
  CHECK(compare_intervals(problem, parameters).empty());
  BootstrapSpread drawn{3e-5, 0.0, 9.0, Range{84.9999, 85.0001}};
  parameters[0].bootstrap = drawn;
  CHECK(compare_intervals(problem, parameters) == "the bootstrap agrees with `ci95_if_exact`");
  CHECK_THAT(compare_intervals(problem, parameters, {"supply_pressure_pa"}),
             Contains("the bootstrap leaves out the uncertainty of supply_pressure_pa"));
  drawn.ci95 = {84.99994, 85.00006};  // a ratio of 0.6 can be chance with nine degrees
  parameters[0].bootstrap = drawn;
  CHECK(compare_intervals(problem, parameters) == "the bootstrap agrees with `ci95_if_exact`");
  drawn.ci95 = {84.99996, 85.00004};
  parameters[0].bootstrap = drawn;
  CHECK_THAT(compare_intervals(problem, parameters),
             Contains("0.4 times as wide") && !Contains("lacks"));
  CHECK_THAT(compare_intervals(problem, parameters, {}, true),
             Contains("which includes model error"));
  drawn.ci95 = {84.99995, 85.00015};
  parameters[0].bootstrap = drawn;
  CHECK_THAT(compare_intervals(problem, parameters),
             Contains("84.99995 to 85.00015 kg: it is skewed"));
  drawn.ci95 = {84.9998, 85.0002};
  parameters[0].bootstrap = drawn;
  CHECK_THAT(compare_intervals(problem, parameters), Contains("2 times as wide"));
  parameters[0].profile = Profile{};
  parameters[0].profile->low.value = 84.99999;
  parameters[0].profile->high.value = 85.0001;
  CHECK_THAT(compare_intervals(problem, parameters),
             Contains("use the interval of the profile, 84.99999 to 85.0001 kg:"));
  parameters[0].identifiability = Identifiability::not_identifiable;
  CHECK(compare_intervals(problem, parameters) ==
        "not identifiable, so no interval is reliable: " + problem.name(0));
}

TEST_CASE("bootstrap: its spread is that of the noise, the same for any number of threads",
          "[calib]") {
  const Twin twin = one_square();
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options;
  options.bootstrap = test::kSanitized ? 40 : 100;
  const Fit found = fit(twin.campaign, records, options);
  options.threads = 3;
  const Fit again = fit(twin.campaign, records, options);
  CHECK(found.bootstrap.value().replicates == options.bootstrap);
  for (const auto* key : {"mass", "valve_gain"}) {
    const FittedParameter& p = parameter(found, key);
    REQUIRE(p.bootstrap.has_value());
    // The standard deviation of 100 draws is known to 7 %; the limit is four times that.
    CHECK_THAT(p.bootstrap->standard_error, WithinRel(p.robust_standard_error.value(), 0.3));
    CHECK(std::abs(p.bootstrap->bias) < 0.5 * p.bootstrap->standard_error);
    CHECK(p.bootstrap->ci95->low < p.value);
    CHECK(p.bootstrap->ci95->high > p.value);
    CHECK(p.bootstrap->standard_error == parameter(again, key).bootstrap->standard_error);
  }
}

TEST_CASE("bootstrap: blocks grow with the memory of the noise", "[calib]") {
  CHECK(block_length({{}, 1.0}, 1000) == 1);
  const std::size_t slow = block_length({{0.95}, 1.0}, 1000);
  CHECK(slow > block_length({{0.5}, 1.0}, 1000));
  CHECK(slow < 200);
  CHECK(block_length({{0.99}, 1.0}, 5) <= 5);
}

TEST_CASE("fit: records that contradict a prior are told of", "[calib]") {
  Twin twin = one_square();
  twin.setting("mass").prior = datasets::Prior{60.0, 1.0};
  twin.setting("damping").prior = datasets::Prior{2.0 * twin.setting("damping").value, 10.0};
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), {});
  const auto told = [&](const char* first, const char* second) {
    return std::any_of(found.warnings.begin(), found.warnings.end(), [&](const std::string& each) {
      return each.find(first) == 0 && each.find(second) != std::string::npos;
    });
  };
  CHECK(told("mass_kg: records and prior disagree", "of its prior from 60 kg"));
  CHECK(told("damping: known, and taken to be", "standard deviations of its prior"));
  twin.setting("mass").prior = datasets::Prior{85.0, 5.0};
  twin.setting("damping").prior.reset();
  const Fit agreed = fit(twin.campaign, twin.records(250, 500.0, 3), {});
  for (const std::string& each : agreed.warnings) CHECK_THAT(each, !Contains("prior"));
}

TEST_CASE("cross-validation: of one condition there is none", "[calib]") {
  Twin twin = one_square();
  REQUIRE(twin.campaign.conditions.size() == 1);
  FitOptions options;
  options.cross_validate = true;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  REQUIRE(found.cross_validation->size() == 1);
  CHECK_THAT(found.cross_validation->at(0).problem.value(), Contains("only condition"));
}

TEST_CASE("cross-validation: each condition is predicted from the others", "[calib]") {
  Twin twin = one_square();
  twin.add("sine", Waveform::sine, 3.0, 0.01);
  twin.add("leaking", Waveform::square, 1.0, 0.01, "leak");
  twin.level_leakage = {{"leak", 0.5}};
  twin.campaign.leak_levels["none"] = {{Twin::index("leakage_coefficient"), 0.35}};
  for (std::size_t i : {0U, 1U}) twin.campaign.conditions[i].leak_level = "none";
  twin.free("leakage_coefficient", 0.3, 0.05, 2.0, Scope::leak_level);
  FitOptions options;
  options.cross_validate = true;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  REQUIRE(found.cross_validation->size() == 3);
  for (std::size_t i : {0U, 1U}) {
    const HeldOut& held = found.cross_validation->at(i);
    CAPTURE(held.condition, held.problem);
    REQUIRE(held.rmse.size() == 1);
    // Two parameters compared with 250 samples: the noise dominates, not the condition that was
    // left out.
    CHECK_THAT(held.rmse[0].second, WithinRel(held.fitted_rmse[0].second, 0.1));
    CHECK(std::abs(held.largest_shift.value()) < 5.0);
  }
  CHECK_THAT(found.cross_validation->at(2).problem.value(), Contains("leak"));
  CHECK_THAT(found.interval_advice, Contains("2 of 3 conditions predicted from the others"));
}

}  // namespace rigcal::calib
