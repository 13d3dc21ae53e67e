#include "metrics/fundamental.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

using namespace rigcal::metrics;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

using Values = std::vector<double>;

constexpr double kPi = std::numbers::pi;
// A fit to a pure sine is exact except for the rounding of its samples.
constexpr double kExact = 1e-12;

Values times(std::size_t n, double step_s, double start_s = 0.0) {
  Values result(n);
  for (std::size_t i = 0; i < n; ++i) result[i] = start_s + static_cast<double>(i) * step_s;
  return result;
}

template <class Function>
Values sampled(const Values& time_s, Function function) {
  Values result;
  for (const double t : time_s) result.push_back(function(t));
  return result;
}

Values sine(const Values& time_s, double amplitude, double frequency_hz, double phase_rad,
            double offset = 0.0) {
  return sampled(time_s, [=](double t) {
    return offset + amplitude * std::sin(2.0 * kPi * frequency_hz * t + phase_rad);
  });
}

}  // namespace

TEST_CASE("fundamental: finds amplitude and phase of a sine, whatever its offset", "[metrics]") {
  const double frequency_hz = GENERATE(0.1, 1.0, 10.0);
  const double phase_rad = GENERATE(-3.0, -0.5, 0.0, 1.0, 3.1);
  const double offset = GENERATE(0.0, 2.0);
  const Values t = times(2500, 1e-3 / frequency_hz);  // two and a half periods
  const Fundamental f =
      fundamental(t, sine(t, 0.0508, frequency_hz, phase_rad, offset), frequency_hz);
  CHECK_THAT(f.amplitude, WithinRel(0.0508, kExact));
  CHECK_THAT(f.phase_rad, WithinAbs(phase_rad, kExact));
}

TEST_CASE("fundamental: sample times need not be equidistant", "[metrics]") {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> jitter(-4e-4, 4e-4);
  Values t = times(3000, 1e-3, 5.0);
  for (double& value : t) value += jitter(generator);
  const Fundamental f = fundamental(t, sine(t, 2.0, 1.0, 0.7, 1.0), 1.0);
  CHECK_THAT(f.amplitude, WithinRel(2.0, kExact));
  CHECK_THAT(f.phase_rad, WithinAbs(0.7, kExact));
}

TEST_CASE("fundamental: of a square wave is 4 / pi of it", "[metrics]") {
  // Sampled between the edges with n = 1000 per period, it is 4 / pi up to (pi / n)^2 / 6 = 2e-6.
  const Values t = times(2000, 1e-3, 5e-4);
  const Values square =
      sampled(t, [](double s) { return std::sin(2.0 * kPi * s) > 0 ? 1.0 : -1.0; });
  const Fundamental f = fundamental(t, square, 1.0);
  CHECK_THAT(f.amplitude, WithinRel(4.0 / kPi, 2e-6));
  CHECK_THAT(f.phase_rad, WithinAbs(0.0, kExact));
}

TEST_CASE("fundamental: whole periods leave harmonics out", "[metrics]") {
  // The record ends before or after a whole number of periods. The window must still contain whole
  // periods.
  const std::size_t samples = GENERATE(1000, 1001, 1700, 2000, 2001, 3000, 3001, 4600);
  CAPTURE(samples);
  const Values t = times(samples, 1e-3);
  const Values signal = sampled(t, [](double s) {
    return std::sin(2.0 * kPi * s + 0.3) + 0.5 * std::sin(4.0 * kPi * s) +
           0.2 * std::cos(6.0 * kPi * s) + 7.0;
  });
  const Fundamental f = fundamental(t, signal, 1.0);
  CHECK_THAT(f.amplitude, WithinRel(1.0, 1e-11));
  CHECK_THAT(f.phase_rad, WithinAbs(0.3, 1e-11));
}

TEST_CASE("fundamental: drops the first period when there are three", "[metrics]") {
  const auto with_transient = [](double s) {
    return std::sin(2.0 * kPi * s) + (s < 0.9 ? 5.0 : 0.0);
  };
  const Values three = times(3000, 1e-3);
  CHECK_THAT(fundamental(three, sampled(three, with_transient), 1.0).amplitude,
             WithinRel(1.0, kExact));
  const Values two = times(2000, 1e-3);
  CHECK(fundamental(two, sampled(two, with_transient), 1.0).amplitude > 1.1);
}

TEST_CASE("fundamental: a signal without the frequency has amplitude 0, exactly", "[metrics]") {
  const Values t = times(2000, 1e-3);
  CHECK(fundamental(t, Values(2000, 1e9 + 0.1), 1.0).amplitude == 0.0);
  const Fundamental f = fundamental(t, sine(t, 1.0, 2.0, 0.4), 1.0);
  CHECK(f.amplitude == 0.0);
  CHECK(f.phase_rad == 0.0);
}

TEST_CASE("compare_fundamentals: gain, phase and delay of a delayed, weaker simulation",
          "[metrics]") {
  const double delay_s = GENERATE(-0.02, 0.0, 0.004, 0.03);
  const double frequency_hz = 10.0;
  const Values t = times(1000, 1e-3);
  const Values measured = sine(t, 2.0, frequency_hz, 0.3);
  const Values simulated =
      sine(t, 1.5, frequency_hz, 0.3 - 2.0 * kPi * frequency_hz * delay_s, 4.0);
  const FundamentalComparison c = compare_fundamentals(t, measured, simulated, frequency_hz);
  CHECK_THAT(c.gain_ratio, WithinRel(0.75, kExact));
  CHECK_THAT(c.phase_deg, WithinAbs(-360.0 * frequency_hz * delay_s, 1e-9));
  CHECK_THAT(c.delay_s, WithinAbs(delay_s, 1e-12));
}

TEST_CASE("compare_fundamentals: the phase is above -180 and at most 180 degrees", "[metrics]") {
  const Values t = times(1000, 1e-3);
  const auto phase = [&](double from, double to) {
    return compare_fundamentals(t, sine(t, 1.0, 2.0, from), sine(t, 1.0, 2.0, to), 2.0).phase_deg;
  };
  CHECK_THAT(phase(-3.0, 3.0), WithinAbs(6.0 * 180.0 / kPi - 360.0, 1e-9));
  CHECK_THAT(phase(3.0, -3.0), WithinAbs(360.0 - 6.0 * 180.0 / kPi, 1e-9));
  // Exactly on the edge, rounding may choose the side, but never -180 itself.
  CHECK_THAT(std::abs(phase(0.0, kPi)), WithinAbs(180.0, 1e-9));
  CHECK(phase(0.0, kPi) > -180.0);
}

TEST_CASE("compare_fundamentals: first-order lag at its corner", "[metrics]") {
  const double frequency_hz = 0.5;
  const Values t = times(8000, 1e-3);
  const FundamentalComparison r =
      compare_fundamentals(t, sine(t, 2.0, frequency_hz, 0.0),
                           sine(t, 2.0 / std::sqrt(2.0), frequency_hz, -kPi / 4.0), frequency_hz);
  CHECK_THAT(r.gain_ratio, WithinRel(1.0 / std::sqrt(2.0), kExact));
  CHECK_THAT(r.phase_deg, WithinAbs(-45.0, 1e-9));
  CHECK_THAT(r.delay_s, WithinRel(0.25, kExact));
}

TEST_CASE("compare_fundamentals: a phase that does not exist is refused", "[metrics]") {
  const Values t = times(2000, 1e-3);
  const Values moving = sine(t, 1.0, 1.0, 0.0);
  const Values flat(2000, 0.1);
  const Values twice = sine(t, 1.0, 2.0, 0.4);
  CHECK_THROWS_AS(compare_fundamentals(t, flat, moving, 1.0), std::domain_error);
  CHECK_THROWS_WITH(compare_fundamentals(t, twice, moving, 1.0),
                    Contains("the measured signal has no component at 1 Hz"));
  CHECK_THROWS_WITH(compare_fundamentals(t, moving, flat, 1.0),
                    Contains("the simulated signal has no component at 1 Hz"));
}

TEST_CASE("fundamental: records that cannot tell are refused", "[metrics]") {
  const Values t = times(2000, 1e-3);
  const Values signal = sine(t, 1.0, 1.0, 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](const Values& time_s, const Values& values, double frequency_hz,
                          const char* message) {
    CHECK_THROWS_AS(fundamental(time_s, values, frequency_hz), std::invalid_argument);
    CHECK_THROWS_WITH(fundamental(time_s, values, frequency_hz), Contains(message));
  };
  refuses(t, Values(1999, 1.0), 1.0, "2000 sample times and 1999 samples");
  refuses({0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}, 1.0, "3 samples, expected at least 4");
  refuses({}, {}, 1.0, "0 samples, expected at least 4");
  refuses(t, signal, 0.0, "the frequency is 0 Hz");
  refuses(t, signal, -1.0, "the frequency is -1 Hz");
  refuses(t, signal, nan, "the frequency is nan Hz");
  refuses(t, signal, 0.4, "covers 2 s, expected at least one period of 2.5 s");
  refuses({0.0, 1.0, 1.0, 2.0}, {0.0, 1.0, 0.0, 1.0}, 1.0, "time_s[2] is 1 after 1");
  refuses({0.0, nan, 1.0, 2.0}, {0.0, 1.0, 0.0, 1.0}, 1.0, "time_s[1] is nan");
  refuses({0.0, 0.5, 1.0, 2.0}, {0.0, 1.0, nan, 1.0}, 1.0, "given[2] is nan");
  refuses(times(100, 0.5), sine(times(100, 0.5), 1.0, 1.0, 0.5), 1.0,
          "cannot separate this frequency from an offset");
  refuses({0.0, 0.1, 0.2, 9.0, 9.5, 10.0}, {0.0, 1.0, 0.0, 1.0, 2.0, 0.0}, 0.3,
          "3 samples of the given signal are in whole periods");
}
