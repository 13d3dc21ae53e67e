#include "datasets/checks/repeat_checks.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;
using Places = std::vector<std::size_t>;

namespace {

Repeat repeat(std::vector<double> position) {
  Repeat result;
  for (std::size_t i = 0; i < position.size(); ++i) result.time_s.push_back(static_cast<double>(i));
  result.values[Channel::position] = std::move(position);
  return result;
}

}  // namespace

TEST_CASE("first_identical: the first repeat with the same samples", "[datasets]") {
  const std::vector<Repeat> repeats{repeat({1, 2, 3}), repeat({1, 2, 4}), repeat({1, 2, 3}),
                                    repeat({1, 2}),    repeat({1, 2, 3}), repeat({1, 2, 4})};
  CHECK(first_identical(repeats, {0, 1, 2, 3, 4, 5}, Channel::position) ==
        Places{0, 1, 0, 3, 0, 1});
  CHECK(first_identical(repeats, {1, 4, 5}, Channel::position) == Places{0, 1, 0});
}

TEST_CASE("first_identical: constants and commanded signals may come twice", "[datasets]") {
  std::vector<Repeat> repeats{repeat({5, 5, 5}), repeat({5, 5, 5})};
  CHECK(first_identical(repeats, {0, 1}, Channel::position) == Places{0, 1});
  for (Repeat& each : repeats) each.values[Channel::reference] = {0, 1, 2};
  CHECK(first_identical(repeats, {0, 1}, Channel::reference) == Places{0, 1});
}

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
