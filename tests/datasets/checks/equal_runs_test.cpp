#include "datasets/checks/equal_runs.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/datasets/sensor_signals.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::WithinRel;

namespace {

bool noisy(const Samples& x) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return shows_noise(equal_runs(x), -kInfinity, kInfinity);
}

}  // namespace

TEST_CASE("equal_runs: place, length and value; together the whole signal", "[datasets]") {
  const auto runs = equal_runs(Samples{1.0, 1.0, 2.0, 1.0, 1.0, 1.0});
  REQUIRE(runs.size() == 3);
  CHECK(runs[0].begin == 0);
  CHECK(runs[0].end() == 2);
  CHECK(runs[1].begin == 2);
  CHECK(runs[1].length == 1);
  CHECK(runs[1].value == 2.0);
  CHECK(runs[2].begin == 3);
  CHECK(runs[2].end() == 6);
  CHECK(equal_runs(Samples{}).empty());
}

TEST_CASE("resolution, typical_step: least and median step of those that are not zero",
          "[datasets]") {
  const auto runs = equal_runs(Samples{0.0, 0.0, 0.1, 0.1, 0.6, 0.4, 0.7});
  CHECK_THAT(resolution(runs), WithinRel(0.1, 1e-12));
  CHECK_THAT(typical_step(runs), WithinRel(0.25, 1e-12));  // steps are 0.1, 0.2, 0.3, 0.5
  CHECK(resolution(equal_runs(Samples(5, 3.0))) == 0.0);
  CHECK(typical_step(equal_runs(Samples(5, 3.0))) == 0.0);
}

TEST_CASE("cuts_a_motion: three samples before and after a run lie far enough from it",
          "[datasets]") {
  const Samples x{0.0, 2.0, 3.0, 3.5, 3.5, 3.5, 3.4, 3.3, 3.2};
  const EqualRun top{3, 3, 3.5};
  CHECK(cuts_a_motion(x, top, 0.29));
  CHECK_FALSE(cuts_a_motion(x, top, 0.31));  // the signal leaves the run by 0.3
  // At one end of the record, only the other side decides. If the run fills the record, nothing
  // does.
  CHECK(cuts_a_motion(Samples(x.begin(), x.begin() + 6), top, 3.5));
  CHECK_FALSE(cuts_a_motion(Samples(3, 3.5), {0, 3, 3.5}, 0.0));
}

TEST_CASE("shows_noise: noise of two steps of a converter, not its flicker nor motion",
          "[datasets]") {
  CHECK(noisy(with_noise(Samples(2000, 0.0), 0.01)));
  CHECK(noisy(with_noise(sine_signal(2000, 1000.0), 0.01)));
  CHECK(noisy(quantised(with_noise(sine_signal(2000, 1000.0), 0.02), 0.01)));
  CHECK_FALSE(noisy(sine_signal(2000, 1000.0)));
  CHECK_FALSE(noisy(quantised(sine_signal(2000, 1000.0), 0.01)));
  CHECK_FALSE(noisy(quantised(with_noise(sine_signal(2000, 1000.0), 0.004), 0.01)));
  CHECK_FALSE(noisy(with_noise(lagged(square_signal(2000, 500.0), 20.0), 1e-9)));  // rounding
  CHECK_FALSE(noisy(with_noise(Samples(40, 0.0), 0.01)));  // too few samples
}

TEST_CASE("is_constant: one value throughout, or none at all", "[datasets]") {
  CHECK(is_constant(Samples{}));
  CHECK(is_constant(Samples{2.0, 2.0, 2.0}));
  CHECK_FALSE(is_constant(Samples{2.0, 2.0, 2.0 + 1e-15}));
}
