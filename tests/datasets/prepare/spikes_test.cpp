#include "datasets/prepare/spikes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;
using Catch::WithinAbs;

namespace {

/// A densely sampled step response that rings, with noise of 0.01.
std::vector<double> ringing() {
  auto stream = random_stream(5, {"spikes"});
  std::vector<double> x;
  for (int i = 0; i < 4000; ++i) {
    const double t = 1e-3 * (i - 1000);
    const double clean = t < 0.0 ? 0.0 : 1.0 - std::exp(-20.0 * t) * std::cos(200.0 * t);
    x.push_back(clean + normal(stream, 0.01));
  }
  return x;
}

}  // namespace

TEST_CASE("find_spikes: single and double samples, with place and height", "[datasets]") {
  auto x = ringing();
  CHECK(find_spikes(x).empty());
  x[500] += 0.5;
  x[1003] -= 2.0;  // on the rise of the step
  x[2500] += 0.6;
  x[2501] += 0.7;
  const auto spikes = find_spikes(x);
  REQUIRE(spikes.size() == 3);
  CHECK(spikes[0].sample == 500);
  CHECK(spikes[0].length == 1);
  CHECK_THAT(spikes[0].height, WithinAbs(0.5, 0.06));
  CHECK(spikes[1].sample == 1003);
  CHECK_THAT(spikes[1].height, WithinAbs(-2.0, 0.1));
  CHECK(spikes[2].sample == 2500);
  CHECK(spikes[2].length == 2);
  CHECK_THAT(spikes[2].height, WithinAbs(0.7, 0.06));
}

TEST_CASE("find_spikes: edges, short pulses, steps of a converter and white noise are none",
          "[datasets]") {
  std::vector<double> x(1000, 0.0);
  const int shape = GENERATE(0, 1, 2, 3, 4);
  auto stream = random_stream(6, {"none"});
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (shape == 0) x[i] = i < 500 ? 0.0 : 1.0;
    if (shape == 1) x[i] = i >= 500 && i < 503 ? 1.0 : 0.0;
    if (shape == 2) x[i] = i % 7 == 0 ? 0.005 : 0.0;
    if (shape == 3) x[i] = normal(stream, 1.0);
    if (shape == 4) x[i] = std::sin(0.8 * static_cast<double>(i));
  }
  CAPTURE(shape);
  CHECK(find_spikes(x).empty());
  CHECK(find_spikes({0.0, 0.0, 9.0, 0.0, 0.0}).empty());
}

TEST_CASE("without_spikes: a line takes their place, all else stays", "[datasets]") {
  const auto clean = ringing();
  auto x = clean;
  x[500] += 0.5;
  x[2500] += 0.6;
  x[2501] += 0.7;
  const auto repaired = without_spikes(x, find_spikes(x));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool spike = i == 500 || i == 2500 || i == 2501;
    if (!spike) CHECK(repaired[i] == clean[i]);
  }
  CHECK_THAT(repaired[500], WithinAbs(0.5 * (clean[499] + clean[501]), 1e-12));
  CHECK_THAT(repaired[2501],
             WithinAbs(clean[2499] + 2.0 / 3.0 * (clean[2502] - clean[2499]), 1e-12));
}

namespace {

/// Alternates between `size` and -`size`, so every sample is 2 `size` from the line between its
/// neighbours.
std::vector<double> pattern_of(std::size_t samples, double size) {
  std::vector<double> x;
  for (std::size_t i = 0; i < samples; ++i) x.push_back(i % 2 == 0 ? size : -size);
  return x;
}

}  // namespace

TEST_CASE("find_spikes: beyond ten deviations of the noise", "[datasets]") {
  // Samples of +1, -1, ... are 2 from the line between neighbours. The sd is the median over
  // 0.6745.
  const double limit = 10.0 * 2.0 / 0.6745;
  for (const double off : {limit - 0.5, limit + 0.5}) {
    auto x = pattern_of(1000, 1.0);
    x[500] = -1.0 + off;  // both neighbours are -1
    const auto spikes = find_spikes(x);
    CAPTURE(off);
    REQUIRE(spikes.size() == (off > limit ? 1U : 0U));
    if (off > limit) CHECK_THAT(spikes[0].height, WithinAbs(off, 1e-12));
  }
}

TEST_CASE("find_spikes: beyond four steps of a coarse converter", "[datasets]") {
  for (const double steps : {3.9, 4.1}) {
    std::vector<double> x(1000, 0.0);
    for (std::size_t i = 0; i < 400; i += 7) x[i] = 1.0;
    x[700] = steps;
    CHECK(find_spikes(x).size() == (steps > 4.0 ? 1U : 0U));
  }
}

TEST_CASE("find_spikes: beyond three times what the neighbours differ by", "[datasets]") {
  for (const double off : {2.9, 3.1}) {
    auto x = pattern_of(1000, 1e-3);
    for (std::size_t i = 495; i <= 505; ++i) x[i] = i < 500 ? 0.0 : 1.0;
    x[500] = 0.5 + off;  // between 0 and 1
    CHECK(find_spikes(x).size() == (off > 3.0 ? 1U : 0U));
  }
}

TEST_CASE("find_spikes: one sample up and the next one down are no spike of two", "[datasets]") {
  std::vector<double> x(200, 0.0);
  x[100] = 1.0;
  x[101] = -1.0;
  CHECK(find_spikes(pattern_of(0, 1.0)).empty());
  auto noisy = pattern_of(200, 1e-3);
  noisy[100] += 1.0;
  noisy[101] -= 1.0;
  CHECK(find_spikes(noisy).empty());
}

TEST_CASE("find_spikes: sixteen samples are enough to tell the noise", "[datasets]") {
  for (const std::size_t samples : {15U, 16U}) {
    auto x = pattern_of(samples, 1e-3);
    x[7] += 1.0;
    CHECK(find_spikes(x).size() == (samples == 16 ? 1U : 0U));
  }
}

TEST_CASE("find_spikes: a pulse of three samples is a pulse", "[datasets]") {
  for (const std::size_t length : {1U, 2U, 3U}) {
    auto x = pattern_of(200, 1e-3);
    for (std::size_t i = 100; i < 100 + length; ++i) x[i] += 1.0;
    CHECK(find_spikes(x).size() == (length < 3 ? 1U : 0U));
  }
}
