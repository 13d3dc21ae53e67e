#include "calib/search/weights.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Waveform;

/// Two conditions with different valve gains, so that the estimate depends on their weights.
Twin of_two_minds() {
  Twin twin;
  twin.free("valve_gain", 3e-5, 1e-5, 2e-4);
  twin.add("large", Waveform::square, 2.0, 0.02);
  twin.add("small", Waveform::sine, 3.0, 0.002);
  twin.offsets["small"] = {Twin::index("valve_gain"), 3.6e-5};  // instead of 4.06e-5
  return twin;
}

double rmse(const Fit& found, std::size_t condition) {
  return found.conditions.at(condition).channels.at(0).metrics.rmse;
}

}  // namespace

TEST_CASE("weights: a channel ends with its residual over all records for its noise", "[calib]") {
  const Twin twin = of_two_minds();
  auto records = twin.records(500, 500.0, 3, model::InitialState::rest, false);
  records[1].time_s.resize(250);  // the weight of a record depends on its number of samples
  auto& small = records[1].channels[datasets::Channel::position];
  small.mean.resize(250);
  small.sd.resize(std::min<std::size_t>(small.sd.size(), 250));
  small.count.resize(std::min<std::size_t>(small.count.size(), 250));
  const Fit found = fit(twin.campaign, records, {});
  REQUIRE(found.status == FitStatus::converged);
  REQUIRE(rmse(found, 1) > 1.5 * rmse(found, 0));
  // If the same residuals are stated as noise, the estimate is the same.
  const double squares = 500.0 * std::pow(rmse(found, 0), 2) + 250.0 * std::pow(rmse(found, 1), 2);
  for (auto& record : records)
    record.channels[datasets::Channel::position].sd_of_mean = std::sqrt(squares / 750.0);
  const Fit stated = fit(twin.campaign, records, {});
  CAPTURE(rmse(found, 0), rmse(found, 1), parameter(stated, "valve_gain").value);
  CHECK_THAT(parameter(found, "valve_gain").value,
             WithinAbs(parameter(stated, "valve_gain").value,
                       0.2 * *parameter(stated, "valve_gain").standard_error));
  CHECK_THAT(found.reduced_chi_square.value(), WithinRel(1.0, 0.1));
}

TEST_CASE("weights: iterations of all rounds count", "[calib]") {
  const Twin twin = of_two_minds();
  auto records = twin.records(500, 500.0, 3, model::InitialState::rest, false);
  // Together with a record of known noise, the weight of the other record moves the optimum.
  records[1].channels[datasets::Channel::position].sd_of_mean = 5e-5;
  const Fit found = fit(twin.campaign, records, {});
  REQUIRE(found.starts.size() == 1);
  // The start ends before the first round, and a round takes at least one iteration.
  int total = 0;
  REQUIRE(std::sscanf(found.message.c_str(), "converged after %d iterations", &total) == 1);
  CAPTURE(found.message);
  CHECK(total > found.starts[0].iterations);
}

TEST_CASE("weights: no residual counts as less than simulations resolve", "[calib]") {
  Twin twin;
  twin.noise_sd_m = 0.0;
  twin.free("valve_gain", 3e-5, 1e-5, 2e-4);
  twin.add("square", Waveform::square, 2.0, 0.01);
  const Fit found =
      fit(twin.campaign, twin.records(250, 500.0, 1, model::InitialState::rest, false), {});
  REQUIRE(found.status == FitStatus::converged);
  CAPTURE(found.warnings);
  CHECK(found.reduced_chi_square.value() < 0.5);
}

}  // namespace rigcal::calib
