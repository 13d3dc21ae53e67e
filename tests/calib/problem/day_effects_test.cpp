#include "calib/problem/day_effects.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "calib/fit.hpp"
#include "tests/calib/twin.hpp"

using namespace rigcal;
using Catch::WithinRel;

namespace {

/// A rig with unknown valve gain, and one record of a sine per date.
calib::Twin dated_twin(const std::vector<std::string>& dates) {
  calib::Twin twin;
  twin.free("valve_gain", 4.5e-5, 1e-5, 1e-4);
  for (std::size_t i = 0; i < dates.size(); ++i) {
    auto& condition = twin.add("sine_" + std::to_string(i), datasets::Waveform::sine, 4.0, 0.02);
    if (!dates[i].empty()) condition.date = dates[i];
  }
  twin.campaign.considered.none = true;
  twin.campaign.between_days.left_out = {"bulk_modulus", "position_offset", "trigger"};
  return twin;
}

const calib::FittedParameter& only(const calib::Fit& fit) {
  for (const auto& each : fit.parameters)
    if (each.fitted) return each;
  throw std::logic_error("nothing was fitted");
}

}  // namespace

TEST_CASE("day_quantities: usual sizes by the rig, and those that the campaign states", "[calib]") {
  calib::Twin twin;
  const auto values = datasets::values_in(twin.campaign, {});
  const auto sizes = [&](double sample_s) {
    std::map<std::string, double> result;
    for (const auto& each : calib::day_quantities(twin.campaign, values, sample_s))
      result[each.quantity] = each.sd;
    return result;
  };
  const auto usual = sizes(0.4e-3);
  CHECK(usual.size() == 4);
  CHECK_THAT(usual.at("supply_pressure"), WithinRel(5e-3 * values["supply_pressure"], 1e-12));
  CHECK_THAT(usual.at("bulk_modulus"), WithinRel(0.03 * values["bulk_modulus"], 1e-12));
  CHECK_THAT(usual.at(datasets::kTriggerKey), WithinRel(0.2e-3, 1e-12));
  // Triggers are late by a fraction of a millisecond, however slowly a record is sampled.
  CHECK_THAT(sizes(0.1).at(datasets::kTriggerKey), WithinRel(0.5e-3, 1e-12));
  CHECK_THAT(sizes(1e-6).at(datasets::kTriggerKey), WithinRel(0.05e-3, 1e-12));
  twin.campaign.between_days.sizes["supply_pressure"] = 7e4;
  CHECK(sizes(0.4e-3).at("supply_pressure") == 7e4);
}

TEST_CASE("day_changes: none by what was recorded, or moves a recorded drive too", "[calib]") {
  datasets::Condition settings;
  settings.waveform = datasets::Waveform::sine;
  calib::ProblemCondition condition;
  condition.condition = &settings;
  const std::vector<double> time_s{0.0, 1.0, 2.0};
  model::Simulation run;
  run.outputs = Eigen::Vector3d(0.0, 1.0, 4.0);
  run.sensitivities = {Eigen::Vector3d(2.0, 3.0, 4.0)};
  const std::vector<int> free{calib::Twin::index("supply_pressure")};
  const std::vector<calib::DayQuantity> quantities{
      {"supply_pressure", "supply", "Pa", 0.5, "", free.front()},
      {datasets::kTriggerKey, "start of the record", "s", 0.1, "", -1}};
  const auto changes = [&] { return day_changes(condition, run, 0, free, time_s, quantities); };
  const Eigen::Vector3d by_supply(1.0, 1.5, 2.0);
  const Eigen::Vector3d by_start(0.1, 0.2, 0.3);
  CHECK((changes().col(0) - by_supply).norm() < 1e-12);
  CHECK((changes().col(1) - by_start).norm() < 1e-12);
  condition.inputs.supply_pressure_pa = model::Signal::constant(6e6);
  CHECK(changes().col(0).isZero());
  CHECK((changes().col(1) - by_start).norm() < 1e-12);
  condition.inputs.supply_pressure_pa.reset();
  settings.waveform = datasets::Waveform::recorded;
  CHECK((changes().col(0) - by_supply).norm() < 1e-12);
  CHECK(changes().col(1).isZero());
}

TEST_CASE("day_errors: an estimate moves with the supply of its day", "[calib]") {
  calib::Twin twin = dated_twin({"2026-01-01"});
  const auto records = twin.records(500, 500.0, 1);
  const auto fitted = [&] { return calib::fit(twin.campaign, records, {}); };
  const calib::Fit fit = fitted();
  REQUIRE(only(fit).between_days_error);
  const double supply = twin.setting("supply_pressure").value;
  const auto gain_at = [&](double factor) {
    twin.setting("supply_pressure").value = factor * supply;
    return only(fitted()).value;
  };
  // The assumed size is 0.5 % of the supply pressure.
  const double moved = (gain_at(0.995) - gain_at(1.005)) / 2.0;
  CHECK_THAT(*only(fit).between_days_error, WithinRel(std::abs(moved), 0.03));
  CHECK(*only(fit).between_days_error > 1e-3 * only(fit).value);

  twin.setting("supply_pressure").value = supply;
  twin.campaign.between_days.sizes["supply_pressure"] = 0.01 * supply;
  CHECK_THAT(*only(fitted()).between_days_error,
             WithinRel(2.0 * *only(fit).between_days_error, 1e-6));
  twin.campaign.between_days.none = true;
  CHECK(only(fitted()).between_days_error.value_or(0.0) == 0.0);
}

TEST_CASE("day_errors: two dates average out, two records of one do not", "[calib]") {
  const auto error_of = [](const std::vector<std::string>& dates) {
    calib::Twin twin = dated_twin(dates);
    return only(calib::fit(twin.campaign, twin.records(500, 500.0, 1), {}))
        .between_days_error.value();
  };
  const double one = error_of({"2026-01-01"});
  CHECK_THAT(error_of({"2026-01-01", "2026-01-01"}), WithinRel(one, 0.02));
  CHECK_THAT(error_of({"", ""}), WithinRel(one, 0.02));
  CHECK_THAT(error_of({"2026-01-01", "2026-01-02"}), WithinRel(one / std::sqrt(2.0), 0.02));
}
