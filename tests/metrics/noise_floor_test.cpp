#include "metrics/noise_floor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "metrics/agreement.hpp"

using namespace rigcal::metrics;
using Catch::Contains;
using Catch::WithinRel;

namespace {

using Values = std::vector<double>;

constexpr std::size_t kSamples = 2000;
constexpr int kDraws = 400;

Values sine(double amplitude) {
  Values values(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i)
    values[i] = 3.0 + amplitude * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 200.0);
  return values;
}

/// Mean of repeated recordings of `truth`, with noise of `sd_of_mean` left in it.
Values recorded(const Values& truth, double sd_of_mean, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0.0, sd_of_mean);
  Values mean = truth;
  for (double& value : mean) value += noise(generator);
  return mean;
}

}  // namespace

TEST_CASE("noise_floor: is what the truth scores against noisy means of repeats", "[metrics]") {
  const double sd_of_mean = GENERATE(0.01, 0.13, 0.45, 1.3);
  const Values truth = sine(1.0);
  std::mt19937_64 generator(11);
  NoiseFloor floor, scored;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Values measured = recorded(truth, sd_of_mean, generator);
    const NoiseFloor predicted = noise_floor(measured, sd_of_mean);
    floor.rho2 += predicted.rho2 / kDraws;
    floor.ccc += predicted.ccc / kDraws;
    floor.absolute_error_percent += predicted.absolute_error_percent / kDraws;
    const Agreement all = agreement(measured, truth);
    scored.rho2 += all.rho2 / kDraws;
    scored.ccc += all.ccc / kDraws;
    scored.absolute_error_percent += all.absolute_error_percent / kDraws;
  }
  CAPTURE(sd_of_mean, floor.rho2, floor.ccc);
  // var(n) varies by sqrt(2 / 2000) = 3 % per draw, and by 0.16 % in the mean of 400. The term that
  // the formulas leave out is 1 / 2000. The mean of |n| varies by half as much.
  CHECK_THAT(1.0 - scored.rho2, WithinRel(1.0 - floor.rho2, 0.01));
  CHECK_THAT(1.0 - scored.ccc, WithinRel(1.0 - floor.ccc, 0.01));
  CHECK_THAT(scored.absolute_error_percent, WithinRel(floor.absolute_error_percent, 0.005));
}

TEST_CASE("noise_floor: models that are not the truth stay below it", "[metrics]") {
  const Values truth = sine(1.0);
  const double gain = GENERATE(0.8, 0.95, 1.05, 1.2);
  std::mt19937_64 generator(12);
  Values model = truth;
  for (double& value : model) value = 3.0 + gain * (value - 3.0);
  double rho2_excess = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Values measured = recorded(truth, 0.3, generator);
    rho2_excess += rho2(measured, model) - noise_floor(measured, 0.3).rho2;
  }
  CHECK(rho2_excess < 0.0);
}

TEST_CASE("noise_floor: a raised gain beats the truth's concordance by x^2 / 8 at most",
          "[metrics]") {
  const double sd_of_mean = 0.3;
  const Values truth = sine(1.0);
  const double x = 2.0 * sd_of_mean * sd_of_mean;  // divided by var(t) = 1/2
  Values model = truth;
  for (double& value : model) value = 3.0 + std::sqrt(1.0 + x) * (value - 3.0);
  std::mt19937_64 generator(13);
  double excess = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Values measured = recorded(truth, sd_of_mean, generator);
    excess += (concordance(measured, model) - concordance(measured, truth)) / kDraws;
  }
  CHECK(excess > 0.0);
  CHECK(excess < x * x / 8.0);
}

TEST_CASE("noise_floor: closed values for a signal of known variance", "[metrics]") {
  // The variance is 1, and the peak-to-peak value is 2.
  const Values measured{-1.0, 1.0, 1.0, -1.0};
  const NoiseFloor floor = noise_floor(measured, 0.5);
  CHECK(floor.rho2 == 0.75);
  CHECK_THAT(floor.ccc, WithinRel(1.5 / 1.75, 1e-15));
  CHECK_THAT(floor.absolute_error_percent,
             WithinRel(25.0 * std::sqrt(2.0 / std::numbers::pi), 1e-15));

  const NoiseFloor clean = noise_floor(measured, 0.0);
  CHECK(clean.rho2 == 1.0);
  CHECK(clean.ccc == 1.0);
  CHECK(clean.absolute_error_percent == 0.0);
}

TEST_CASE("noise_floor: a record of noise alone has a floor of 0", "[metrics]") {
  const Values measured{-1.0, 1.0, 1.0, -1.0};
  const double sd_of_mean = GENERATE(1.0, 1.5, 1e200);
  const NoiseFloor floor = noise_floor(measured, sd_of_mean);
  CHECK(floor.rho2 == 0.0);
  CHECK(floor.ccc == 0.0);
  CHECK(floor.absolute_error_percent > 0.0);
}

TEST_CASE("noise_floor: bad input is refused", "[metrics]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(noise_floor(Values{1.0, 2.0}, -0.1), std::invalid_argument);
  CHECK_THROWS_WITH(noise_floor(Values{1.0, 2.0}, nan),
                    Contains("sd_of_mean is nan, expected a finite value of at least 0"));
  CHECK_THROWS_WITH(noise_floor(Values{1.0, nan}, 0.1), Contains("measured[1] is nan"));
  CHECK_THROWS_AS(noise_floor(Values{}, 0.1), std::invalid_argument);
  CHECK_THROWS_AS(noise_floor(Values{0.1, 0.1, 0.1}, 0.1), std::domain_error);
  CHECK_THROWS_AS(noise_floor(Values{0.0, 1e-200}, 1e200), std::domain_error);
}
