#include "calib/problem/initial_state.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "calib/fit.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {

TEST_CASE("initial state: chamber pressures are read without their sensors' offsets", "[calib]") {
  Twin twin;
  twin.campaign.initial = datasets::InitialMode::record;
  twin.campaign.initial_window_s = 0.1;
  const datasets::Condition& condition = twin.add("rest", datasets::Waveform::sine, 1.0, 0.01);
  datasets::Record record;
  record.condition = condition.id;
  record.time_s = {0.0, 0.05, 0.1, 0.5};
  record.channels[datasets::Channel::position].mean = {1e-3, 1e-3, 1e-3, 9e-3};
  record.channels[datasets::Channel::pressure_a].mean = {3.6e6, 3.6e6, 3.6e6, 9e6};
  record.channels[datasets::Channel::pressure_b].mean = {3.0e6, 3.0e6, 3.0e6, 0.0};

  auto values = datasets::values_in(twin.campaign, condition);
  values.set("pressure_a_offset", 2e5);
  values.set("pressure_b_offset", -1e5);
  values.set("load_pressure_offset", 5e4);
  const InitialPlan plan = plan_initial_state(twin.campaign, condition, record, values);
  CHECK(plan.state == model::InitialState::given);
  for (const auto& [index, value] : plan.known) values.set(index, value);

  // The plant starts at the recorded load pressure minus the offset of its sensor.
  const double start_pa = values["initial_load_pressure"] - values["load_pressure_offset"];
  CHECK(start_pa == Approx(3.4e6 - 3.1e6));
  CHECK(values["initial_position"] == Approx(1e-3));
}

TEST_CASE("initial state: a record that begins in motion is no record of its start", "[calib]") {
  Twin twin;
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  const auto records = twin.records(250, 500.0, 3);
  twin.campaign.initial = datasets::InitialMode::record;
  const auto warned = [&] {
    const Fit found = fit(twin.campaign, records, {});
    return std::any_of(found.warnings.begin(), found.warnings.end(), [](const std::string& text) {
      return text.find("initial_window of 0.1 s (square)") != std::string::npos;
    });
  };
  CHECK(warned());
  twin.campaign.initial = datasets::InitialMode::fit;
  CHECK_FALSE(warned());
}

}  // namespace rigcal::calib
