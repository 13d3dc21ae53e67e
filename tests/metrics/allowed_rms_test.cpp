#include "metrics/allowed_rms.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrics/agreement.hpp"

using namespace rigcal::metrics;
using Catch::WithinRel;

TEST_CASE("allowed_rms: an error of this size leaves just the limit of rho2", "[metrics]") {
  std::vector<double> measured;
  std::vector<double> simulated;
  for (int i = 0; i < 400; ++i) {
    measured.push_back(3.0 + std::sin(2.0 * std::numbers::pi * 0.01 * i));
    simulated.push_back(measured.back() + (i % 2 == 0 ? 0.125 : -0.125));
  }
  const double limit = rho2(measured, simulated);
  CHECK_THAT(allowed_rms(measured, limit), WithinRel(0.125, 1e-9));
  CHECK(allowed_rms(measured, 1.0) == 0.0);
  CHECK(allowed_rms(std::vector<double>{1.0}, 0.9) == 0.0);
}
