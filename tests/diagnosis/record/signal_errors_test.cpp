#include "diagnosis/record/signal_errors.hpp"

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
  const auto errors =
      signal_errors({{{&a}, {&b}}, {{&c}, {&d}, {&e}}, {{&alone}}}, {&healthy_a, &healthy_b}, {});
  // The sums of squares around the means are 2 * 1e-6 and 8 * 4e-6, with 1 + 2 degrees of freedom.
  REQUIRE(errors.repeat_m);
  CHECK_THAT(*errors.repeat_m, WithinRel(std::sqrt(34e-6 / 3.0), 1e-12));
  CHECK(errors.repeat_freedom == 3);
  REQUIRE(errors.healthy_m);
  CHECK_THAT(*errors.healthy_m, WithinRel(1e-3 * std::sqrt(12.5), 1e-12));
  const auto nothing = signal_errors({{{&alone}}}, {}, {});
  CHECK_FALSE(nothing.repeat_m);
  CHECK_FALSE(nothing.healthy_m);
}

TEST_CASE("separate_noise: what white noise explains is no variation between repeats",
          "[diagnosis]") {
  // Coefficients of 1 and 3 have a variance of 2. White noise accounts for 0.5 of it, or for all
  // but a third, which still leaves a difference: chi-square with one degree of freedom is
  // then 1.5, and its upper quartile is 1.32. A ratio of 1.25 is below that.
  LeakFit a = fit_with(1.0, 1e-3);
  LeakFit b = fit_with(3.0, 1e-3);
  const auto separated = [&](double noise_variance) {
    a.noise_se = b.noise_se = std::sqrt(noise_variance);
    SignalErrors errors = signal_errors({{{&a}, {&b}}}, {}, {});
    CHECK_THAT(*errors.repeat_m, WithinRel(1e-3 * std::sqrt(2.0), 1e-12));
    CHECK_THAT(errors.repeat_noise_m, WithinRel(1e-3 * std::sqrt(noise_variance), 1e-12));
    separate_noise({&errors});
    return *errors.between_m;
  };
  CHECK_THAT(separated(0.5), WithinRel(1e-3 * std::sqrt(1.5), 1e-12));
  CHECK_THAT(separated(2.0 / 1.5), WithinRel(1e-3 * std::sqrt(2.0 / 3.0), 1e-12));
  CHECK(separated(2.0 / 1.25) == 0.0);
  CHECK(separated(3.0) == 0.0);
}

TEST_CASE("separate_noise: repeats of one signal differ by chance where all together do not",
          "[diagnosis]") {
  const auto errors_of = [](double ratio, int freedom) {
    SignalErrors errors;
    errors.repeat_noise_m = 1e-4;
    errors.repeat_m = 1e-4 * std::sqrt(ratio);
    errors.repeat_freedom = freedom;
    return errors;
  };
  // The upper quartiles of chi-square divided by its degrees of freedom are 1.27 for 8 and 1.08 for
  // 108.
  SignalErrors odd = errors_of(2.0, 8);
  SignalErrors quiet = errors_of(0.95, 100);
  separate_noise({&odd, &quiet});
  CHECK(*odd.between_m == 0.0);
  separate_noise({&odd});
  CHECK_THAT(*odd.between_m, WithinRel(1e-4, 1e-12));
  // A ratio of 2 with 8 degrees of freedom and 1.14 with 100 give 1.20 with 108.
  SignalErrors many = errors_of(1.14, 100);
  separate_noise({&odd, &many});
  CHECK_THAT(*odd.between_m, WithinRel(1e-4, 1e-12));
  CHECK_THAT(*many.between_m, WithinRel(1e-4 * std::sqrt(0.14), 1e-9));
  SignalErrors without_repeats;
  separate_noise({&without_repeats});
  CHECK_FALSE(without_repeats.between_m);
}

TEST_CASE("signal_errors: misfit is what all records together show beyond white noise",
          "[diagnosis]") {
  std::vector<LeakFit> fits(25, fit_with(1.0, 1e-3));
  const auto misfit = [&](double ratio) {
    std::vector<const LeakFit*> averages;
    for (LeakFit& each : fits) {
      each.white_se = 1e-2;
      each.cluster_se = 1e-2 * std::sqrt(ratio);
      each.cluster_freedom = 9;
      averages.push_back(&each);
    }
    return signal_errors({}, {}, averages).misfit;
  };
  // The upper quartile of chi-square divided by its 225 degrees of freedom is 1.06.
  CHECK_FALSE(misfit(1.0));
  CHECK_FALSE(misfit(1.05));
  CHECK(misfit(1.07));
  CHECK(signal_errors({}, {}, {}).misfit);  // nothing rules out lack of fit
}

TEST_CASE("signal_errors: residuals count as in the records, white or in clusters", "[diagnosis]") {
  // Clusters of 9 degrees of freedom that show 4 times the noise in one of two averages. The mean
  // variance is 2.5, and its degrees of freedom are 9 * (2 * 2.5)^2 / (2 * 4^2).
  std::vector<LeakFit> fits(2, fit_with(1.0, 1e-3));
  for (LeakFit& each : fits) {
    each.white_se = each.cluster_se = 1e-2;
    each.cluster_freedom = 9;
  }
  fits[0].cluster_se = 2e-2;
  const auto errors = signal_errors({}, {}, {&fits[0], &fits[1]});
  REQUIRE(errors.misfit);
  CHECK_THAT(errors.residual_ratio, WithinRel(2.5, 1e-12));
  CHECK_THAT(errors.residual_freedom, WithinRel(9.0 * 25.0 / 32.0, 1e-4));
  // Without a misfit of the signal, each record has white noise.
  fits[0].cluster_se = 1e-2;
  const auto white = signal_errors({}, {}, {&fits[0], &fits[1]});
  REQUIRE_FALSE(white.misfit);
  CHECK(white.residual_ratio == 1.0);
  CHECK(white.residual_freedom == rigcal::metrics::kManyDegrees);
}

TEST_CASE("signal_errors: healthy repeats that correct each other lie farther apart",
          "[diagnosis]") {
  // A repeat minus the mean of the four others deviates 5/4 times as much as the repeat itself.
  const double itself[] = {2.0, 5.0, -1.0, 0.0, 4.0};
  std::vector<LeakFit> fits;
  std::vector<LeakFit> corrected;
  for (const double x : itself) {
    fits.push_back(fit_with(x, 1e-3));
    corrected.push_back(fit_with(x - (10.0 - x) / 4.0, 1e-3));
  }
  std::vector<std::vector<SingleFit>> plain(1);
  std::vector<std::vector<SingleFit>> by_others(1);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    plain[0].push_back({&fits[i]});
    by_others[0].push_back({&corrected[i], 4});
  }
  CHECK_THAT(*signal_errors(by_others, {}, {}).repeat_m,
             WithinRel(*signal_errors(plain, {}, {}).repeat_m, 1e-12));
}

TEST_CASE("unexplained_share: powers beyond noise and beyond what healthy records leave",
          "[diagnosis]") {
  // What is left is 25 - 9 = 16, of which healthy records explain 1, and a leak removed 50 - 25:
  // 15 / (15 + 25).
  CHECK_THAT(unexplained_share(rms_of(std::sqrt(50.0), 5.0, 3.0), 1.0), WithinRel(0.375, 1e-12));
  // A leak that removes nothing explains nothing, nor does one that increases the residual.
  CHECK_THAT(unexplained_share(rms_of(5.0, 5.0, 3.0), 1.0), WithinRel(1.0, 1e-12));
  CHECK_THAT(unexplained_share(rms_of(4.0, 5.0, 3.0), 1.0), WithinRel(1.0, 1e-12));
  // Without the noise, the residual is 4. It counts if it is more than twice that of healthy
  // records: at 1.9, but not at 2.1.
  CHECK(unexplained_share(rms_of(5.0, 5.0, 3.0), 2.1) == 0.0);
  CHECK(unexplained_share(rms_of(5.0, 5.0, 3.0), 1.9) > 0.0);
  // It must also exceed the noise: here the structured part is 3 and the noise is 4.
  CHECK(unexplained_share(rms_of(9.0, 5.0, 4.0), 0.0) == 0.0);
}
