#include "model/solver/sampled_period.hpp"

#include <catch2/catch.hpp>

#include "tests/model/rig.hpp"

using namespace rigcal::model;

namespace {

std::optional<SampledPeriod> period_of(const Signal& drive, const std::vector<double>& times_s,
                                       std::optional<double> tick_s = {}) {
  return sampled_period({drive, {}, {}}, times_s, false, tick_s);
}

/// Period for a rig whose response reverses with its inputs.
std::optional<SampledPeriod> reversible_period_of(const Signal& drive,
                                                  const std::vector<double>& times_s,
                                                  std::optional<double> tick_s = {}) {
  return sampled_period({drive, {}, {}}, times_s, true, tick_s);
}

}  // namespace

TEST_CASE("sampled_period: one period of the drive, or as many as take whole samples", "[model]") {
  const auto times_s = grid(0.0, 3.0, 3001);
  for (const Signal& drive : {Signal::sine(0.01, 10.0), Signal::square(0.01, 10.0)}) {
    const auto period = period_of(drive, times_s);
    REQUIRE(period);
    CHECK(period->duration_s == Approx(0.1).epsilon(1e-15));
    CHECK(period->samples == 100);
  }
  const auto three = period_of(Signal::sine(0.01, 3.0), times_s);  // 333 1/3 samples per period
  REQUIRE(three);
  CHECK(three->duration_s == Approx(1.0).epsilon(1e-15));
  CHECK(three->samples == 1000);
  const auto late = period_of(Signal::sine(0.01, 10.0), grid(1.6e9, 1.6e9 + 3.0, 3001));
  REQUIRE(late);  // time stamps have a resolution of only 2e-7 s
  CHECK(late->samples == 100);
}

TEST_CASE("sampled_period: none where inputs or samples do not repeat themselves", "[model]") {
  const auto times_s = grid(0.0, 3.0, 3001);
  const Signal sine = Signal::sine(0.01, 10.0);
  CHECK_FALSE(period_of(Signal::chirp(0.01, 1.0, 10.0, 2.0, false), times_s));
  CHECK_FALSE(period_of(Signal::held({0.0, 1.0}, {0.0, 1.0}), times_s));
  CHECK_FALSE(period_of(Signal::constant(0.01), times_s));   // a constant has no period to detect
  CHECK_FALSE(period_of(Signal::sine(0.01, 0.1), times_s));  // longer than the record
  CHECK_FALSE(period_of(Signal::sine(0.01, kPi), times_s));
  auto shaken = times_s;
  shaken[2990] += 1e-6;
  CHECK_FALSE(period_of(sine, shaken));
  SimulationInputs inputs{sine, {}, {}};
  inputs.supply_pressure_pa = Signal::ripple(6e6, 1e5, 50.0, 0.0);
  CHECK_FALSE(sampled_period(inputs, times_s, false, {}));
  inputs.supply_pressure_pa = Signal::constant(6e6);
  inputs.base_acceleration_m_per_s2 = Signal::sine(1.0, 50.0);
  CHECK_FALSE(sampled_period(inputs, times_s, false, {}));
  inputs.base_acceleration_m_per_s2 = Signal::constant(1.0);
  inputs.oil_temperature_k = Signal::linear({0.0, 1.0}, {300.0, 301.0});
  CHECK_FALSE(sampled_period(inputs, times_s, false, {}));
  inputs.oil_temperature_k = Signal::constant(300.0);
  CHECK(sampled_period(inputs, times_s, false, {}));
}

TEST_CASE("sampled_period: inputs that begin to repeat later than the drive", "[model]") {
  const auto times_s = grid(5.0, 8.0, 3001);
  SimulationInputs inputs{Signal::sine(0.01, 10.0), {}, {}};
  inputs.supply_pressure_pa = Signal::linear({5.0, 8.0}, {6e6, 6e6}, {5.2, 0.05, false});
  inputs.spool_error = Signal::linear({5.0, 8.0}, {0.1, -0.1}, {5.3, 0.05, true});
  const auto half = sampled_period(inputs, times_s, true, {});
  REQUIRE(half);
  CHECK(half->reversed);
  CHECK(half->duration_s == Approx(0.05).epsilon(1e-15));
  CHECK(half->from_s == Approx(0.3).epsilon(1e-9));
  // An error of the spool that does not reverse leaves only whole periods.
  inputs.spool_error = Signal::linear({5.0, 8.0}, {0.1, -0.1}, {5.1, 0.1, false});
  const auto whole = sampled_period(inputs, times_s, true, {});
  REQUIRE(whole);
  CHECK_FALSE(whole->reversed);
  CHECK(whole->duration_s == Approx(0.1).epsilon(1e-15));
  CHECK(whole->from_s == Approx(0.2).epsilon(1e-9));
  inputs.spool_error = Signal::linear({5.0, 8.0}, {0.1, -0.1});
  CHECK_FALSE(sampled_period(inputs, times_s, true, {}));
}

TEST_CASE("sampled_period: half periods of a reversible rig", "[model]") {
  const auto times_s = grid(0.0, 3.0, 3001);
  for (const Signal& drive : {Signal::sine(0.01, 10.0), Signal::square(0.01, 10.0)}) {
    const auto half = reversible_period_of(drive, times_s);
    REQUIRE(half);
    CHECK(half->reversed);
    CHECK(half->sign() == -1.0);
    CHECK(half->duration_s == Approx(0.05).epsilon(1e-15));
    CHECK(half->samples == 50);
    CHECK_FALSE(period_of(drive, times_s)->reversed);
  }
  const auto three_halves = reversible_period_of(Signal::square(0.01, 3.0), times_s);
  REQUIRE(three_halves);  // 166 2/3 samples per half period
  CHECK(three_halves->reversed);
  CHECK(three_halves->samples == 500);
  const auto odd = reversible_period_of(Signal::sine(0.01, 8.0), grid(0.0, 3.0, 601));
  REQUIRE(odd);  // 12 1/2 samples per half period
  CHECK_FALSE(odd->reversed);
  CHECK(odd->samples == 25);
  const auto raised = reversible_period_of(Signal::ripple(0.1, 0.01, 10.0, 0.0), times_s);
  REQUIRE(raised);  // half a period later, its sign is not reversed
  CHECK_FALSE(raised->reversed);
  CHECK(raised->samples == 100);
  CHECK(reversible_period_of(Signal::sine(0.01, 10.0), times_s, 2e-3)->samples == 50);
  CHECK(reversible_period_of(Signal::sine(0.01, 10.0), times_s, 4e-3)->samples == 100);
}

TEST_CASE("sampled_period: the ticks of a controller repeat themselves too", "[model]") {
  const auto times_s = grid(0.0, 3.0, 3001);
  const Signal drive = Signal::sine(0.01, 10.0);
  CHECK(period_of(drive, times_s, 2e-3)->samples == 100);
  CHECK(period_of(drive, times_s, 3e-3)->samples == 300);  // 100 ticks, 3 periods
  CHECK_FALSE(period_of(drive, times_s, 1e-3 * kPi));
}
