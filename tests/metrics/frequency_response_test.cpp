#include "metrics/frequency_response.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
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

Values even_times(std::size_t n, double step_s) {
  Values result(n);
  for (std::size_t i = 0; i < n; ++i) result[i] = static_cast<double>(i) * step_s;
  return result;
}

template <class Function>
Values values_at(const Values& time_s, Function function) {
  Values result;
  for (const double t : time_s) result.push_back(function(t));
  return result;
}

/// A sine that is one component of a drive.
struct Tone {
  double amplitude, frequency_hz, phase_rad;
};

std::complex<double> lag(double frequency_hz, double time_constant_s) {
  return 1.0 / std::complex<double>(1.0, 2.0 * std::numbers::pi * frequency_hz * time_constant_s);
}

Values through_lag(const Values& time_s, const std::vector<Tone>& tones, double time_constant_s) {
  return values_at(time_s, [&](double t) {
    double sum = 0.0;
    for (const Tone& tone : tones) {
      const std::complex<double> h = lag(tone.frequency_hz, time_constant_s);
      sum +=
          tone.amplitude * std::abs(h) *
          std::sin(2.0 * std::numbers::pi * tone.frequency_hz * t + tone.phase_rad + std::arg(h));
    }
    return sum;
  });
}

/// Periodic noise: one tone for each line from 1 Hz to 40 Hz in a record of 20 s.
std::vector<Tone> many_tones() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
  std::vector<Tone> tones;
  for (int k = 20; k <= 800; ++k) tones.push_back({1.0, k / 20.0, turn(random)});
  return tones;
}

Values with_noise(Values values, double sd, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sd);
  for (double& value : values) value += normal(random);
  return values;
}

}  // namespace

TEST_CASE("periodic_response: an output that owes nothing to the input has no interval",
          "[metrics]") {
  const Values time_s = even_times(128, 1.0 / 64.0);  // two periods, exact to the last bit
  const auto wave = [](double t) { return std::sin(2.0 * std::numbers::pi * (t - std::floor(t))); };
  const Values input = values_at(time_s, wave);
  const Values output = values_at(time_s, [&](double t) { return t < 1.0 ? wave(t) : -wave(t); });
  const auto points = periodic_response(time_s, input, output, 1.0);
  REQUIRE(points.size() == 1);
  CHECK(points[0].coherence == 0.0);
  CHECK(points[0].gain == 0.0);
  CHECK_FALSE(points[0].interval.has_value());
}

TEST_CASE("periodic_response: a square wave through a first-order lag, at its odd harmonics",
          "[metrics]") {
  const double f = 2.0;
  const double time_constant_s = 0.05;
  const Values t = even_times(4000, 1e-3);  // eight periods
  std::vector<Tone> tones;
  for (int k = 1; k <= 15; k += 2) tones.push_back({4.0 / (std::numbers::pi * k), k * f, 0.0});
  const Values u = values_at(t, [&](double time) {
    double sum = 0.0;
    for (const Tone& tone : tones)
      sum += tone.amplitude * std::sin(2.0 * std::numbers::pi * tone.frequency_hz * time);
    return 0.3 + sum;
  });
  const auto points = periodic_response(t, u, through_lag(t, tones, time_constant_s), f);
  REQUIRE(points.size() == 8);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double frequency = (2.0 * static_cast<double>(i) + 1.0) * f;
    CAPTURE(frequency);
    const std::complex<double> h = lag(frequency, time_constant_s);
    CHECK_THAT(points[i].frequency_hz, WithinRel(frequency, 1e-12));
    // Sums of sines are fitted without error except for rounding.
    CHECK_THAT(points[i].gain, WithinRel(std::abs(h), 1e-9));
    CHECK_THAT(points[i].phase_deg, WithinAbs(std::arg(h) * 180.0 / std::numbers::pi, 1e-7));
    CHECK_THAT(points[i].coherence, WithinAbs(1.0, 1e-9));
    CHECK(points[i].independent == 7.0);  // the first period is a transient
    REQUIRE(points[i].interval.has_value());
    CHECK_THAT(points[i].interval->gain_high, WithinRel(points[i].gain, 1e-3));
  }
}

TEST_CASE("periodic_response: a pure delay turns the phase in proportion to the frequency",
          "[metrics]") {
  const double f = 5.0;
  const double delay_s = 0.011;
  // This period is not a multiple of 1 ms, so samples never repeat.
  const double f_odd = 4.937;
  for (const double frequency : {f, f_odd}) {
    CAPTURE(frequency);
    const Values t = even_times(3000, 1e-3);
    const auto sine = [&](double time) {
      return std::sin(2.0 * std::numbers::pi * frequency * time);
    };
    const auto points = periodic_response(
        t, values_at(t, sine), values_at(t, [&](double time) { return sine(time - delay_s); }),
        frequency);
    REQUIRE(points.size() == 1);  // a sine has no harmonics
    CHECK_THAT(points[0].gain, WithinRel(1.0, 1e-9));
    CHECK_THAT(points[0].phase_deg, WithinAbs(-360.0 * frequency * delay_s, 1e-6));
  }
}

TEST_CASE("periodic_response: one period tells no scatter", "[metrics]") {
  const Values t = even_times(1000, 1e-3);
  const Values u =
      values_at(t, [](double time) { return std::sin(2.0 * std::numbers::pi * time); });
  const auto points = periodic_response(t, u, u, 1.0);
  REQUIRE(points.size() == 1);
  CHECK_FALSE(points[0].interval.has_value());
  CHECK(points[0].independent == 1.0);
}

TEST_CASE("periodic_response: 95 % intervals hold the truth about as often", "[metrics][long]") {
  const double f = 2.0;
  const std::complex<double> h = lag(f, 0.05);
  constexpr int kRecords = 400;
  for (const std::size_t periods : {3U, 7U}) {  // the first one does not count
    CAPTURE(periods);
    const Values t = even_times(500 * periods, 1e-3);
    const std::vector<Tone> tone{{1.0, f, 0.0}};
    const Values u =
        values_at(t, [&](double time) { return std::sin(2.0 * std::numbers::pi * f * time); });
    const Values y = through_lag(t, tone, 0.05);
    int gains = 0;
    int phases = 0;
    for (unsigned seed = 0; seed < kRecords; ++seed) {
      const auto points = periodic_response(t, u, with_noise(y, 0.5, seed), f);
      REQUIRE(points.size() == 1);
      REQUIRE(points[0].interval.has_value());
      const auto& interval = *points[0].interval;
      const double off_deg = points[0].phase_deg - std::arg(h) * 180.0 / std::numbers::pi;
      gains += interval.gain_low <= std::abs(h) && std::abs(h) <= interval.gain_high ? 1 : 0;
      phases += std::abs(off_deg) <= interval.phase_half_deg ? 1 : 0;
    }
    // The expected number is 380, with a binomial standard deviation of 4.4.
    CHECK(gains > 362);
    CHECK(gains < 396);
    CHECK(phases > 362);
    CHECK(phases < 396);
  }
}

TEST_CASE("periodic_response: no harmonic with fewer than four samples per cycle", "[metrics]") {
  // A square wave of 16 samples per period, whose fifth harmonic has 3.2.
  Values t, u;
  for (int i = 0; i < 64; ++i) {
    t.push_back(i / 16.0);
    u.push_back(i % 16 < 8 ? 1.0 : -1.0);
  }
  const auto points = periodic_response(t, u, u, 1.0);
  REQUIRE(points.size() == 2);
  CHECK(points[0].frequency_hz == 1.0);
  CHECK(points[1].frequency_hz == 3.0);
}

TEST_CASE("periodic_response: what the drive does not cause has no coherence", "[metrics]") {
  const Values t = even_times(20000, 1e-3);
  const Values u =
      values_at(t, [](double time) { return std::sin(2.0 * std::numbers::pi * time); });
  const Values noise = with_noise(Values(t.size(), 0.0), 1.0, 7);
  const auto points = periodic_response(t, u, noise, 1.0);
  REQUIRE(points.size() == 1);
  CHECK(points[0].coherence < kLeastCoherence);
}

TEST_CASE("broadband_response: noise through a first-order lag", "[metrics][long]") {
  const double step_s = 2e-3;
  const double time_constant_s = 0.02;
  const Values t = even_times(10001, step_s);
  const std::vector<Tone> tones = many_tones();
  const Values u = values_at(t, [&](double time) {
    double sum = 0.0;
    for (const Tone& tone : tones)
      sum += std::sin(2.0 * std::numbers::pi * tone.frequency_hz * time + tone.phase_rad);
    return sum;
  });
  const auto points = broadband_response(step_s, u, through_lag(t, tones, time_constant_s));
  int within = 0;
  for (const ResponsePoint& point : points) {
    if (point.frequency_hz < 1.2 || point.frequency_hz > 38.0) continue;
    CAPTURE(point.frequency_hz);
    const std::complex<double> h = lag(point.frequency_hz, time_constant_s);
    // Within a bin of a twelfth of a decade, the lag varies by this much.
    CHECK_THAT(point.gain, WithinRel(std::abs(h), 0.02));
    CHECK_THAT(point.phase_deg, WithinAbs(std::arg(h) * 180.0 / std::numbers::pi, 1.5));
    CHECK(point.coherence > 0.98);
    ++within;
  }
  CHECK(within > 12);
  CHECK(std::is_sorted(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.frequency_hz < b.frequency_hz;
  }));
}

TEST_CASE("broadband_response: a sweep through a pure delay, with drift", "[metrics]") {
  const double step_s = 1e-3;
  const double delay_s = 0.004;
  const Values t = even_times(30000, step_s);
  const auto sweep = [](double time) {
    return std::sin(2.0 * std::numbers::pi *
                    (0.5 * time + 0.5 * (20.0 - 0.5) / 30.0 * time * time));
  };
  const Values u = values_at(t, sweep);
  const Values y =
      values_at(t, [&](double time) { return 3.0 * sweep(time - delay_s) + 2.0 * time; });
  const auto points = broadband_response(step_s, u, y);
  int within = 0;
  for (const ResponsePoint& point : points) {
    if (point.frequency_hz < 3.0 || point.frequency_hz > 17.0) continue;
    CAPTURE(point.frequency_hz);
    CHECK_THAT(point.gain, WithinRel(3.0, 0.02));
    CHECK_THAT(point.phase_deg, WithinAbs(-360.0 * point.frequency_hz * delay_s, 1.0));
    CHECK(point.coherence > 0.95);
    ++within;
  }
  CHECK(within > 6);
  // Beyond the end of the sweep, the drive has no power.
  CHECK(points.back().frequency_hz < 100.0);
}

TEST_CASE("broadband_response: drift changes no point, not even at the lowest lines", "[metrics]") {
  const double step_s = 2e-3;
  const Values t = even_times(1001, step_s);
  const Values u = with_noise(Values(t.size(), 0.0), 1.0, 5);
  Values y = with_noise(u, 0.1, 6);
  const auto still = broadband_response(step_s, u, y);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += 50.0 * t[i];
  const auto drifting = broadband_response(step_s, u, y);
  REQUIRE(still.size() > 12);
  REQUIRE(drifting.size() == still.size());
  for (std::size_t i = 0; i < still.size(); ++i) {
    CAPTURE(still[i].frequency_hz);
    CHECK_THAT(drifting[i].gain, WithinRel(still[i].gain, 1e-8));
    CHECK_THAT(drifting[i].phase_deg, WithinAbs(still[i].phase_deg, 1e-6));
    CHECK_THAT(drifting[i].coherence, WithinRel(still[i].coherence, 1e-8));
  }
}

TEST_CASE("broadband_response: lines of a tapered record are not quite independent", "[metrics]") {
  // A taper of a tenth at each end has a mean square of 0.8 + 0.2 * 3/8 and a mean fourth power of
  // 0.8 + 0.2 * 35/128. The lowest bin has eight lines.
  const Values u = with_noise(Values(1001, 0.0), 1.0, 3);
  const auto points = broadband_response(2e-3, u, with_noise(u, 0.1, 4));
  REQUIRE_FALSE(points.empty());
  CHECK_THAT(points.front().independent,
             WithinRel(8.0 * 0.875 * 0.875 / (0.8 + 0.2 * 35.0 / 128.0), 1e-9));
}

TEST_CASE("broadband_response: intervals widen as coherence falls", "[metrics]") {
  const double step_s = 2e-3;
  const Values t = even_times(10001, step_s);
  const Values u = with_noise(Values(t.size(), 0.0), 1.0, 3);
  double before = 0.0;
  for (const double sd : {0.1, 1.0}) {
    const auto points = broadband_response(step_s, u, with_noise(u, sd, 4));
    double width = 0.0;
    int held = 0;
    for (const ResponsePoint& point : points) {
      REQUIRE(point.interval.has_value());
      width += point.interval->gain_high - point.interval->gain_low;
      held += point.interval->gain_low <= 1.0 && 1.0 <= point.interval->gain_high ? 1 : 0;
    }
    CHECK(width > 3.0 * before);
    before = width;
    // 95 % of about 25 bins. By chance, five are outside once in a hundred records.
    CHECK(held >= static_cast<int>(points.size()) - 5);
  }
  const auto points = broadband_response(step_s, u, with_noise(u, 1.0, 4));
  const auto last = std::max_element(
      points.begin(), points.end(),
      [](const auto& a, const auto& b) { return a.frequency_hz < b.frequency_hz; });
  CHECK_THAT(last->coherence, WithinAbs(0.5, 0.1));  // as much noise as signal
}

TEST_CASE("frequency response: nothing where nothing moves", "[metrics]") {
  const Values t = even_times(1000, 1e-3);
  const Values sine =
      values_at(t, [](double time) { return std::sin(20.0 * std::numbers::pi * time); });
  const Values flat(t.size(), 2.0);
  CHECK(periodic_response(t, flat, sine, 10.0).empty());
  CHECK(periodic_response(t, sine, flat, 10.0).empty());
  CHECK(broadband_response(1e-3, flat, sine).empty());
  CHECK(broadband_response(1e-3, sine, flat).empty());
}

TEST_CASE("frequency response: bad input is refused with what was wrong", "[metrics]") {
  const Values t = even_times(1000, 1e-3);
  const Values sine =
      values_at(t, [](double time) { return std::sin(20.0 * std::numbers::pi * time); });
  Values gap = sine;
  gap[7] = std::numeric_limits<double>::quiet_NaN();
  const Values few(10, 1.0);
  CHECK_THROWS_WITH(periodic_response(t, sine, few, 10.0), Contains("10 of the output"));
  CHECK_THROWS_WITH(periodic_response(t, sine, sine, 0.5), Contains("at least one period"));
  CHECK_THROWS_WITH(periodic_response(t, sine, sine, 200.0), Contains("5 samples in a period"));
  CHECK_THROWS_AS(periodic_response(t, gap, sine, 10.0), std::invalid_argument);
  CHECK_THROWS_AS(periodic_response(t, sine, sine, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(periodic_response(Values(t.rbegin(), t.rend()), sine, sine, 10.0),
                  std::invalid_argument);
  CHECK_THROWS_WITH(broadband_response(1e-3, few, few), Contains("at least 64"));
  CHECK_THROWS_AS(broadband_response(1e-3, gap, sine), std::invalid_argument);
  CHECK_THROWS_AS(broadband_response(0.0, sine, sine), std::invalid_argument);
}

TEST_CASE("band_levels: a sine has its root mean square in its band, and nothing elsewhere",
          "[metrics]") {
  const Values t = even_times(1000, 1e-3);
  const Values sine = values_at(
      t, [](double s) { return 5.0 + 2.0 * std::sin(2.0 * std::numbers::pi * 40.0 * s); });
  const BandLevels levels = band_levels(sine, 1000.0, 60.0);
  REQUIRE(levels.rms.size() == levels.frequency_hz.size());
  CHECK(std::is_sorted(levels.frequency_hz.begin(), levels.frequency_hz.end()));
  double squares = 0.0;
  for (std::size_t i = 0; i < levels.rms.size(); ++i) {
    squares += levels.rms[i] * levels.rms[i];
    const bool near = std::abs(levels.frequency_hz[i] - 40.0) < 1.0;
    if (near)
      CHECK_THAT(levels.rms[i], WithinRel(std::sqrt(2.0), 1e-9));
    else
      CHECK(levels.rms[i] < 1e-9);
  }
  CHECK_THAT(squares, WithinRel(2.0, 1e-9));
}
