#include "diagnosis/record/residual_rms.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal::diagnosis;
using Catch::WithinRel;

TEST_CASE("noise_rms: an alternating series is all noise, a ramp next to none", "[diagnosis]") {
  // Von Neumann: half the mean square of successive differences, which are 2 for +1, -1, +1, ...
  CHECK_THAT(noise_rms({1.0, -1.0, 1.0, -1.0, 1.0}), WithinRel(std::sqrt(2.0), 1e-12));
  CHECK_THAT(noise_rms({0.0, 1.0, 2.0, 3.0}), WithinRel(std::sqrt(0.5), 1e-12));
  CHECK(noise_rms({7.0, 7.0, 7.0}) == 0.0);
  CHECK(noise_rms({7.0}) == 0.0);
  CHECK(noise_rms({}) == 0.0);
}

TEST_CASE("noise_rms: independent samples have their own standard deviation", "[diagnosis]") {
  // The minimal standard generator (Park and Miller), uniform in (-1, 1), with a standard deviation
  // of 1/sqrt 3.
  std::vector<double> x;
  long long state = 1;
  for (int i = 0; i < 20000; ++i) {
    state = state * 16807 % 2147483647;
    x.push_back(2.0 * static_cast<double>(state) / 2147483647.0 - 1.0);
  }
  CHECK_THAT(noise_rms(x), WithinRel(1.0 / std::sqrt(3.0), 0.02));
  CHECK_THAT(rms(x), WithinRel(1.0 / std::sqrt(3.0), 0.02));
}

TEST_CASE("structured_rms: powers subtract", "[diagnosis]") {
  CHECK_THAT(structured_rms(5.0, 3.0), WithinRel(4.0, 1e-12));
  CHECK(structured_rms(3.0, 5.0) == 0.0);
  CHECK_THAT(rms({3.0, -4.0}), WithinRel(std::sqrt(12.5), 1e-12));
  CHECK(rms({}) == 0.0);
}
