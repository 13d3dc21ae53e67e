#include "diagnosis/machine/between_days.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "diagnosis/machine/leak_trend.hpp"
#include "diagnosis/machine/machine_state.hpp"
#include "tests/diagnosis/healthy_sine.hpp"

using namespace rigcal;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using diagnosis::BetweenDays;
using diagnosis::DaySource;

namespace {

datasets::Condition dated(const std::string& date, datasets::Use use = datasets::Use::diagnose) {
  datasets::Condition condition;
  condition.id = "of_" + date;
  condition.leak_level = "seal";
  if (!date.empty()) condition.date = date;
  condition.use = use;
  return condition;
}

BetweenDays days(const std::vector<std::string>& names) {
  BetweenDays between;
  between.days = names;
  between.quantities = {{"supply_pressure", "supply", "Pa", 31e3, "0.5 % of the supply", 0}};
  return between;
}

/// Coefficients of four dates, a week apart. Each has an error of 0.01, and each day shifts it by
/// `day_effect` per standard deviation, as does the reference's day.
std::vector<diagnosis::MachineState> four_weeks(double day_effect,
                                                const std::function<double(int)>& coefficient) {
  std::vector<diagnosis::MachineState> states;
  for (int i = 0; i < 4; ++i) {
    diagnosis::MachineState& state = states.emplace_back();
    state.key = diagnosis::StateKey{"seal", {}, "2026-01-" + std::to_string(10 + 7 * i)};
    state.members.emplace_back();
    state.pooled.coefficient = coefficient(i);
    state.pooled.error.own_se = 0.01;
    state.pooled.error.freedom = 1e6;
    state.pooled.rig_moves = Eigen::VectorXd::Zero(0);
    state.pooled.day_moves = Eigen::VectorXd::Zero(5);
    state.pooled.day_moves(0) = -day_effect;
    state.pooled.day_moves(1 + i) = day_effect;
    state.share_slope = 0.2;
  }
  return states;
}

diagnosis::LeakTrend only_trend(const std::vector<diagnosis::MachineState>& states,
                                const diagnosis::DayVariance& variance) {
  const auto trends = diagnosis::leak_trends(states, Eigen::MatrixXd::Zero(0, 0), {}, variance);
  REQUIRE(trends.size() == 1);
  return trends.front();
}

}  // namespace

TEST_CASE("day_weights: the record's own day less those of its reference", "[diagnosis]") {
  const datasets::Campaign campaign;
  const BetweenDays between = days({"the day of the fit", "2026-01-01", "2026-01-02"});
  const auto first = dated("2026-01-01");
  const auto second = dated("2026-01-02");
  CHECK(day_weights(between, campaign, first, {&first, &first}).norm() == 0.0);
  const auto other = day_weights(between, campaign, second, {&first, &first});
  CHECK_THAT(other.norm(), WithinRel(std::sqrt(2.0), 1e-12));
  CHECK_THAT(other.norm_of_another_day(), WithinRel(std::sqrt(2.0), 1e-12));
  // Half of the reference is from the record's own day, which gives 1 - 1/2 and -1/2.
  const auto mixed = day_weights(between, campaign, second, {&first, &second});
  CHECK_THAT(mixed.norm(), WithinRel(std::sqrt(0.5), 1e-12));
  CHECK_THAT(mixed.norm_of_another_day(), WithinRel(std::sqrt(1.5), 1e-12));
  // Without a reference, the fit takes its place. It may have used records that the campaign does
  // not have.
  CHECK_THAT(day_weights(between, campaign, first, {}).norm(), WithinRel(std::sqrt(2.0), 1e-12));
}

TEST_CASE("day_label: only a date says that two records are of one day", "[diagnosis]") {
  CHECK(diagnosis::day_label(dated("2026-01-01")) == "2026-01-01");
  CHECK(diagnosis::day_label(dated("", datasets::Use::fit)) == "the day of the fit");
  CHECK_THAT(diagnosis::day_label(dated("")), Contains("seal"));
}

TEST_CASE("estimate_days: healthy records of four dates tell how days differ", "[diagnosis]") {
  // The squares are 5 and 10, of which 1 is the record's own error. The usual sizes would cause 2
  // each, so the factor is (4 + 9) / (2 + 2).
  const std::vector<diagnosis::HealthyDay> healthy{{std::sqrt(5.0), 1.0, 2.0},
                                                   {-std::sqrt(10.0), 1.0, 2.0}};
  BetweenDays between = days({});
  between.healthy_dates = 4;
  diagnosis::estimate_days(healthy, between);
  CHECK(between.source == DaySource::estimated);
  CHECK_THAT(between.variance, WithinRel(13.0 / 4.0, 1e-12));
  CHECK_THAT(between.factor, WithinRel(std::sqrt(13.0 / 4.0), 1e-12));
  CHECK(between.freedom == 3.0);
  CHECK_THAT(between.quantities[0].sd, WithinRel(31e3 * between.factor, 1e-12));

  BetweenDays few = days({});
  few.healthy_dates = 3;
  diagnosis::estimate_days(healthy, few);
  CHECK(few.source == DaySource::usual);
  CHECK(few.variance == 1.0);
  CHECK(few.degrees_of_freedom() == metrics::kManyDegrees);
  BetweenDays stated = days({});
  stated.healthy_dates = 9;
  stated.source = DaySource::stated;
  diagnosis::estimate_days(healthy, stated);
  CHECK(stated.variance == 1.0);
  // What the days cause in another record grows with the root of the estimate.
  CHECK_THAT(between.error(2.0, Eigen::Vector2d(3.0, 4.0)),
             WithinRel(2.0 * 5.0 * std::sqrt(13.0 / 4.0), 1e-12));
  // The records vary by no more than their own errors.
  BetweenDays alike = days({});
  alike.healthy_dates = 5;
  diagnosis::estimate_days({{0.1, 1.0, 2.0}}, alike);
  CHECK(alike.variance == 0.0);
}

TEST_CASE("with_days: the error of the days adds in squares, its freedom by Satterthwaite",
          "[diagnosis]") {
  const diagnosis::CoefficientError own{3.0, 0.0, 10.0, 0.0};
  const auto all = with_days(own, 4.0, 5.0);
  CHECK_THAT(all.total(), WithinRel(5.0, 1e-12));
  CHECK_THAT(all.freedom, WithinRel(625.0 / (81.0 / 10.0 + 256.0 / 5.0), 1e-12));
  CHECK(with_days(own, 0.0, 5.0).freedom == 10.0);
}

TEST_CASE("in_words: what was taken of the days, or that nothing was", "[diagnosis]") {
  BetweenDays between = days({});
  CHECK_FALSE(diagnosis::in_words(between));
  between.other_days = {"2026-01-02"};
  CHECK_THAT(diagnosis::in_words(between).value(),
             Contains("2026-01-02") && Contains("supply 31 kPa") && Contains("usual sizes"));
  between.source = DaySource::estimated;
  between.factor = 2.0;
  between.healthy_dates = 5;
  CHECK_THAT(diagnosis::in_words(between).value(), Contains("2 times") && Contains("5 dates"));
  between.quantities.clear();
  CHECK_THAT(diagnosis::in_words(between).value(), Contains("counts as a leak"));
}

TEST_CASE("in_words: each size in the unit of its quantity", "[diagnosis]") {
  BetweenDays between = days({});
  between.quantities = {{"supply_pressure", "supply", "Pa", 2e6, "", 0},
                        {"position_offset", "position", "m", 2e-5, "", 0},
                        {"trigger", "start", "s", 5e-4, "", -1},
                        {"oil_temperature", "oil", "K", 3.0, "", 0}};
  between.other_days = {"2026-01-02"};
  CHECK_THAT(diagnosis::in_words(between).value(),
             Contains("supply 2 MPa") && Contains("position 20 µm") && Contains("start 0.5 ms") &&
                 Contains("oil 3 K"));
}

TEST_CASE("pooled_leak: the day of a state does not average out", "[diagnosis]") {
  diagnosis::StateMember member;
  member.coefficient = 1.0;
  member.own_se = 0.1;
  member.freedom = 1e6;
  member.rig_moves = Eigen::VectorXd::Zero(0);
  member.day_effects = Eigen::VectorXd::Constant(1, 0.3);
  member.day_weights = (Eigen::VectorXd(2) << 1.0, -1.0).finished();
  const Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(0, 0);
  const auto pooled = diagnosis::pooled_leak({member, member, member, member}, exact, {1.0, 1e6});
  CHECK_THAT(pooled.error.own_se, WithinRel(0.05, 1e-12));
  CHECK_THAT(pooled.error.days_se, WithinRel(0.3 * std::sqrt(2.0), 1e-12));
  CHECK_THAT(pooled.error.total(), WithinRel(std::sqrt(0.0025 + 0.18), 1e-12));
  // If the day moves two members apart, it explains their difference.
  diagnosis::StateMember lower = member;
  lower.coefficient = 0.4;
  lower.day_effects = -member.day_effects;
  const auto apart = diagnosis::pooled_leak({member, lower}, exact, {1.0, 1e6});
  CHECK_THAT(apart.coefficient, WithinRel(0.7, 1e-12));
  CHECK_THAT(apart.error.days_se, WithinAbs(0.0, 1e-12));
  CHECK_THAT(apart.chi_squared, WithinRel(0.36 / (0.02 + 0.72), 1e-9));
  const auto known = diagnosis::pooled_leak({member, member}, exact, {1.0, 3.0});
  CHECK(known.error.freedom < 4.0);
  CHECK(diagnosis::pooled_leak({member}, exact).error.days_se == 0.0);
}

TEST_CASE("leak_trends: each date has a day of its own, and all share the reference's",
          "[diagnosis]") {
  const auto trend_with = [](bool own_days, double days_factor) {
    std::vector<diagnosis::MachineState> states;
    for (int i = 0; i < 4; ++i) {
      diagnosis::MachineState& state = states.emplace_back();
      state.key = diagnosis::StateKey{"seal", {}, "2026-01-0" + std::to_string(1 + 2 * i)};
      state.members.emplace_back();
      state.pooled.coefficient = 0.3 + 0.02 * i;
      state.pooled.error.own_se = 0.01;
      state.pooled.error.freedom = 1e6;
      state.pooled.rig_moves = Eigen::VectorXd::Zero(0);
      state.pooled.day_moves = Eigen::VectorXd::Zero(5);
      state.pooled.day_moves(0) = -0.1;
      if (own_days) state.pooled.day_moves(1 + i) = 0.1;
      state.share_slope = 0.2;
    }
    const auto trends =
        diagnosis::leak_trends(states, Eigen::MatrixXd::Zero(0, 0), {}, {days_factor});
    REQUIRE(trends.size() == 1);
    return trends.front();
  };
  CHECK(trend_with(false, 1.0).significant);
  CHECK_FALSE(trend_with(true, 1.0).significant);
  // The points are on a line, so the square of the half width grows with the factor on the
  // variance between days.
  const auto square_with = [&](double days_factor) {
    const diagnosis::LeakTrend trend = trend_with(true, days_factor);
    return std::pow(trend.share_percent_per_day_ci95.high - trend.share_percent_per_day, 2);
  };
  CHECK(trend_with(true, 0.0).significant);
  CHECK_THAT(square_with(4.0) - square_with(0.0),
             WithinRel(4.0 * (square_with(1.0) - square_with(0.0)), 1e-6));
}

TEST_CASE("leak_trends: with the days counted, a slope of four errors is found over four dates",
          "[diagnosis]") {
  // Day and record contribute equally to the error. 88 % is expected, with a standard deviation of
  // 0.7 %, and without a slope 4.5 %, with one of 0.5 %.
  constexpr int kTrials = 2000;
  const double error_per_week = 0.01 * std::sqrt(2.0 / 5.0);
  const auto share_found = [&](double slope_in_errors) {
    std::mt19937_64 random(58);
    std::normal_distribution<double> normal(0.0, 0.01);
    int found = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double reference = normal(random);
      const auto states = four_weeks(0.01, [&](int week) {
        return 0.3 + slope_in_errors * error_per_week * week + normal(random) + normal(random) -
               reference;
      });
      found += only_trend(states, {1.0}).significant ? 1 : 0;
    }
    return static_cast<double>(found) / kTrials;
  };
  const double falsely = share_found(0.0);
  const double found = share_found(4.0);
  CAPTURE(falsely, found);
  CHECK(falsely > 0.02);
  CHECK(falsely < 0.065);
  CHECK(found > 0.85);
}

TEST_CASE("leak_trends: the level of the scatter depends on whether days are counted",
          "[diagnosis]") {
  // Chi-square is 3.2 with 2 degrees of freedom: 20 %. Errors and days add up to 0.01 sqrt(1 + f).
  const auto widened = [](double day_effect, double factor, double apart) {
    const auto states =
        four_weeks(day_effect, [&](int week) { return week % 2 == 0 ? 0.3 : 0.3 + apart; });
    return only_trend(states, {factor}).widened;
  };
  CHECK_THAT(widened(0.01, 0.0, 0.02), WithinRel(std::sqrt(1.6), 1e-9));
  CHECK_THAT(widened(0.0, 1.0, 0.02), WithinRel(std::sqrt(1.6), 1e-9));
  CHECK(widened(0.01, 1.0, 0.02 * std::sqrt(2.0)) == 1.0);
  CHECK(widened(0.01, 3.0, 0.04) == 1.0);
}

TEST_CASE("leak_trends: sizes from few healthy dates widen the interval by t", "[diagnosis]") {
  const auto states = four_weeks(0.01, [](int week) { return 0.3 + 0.02 * week; });
  const auto half = [&](double freedom) {
    const diagnosis::LeakTrend trend = only_trend(states, {1.0, freedom});
    return trend.share_percent_per_day_ci95.high - trend.share_percent_per_day;
  };
  // Half of the variance has three degrees of freedom, so the sum has twelve: 2.1788 for 1.9600.
  CHECK_THAT(half(3.0) / half(metrics::kManyDegrees), WithinRel(2.178813 / 1.959964, 1e-4));
}

TEST_CASE("fit_leak: a supply of another day moves the coefficient as it says", "[diagnosis]") {
  const test::HealthySine made = test::healthy_sine(0.3);
  diagnosis::RigFit rig = test::rig_of(made.campaign);
  const auto fitted = [&](double supply_pa) {
    diagnosis::LeakProblem problem(made.campaign, rig);
    problem.day_quantities = calib::day_quantities(made.campaign, rig_values(problem), 4e-3);
    const int supply = problem.day_quantities.front().index;
    for (auto& setting : problem.campaign.parameters)
      if (setting.index == supply) setting.value = supply_pa;
    return diagnosis::fit_leak(problem.up_to(1.0), rig, problem.campaign.conditions.front(),
                               made.record, std::nullopt, 0, nullptr, nullptr);
  };
  const auto fit = fitted(6.2e6);
  REQUIRE(fit.ok());
  REQUIRE(fit.day_effects.size() == 4);
  // An error in the model's supply pressure has the opposite effect to one in the record's.
  const double step = 3.1e3;
  const double moved =
      (fitted(6.2e6 - step).coefficient - fitted(6.2e6 + step).coefficient) / (2.0 * step);
  CHECK_THAT(std::abs(fit.day_effects(0)), WithinRel(std::abs(moved) * 31e3, 0.02));
  CHECK(fit.day_rms_m > 0.0);
}

TEST_CASE("healthy_day_changes: differences of simulations, per standard deviation",
          "[diagnosis]") {
  const test::HealthySine made = test::healthy_sine();
  const diagnosis::RigFit rig = test::rig_of(made.campaign);
  diagnosis::LeakProblem problem(made.campaign, rig);
  problem.day_quantities = calib::day_quantities(made.campaign, rig_values(problem), 4e-3);
  REQUIRE(problem.day_quantities.size() == 4);
  const datasets::Condition& condition = problem.campaign.conditions.front();
  const Eigen::MatrixXd changes = diagnosis::healthy_day_changes(problem, condition, made.record);
  const auto residual = [&](double supply_pa) {
    diagnosis::LeakProblem other = problem;
    for (auto& setting : other.campaign.parameters)
      if (setting.index == problem.day_quantities.front().index) setting.value = supply_pa;
    return diagnosis::healthy_residuals(other, other.campaign.conditions.front(), made.record,
                                        {&made.record})
        .front()
        .at(datasets::Channel::position);
  };
  const auto low = residual(6.2e6 - 31e3);
  const auto high = residual(6.2e6 + 31e3);
  const double largest = changes.col(0).cwiseAbs().maxCoeff();
  CHECK(largest > 1e-6);
  for (std::size_t i = 0; i < low.size(); ++i)
    CHECK_THAT(changes(static_cast<Eigen::Index>(i), 0),
               WithinAbs((low[i] - high[i]) / 2.0, 0.05 * largest));
  // A shifted zero shifts every sample; a later start changes the position by speed times time.
  CHECK_THAT(changes(100, 2), WithinRel(problem.day_quantities[2].sd, 1e-9));
  CHECK_THAT(problem.day_quantities[3].sd, WithinRel(0.5e-3, 1e-12));
  const auto model = residual(6.2e6);
  const auto& record = made.record.channels.at(datasets::Channel::position).mean;
  const auto position = [&](std::size_t i) { return record[i] - model[i]; };
  CHECK_THAT(changes(100, 3), WithinRel(0.5e-3 * (position(101) - position(99)) / 8e-3, 1e-6));
}
