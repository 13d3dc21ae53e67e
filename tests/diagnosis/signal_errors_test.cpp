#include "diagnosis/signal_errors.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal::diagnosis;
using Catch::WithinRel;

namespace {

LeakFit fit_with(double coefficient, double effect_m) {
  LeakFit fit;
  fit.coefficient = coefficient;
  fit.effect_m = effect_m;
  return fit;
}

LeakFit rms_of(double parity_m, double misfit_m, double noise_m) {
  LeakFit fit;
  fit.parity_rms_m = parity_m;
  fit.misfit_rms_m = misfit_m;
  fit.noise_rms_m = noise_m;
  return fit;
}

}  // namespace

TEST_CASE("signal_errors: pooled over conditions, a degree of freedom less for each",
          "[diagnosis]") {
  const LeakFit a = fit_with(1.0, 1e-3);
  const LeakFit b = fit_with(3.0, 1e-3);
  const LeakFit c = fit_with(0.0, 2e-3);
  const LeakFit d = fit_with(2.0, 2e-3);
  const LeakFit e = fit_with(4.0, 2e-3);
  const LeakFit alone = fit_with(50.0, 1.0);
  const LeakFit healthy_a = fit_with(3.0, 1e-3);
  const LeakFit healthy_b = fit_with(-4.0, 1e-3);
  const auto errors = signal_errors({{&a, &b}, {&c, &d, &e}, {&alone}}, {&healthy_a, &healthy_b});
  // Sums of squares about the means: 2 * 1e-6 and 8 * 4e-6, of 1 + 2 degrees of freedom.
  REQUIRE(errors.repeat_m);
  CHECK_THAT(*errors.repeat_m, WithinRel(std::sqrt(34e-6 / 3.0), 1e-12));
  CHECK(errors.repeat_freedom == 3);
  REQUIRE(errors.healthy_m);
  CHECK_THAT(*errors.healthy_m, WithinRel(1e-3 * std::sqrt(12.5), 1e-12));
  const auto nothing = signal_errors({{&alone}}, {});
  CHECK_FALSE(nothing.repeat_m);
  CHECK_FALSE(nothing.healthy_m);
}

TEST_CASE("unexplained_share: powers beyond noise and beyond what healthy records leave",
          "[diagnosis]") {
  // Left 25 - 9 = 16, of which healthy records leave 1; a leak took 50 - 25: 15 / (15 + 25).
  CHECK_THAT(unexplained_share(rms_of(std::sqrt(50.0), 5.0, 3.0), 1.0), WithinRel(0.375, 1e-12));
  // A leak that takes nothing explains nothing, nor does one that makes it worse.
  CHECK_THAT(unexplained_share(rms_of(5.0, 5.0, 3.0), 1.0), WithinRel(1.0, 1e-12));
  CHECK_THAT(unexplained_share(rms_of(4.0, 5.0, 3.0), 1.0), WithinRel(1.0, 1e-12));
  // What is left, 4, is no more than twice the 2.1 of healthy records; 1.9 is another matter.
  CHECK(unexplained_share(rms_of(5.0, 5.0, 3.0), 2.1) == 0.0);
  CHECK(unexplained_share(rms_of(5.0, 5.0, 3.0), 1.9) > 0.0);
  // Nor more than noise: structured part 3, noise 4.
  CHECK(unexplained_share(rms_of(9.0, 5.0, 4.0), 0.0) == 0.0);
}
