#include "calib/cross_validation.hpp"

#include <catch2/catch.hpp>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {

using Catch::Contains;
using Catch::WithinRel;
using datasets::Channel;

TEST_CASE("cross-validation: what is predicted worse than fitted, and what moves", "[calib]") {
  HeldOut held;
  held.condition = "sine";
  held.rmse = {{Channel::position, 2e-3}};
  held.fitted_rmse = {{Channel::position, 1e-3}};
  held.largest_shift = -4.0;
  held.shifted = "mass_kg";
  HeldOut even = held;
  even.condition = "square";
  even.rmse = {{Channel::position, 1.4e-3}};
  even.largest_shift = 2.9;
  const auto words = cross_validation_words({held, even});
  REQUIRE(words.size() == 2);
  CHECK_THAT(words[0], Contains("\"sine\"") && Contains("predicted 2 times worse"));
  CHECK_THAT(words[1], Contains("\"sine\"") && Contains("mass_kg changes by -4 standard errors"));
  CHECK_THAT(cross_validation_summary({even, held}),
             Contains("2 of 2 conditions") &&
                 Contains("at most 2 times that of the fit (position of \"sine\")"));
}

TEST_CASE("cross-validation: a shift goes to where the others lead", "[calib]") {
  Twin twin;
  twin.free("valve_gain", 4e-5, 1e-5, 2e-4);
  twin.add("low", datasets::Waveform::square, 2.0, 0.01);
  twin.add("high", datasets::Waveform::square, 2.0, 0.01);
  twin.offsets["high"] = {Twin::index("valve_gain"), 4.3e-5};  // instead of 4.06e-5
  const auto records = twin.records(250, 500.0, 3);
  FitOptions options;
  options.cross_validate = true;
  const Fit found = fit(twin.campaign, records, options);
  REQUIRE(found.cross_validation->size() == 2);
  CHECK(found.cross_validation->at(0).largest_shift.value() > 1.0);   // without the low one
  CHECK(found.cross_validation->at(1).largest_shift.value() < -1.0);  // without the high one
  CHECK(found.cross_validation->at(0).shifted == "valve_gain_m_per_v");

  // The conditions contradict each other, so the residuals are not white. A shift is relative to
  // the error that takes this into account.
  datasets::Campaign high = twin.campaign;
  high.conditions[0].use = datasets::Use::ignore;
  const double without_low = parameter(fit(high, records, {}), "valve_gain").value;
  const FittedParameter& gain = parameter(found, "valve_gain");
  REQUIRE(gain.robust_standard_error.value() > 1.5 * gain.standard_error.value());
  CHECK_THAT(found.cross_validation->at(0).largest_shift.value(),
             WithinRel((without_low - gain.value) / *gain.robust_standard_error, 0.02));

  // Without an iteration, a fit of one condition stays at the estimate of both.
  options.max_iterations = 0;
  Budget budget;
  for (const HeldOut& held : cross_validate(twin.campaign, records, found, options, budget)) {
    CHECK(held.problem.has_value());
    CHECK(held.rmse.empty());
  }
}

TEST_CASE("cross-validation: a nuisance parameter may differ between conditions", "[calib]") {
  Twin twin;
  twin.free("valve_gain", 4e-5, 1e-5, 2e-4);
  twin.free("position_offset", 0.0, -1e-2, 1e-2).nuisance = true;
  twin.add("before", datasets::Waveform::square, 2.0, 0.01);
  twin.add("after", datasets::Waveform::square, 2.0, 0.01);
  twin.offsets["after"] = {Twin::index("position_offset"), 1e-3};
  FitOptions options;
  options.cross_validate = true;
  const Fit found = fit(twin.campaign, twin.records(250, 500.0, 3), options);
  REQUIRE(found.cross_validation->size() == 2);
  for (const HeldOut& held : found.cross_validation.value()) {
    CAPTURE(held.problem, held.largest_shift);
    CHECK(held.shifted == "valve_gain_m_per_v");
  }
}

}  // namespace rigcal::calib
