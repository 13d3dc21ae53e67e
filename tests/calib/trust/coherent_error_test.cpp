#include "calib/trust/coherent_error.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinRel;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("coherent error: size of sensitivity times size of residual", "[calib]") {
  // |J c| = 0.6 and |r| = 2 for the first channel, 0.8 and 3 for the second.
  ScoreRows rows;
  rows.channels = 2;
  rows.jacobian = MatrixXd(8, 1);
  rows.jacobian << 0.3, -0.3, 0.3, -0.3, 0.4, 0.4, 0.4, 0.4;
  rows.residual = VectorXd(8);
  rows.residual << 1.0, 1.0, 1.0, -1.0, 1.5, -1.5, 1.5, 1.5;
  const MatrixXd one = MatrixXd::Identity(1, 1);
  const double both = 0.6 * 2.0 + 0.8 * 3.0;  // channels of one simulation add linearly
  CHECK_THAT(coherent_errors({rows}, {{true, true}}, one)(0), WithinRel(both, 1e-12));
  CHECK_THAT(coherent_errors({rows}, {{false, true}}, one)(0), WithinRel(2.4, 1e-12));
  CHECK(coherent_errors({rows}, {{false, false}}, one)(0) == 0.0);
  // Conditions have independent errors. A combination of twice the length has twice the error.
  CHECK_THAT(coherent_errors({rows, rows}, {{true, true}, {true, true}}, one)(0),
             WithinRel(both * std::sqrt(2.0), 1e-12));
  CHECK_THAT(coherent_errors({rows}, {{true, true}}, 2.0 * one)(0), WithinRel(2.0 * both, 1e-12));
}

Twin free_gain() {
  Twin twin;
  twin.free("valve_gain", 3.5e-5, 1e-5, 1e-4);
  twin.add("square", datasets::Waveform::square, 1.0, 0.01);
  return twin;
}

TEST_CASE("coherent error: which residuals are no noise", "[calib]") {
  Twin twin = free_gain();
  const auto flags = [&](double noise_m, bool tell_sd) {
    twin.noise_sd_m = noise_m;
    const auto records = twin.records(500, 1000.0, 1, model::InitialState::rest, tell_sd);
    const Problem problem = problem_of(twin, records);
    Evaluation optimum;
    optimum.conditions.resize(1);
    optimum.conditions[0].rms = {noise_m};
    return noiseless_channels(problem, optimum);
  };
  const std::vector<std::vector<bool>> noise{{false}};
  const std::vector<std::vector<bool>> none{{true}};
  CHECK(flags(1e-7, true) == noise);   // `sd` specifies the noise
  CHECK(flags(1e-7, false) == none);   // a hundred-thousandth of the range
  CHECK(flags(1e-4, false) == noise);  // a hundredth of the range
}

TEST_CASE("coherent error: the interval of a fit without noise holds the truth", "[calib]") {
  // The rig that made the records is 0.3 % stiffer than the fitted model.
  Twin twin = free_gain();
  twin.noise_sd_m = 0.0;
  twin.truth = twin.campaign;
  for (auto& each : twin.truth.parameters) {
    if (each.index == Twin::index("stiffness")) each.value *= 1.003;
    if (each.index == Twin::index("valve_gain")) each.value = 4.06e-5;
  }
  const auto records = twin.records(1000, 1000.0, 1, model::InitialState::rest, false);
  const Fit found = fit(twin.campaign, records, {});
  REQUIRE(found.status == FitStatus::converged);
  const auto& gain = parameter(found, "valve_gain");
  CHECK(std::abs(gain.value / 4.06e-5 - 1.0) > 1e-7);
  CHECK(gain.ci95->low < 4.06e-5);
  CHECK(gain.ci95->high > 4.06e-5);
}

}  // namespace
}  // namespace rigcal::calib
