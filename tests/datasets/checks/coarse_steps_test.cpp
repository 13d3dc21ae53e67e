#include "datasets/checks/coarse_steps.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;

namespace {

/// One repeat: a slow ramp with noise, read in steps of 0.5.
std::vector<Repeat> read_in_steps(double noise) {
  auto stream = random_stream(3, {"steps"});
  Repeat repeat;
  for (int i = 0; i < 4000; ++i) {
    repeat.time_s.push_back(1e-3 * i);
    repeat.values[Channel::position].push_back(
        quantised(10.0 + 0.01 * i + normal(stream, noise), 0.5));
  }
  return {repeat};
}

}  // namespace

TEST_CASE("coarse_step: noise below half a step does not smooth it out", "[datasets]") {
  const auto repeats = read_in_steps(0.1);
  CHECK(coarse_step(repeats, Channel::position, 0.17) == 0.5);
  // The limit is sqrt(1/4 + 1/12) = 0.577 steps.
  CHECK(coarse_step(repeats, Channel::position, 0.28) == 0.5);
  CHECK_FALSE(coarse_step(repeats, Channel::position, 0.29));
  CHECK_FALSE(coarse_step(repeats, Channel::load_pressure, 0.17));
}

TEST_CASE("coarse_step: values that lie on no grid have none", "[datasets]") {
  std::vector<Repeat> repeats = read_in_steps(0.1);
  repeats[0].values[Channel::position][100] += 0.2;
  CHECK_FALSE(coarse_step(repeats, Channel::position, 0.17));
  CHECK_FALSE(coarse_step(repeats, Channel::position, 0.01));
  repeats[0].values[Channel::position].assign(4000, 1.0);
  CHECK_FALSE(coarse_step(repeats, Channel::position, 0.17));
}
