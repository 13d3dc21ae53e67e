#include "datasets/spikes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "datasets/noise.hpp"

using namespace rigcal::datasets;
using Catch::WithinAbs;

namespace {

/// A step response with a ring, sampled densely, with noise of 0.01.
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
