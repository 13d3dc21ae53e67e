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
  twin.campaign.between_days.sds["supply_pressure"] = 0.01 * supply;
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
