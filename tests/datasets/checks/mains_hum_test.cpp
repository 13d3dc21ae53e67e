#include "datasets/checks/mains_hum.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;
using Rows = std::vector<std::vector<double>>;

namespace {

constexpr double kRateHz = 1000.0;

/// Repeats of white noise plus a sine with a separate phase in each, minus their mean.
Rows deviations(double frequency_hz, double amplitude, double noise, std::size_t samples,
                std::size_t repeats = 5) {
  auto stream = random_stream(7, {"hum"});
  Rows rows(repeats, std::vector<double>(samples));
  for (auto& row : rows) {
    const double phase = uniform(stream, 0.0, 2.0 * std::numbers::pi);
    for (std::size_t i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i) / kRateHz;
      row[i] = amplitude * std::sin(2.0 * std::numbers::pi * frequency_hz * t + phase) +
               normal(stream, noise);
    }
  }
  for (std::size_t i = 0; i < samples; ++i) {
    double mean = 0.0;
    for (const auto& row : rows) mean += row[i] / static_cast<double>(repeats);
    for (auto& row : rows) row[i] -= mean;
  }
  return rows;
}

}  // namespace

TEST_CASE("mains_hum: frequency and amplitude of what differs between repeats", "[datasets]") {
  for (const double mains : {49.9, 50.0, 60.0, 60.2}) {
    CAPTURE(mains);
    const auto found = mains_hum(deviations(mains, 0.3, 0.1, 20000, 40), kRateHz, 1.0);
    REQUIRE(found);
    CHECK(found->frequency_hz == (mains < 55.0 ? 50.0 : 60.0));
    // The mean of 40 repeats keeps about sqrt(1/40) of the amplitude, depending on the phases.
    CHECK_THAT(found->amplitude, Catch::WithinRel(0.3, 0.05));
  }
  CHECK(mains_hum(deviations(50.0, 0.3, 0.1, 500), kRateHz, 0.0));
}

TEST_CASE("mains_hum: neither noise nor lines elsewhere are hum", "[datasets]") {
  CHECK_FALSE(mains_hum(deviations(50.0, 0.0, 0.1, 20000), kRateHz, 0.0));
  CHECK_FALSE(mains_hum(deviations(55.0, 0.3, 0.1, 20000), kRateHz, 0.0));
  CHECK_FALSE(mains_hum(deviations(47.0, 0.3, 0.1, 20000), kRateHz, 0.0));
  // A line that is present but small compared with the noise: 2 % of the variance.
  CHECK_FALSE(mains_hum(deviations(50.0, 0.02, 0.1, 20000), kRateHz, 0.0));
  // A record that is too short or too slow, or a single repeat.
  CHECK_FALSE(mains_hum(deviations(50.0, 0.3, 0.1, 100), kRateHz, 0.0));
  CHECK_FALSE(mains_hum(deviations(50.0, 0.3, 0.1, 20000), 100.0, 0.0));
  CHECK_FALSE(mains_hum(deviations(50.0, 0.3, 0.1, 20000, 1), kRateHz, 0.0));
  CHECK_FALSE(mains_hum(deviations(50.0, 0.3, 0.1, 1), std::nan(""), 0.0));
}

TEST_CASE("mains_hum: a line among others of its size is none", "[datasets]") {
  Rows rows = deviations(50.0, 0.3, 0.1, 20000);
  REQUIRE(mains_hum(rows, kRateHz, 0.0));
  // A resonance around 50 Hz, with almost half of its power at 53 Hz.
  const Rows beside = deviations(53.0, 0.2, 0.0, 20000);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < rows[r].size(); ++i) rows[r][i] += beside[r][i];
  CHECK_FALSE(mains_hum(rows, kRateHz, 0.0));
}

TEST_CASE("mains_hum: late edges of a square wave are none", "[datasets]") {
  for (const double drive : {1.0, 10.0}) {
    CAPTURE(drive);
    Rows rows(3, std::vector<double>(20000));
    const std::vector<double> late_s{-0.002, 0.0, 0.002};
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t i = 0; i < rows[r].size(); ++i) {
        const auto square = [&](double t) {
          return std::sin(2.0 * std::numbers::pi * drive * t) < 0.0 ? -1.0 : 1.0;
        };
        const double t = static_cast<double>(i) / kRateHz + 1e-4;
        rows[r][i] = square(t - late_s[r]) - square(t);
      }
    }
    CHECK_FALSE(mains_hum(rows, kRateHz, drive));
  }
  // 50 Hz is a harmonic of 25 Hz. The other harmonics are too far away to show that it is not hum.
  CHECK_FALSE(mains_hum(deviations(50.0, 0.3, 0.1, 20000), kRateHz, 25.0));
}

TEST_CASE("mains_hum: samples that a repeat lacks do not count", "[datasets]") {
  Rows rows = deviations(50.0, 0.3, 0.1, 20000);
  for (std::size_t i = 0; i < 50; ++i) rows[1][i] = std::numeric_limits<double>::quiet_NaN();
  CHECK(mains_hum(rows, kRateHz, 0.0));
}
