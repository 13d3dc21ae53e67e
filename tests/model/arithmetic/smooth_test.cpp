#include "model/arithmetic/smooth.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal::model;
using Catch::WithinRel;

namespace {
using D = Dual<1>;
constexpr double kRootEps = 100.0;

}  // namespace

TEST_CASE("signed_sqrt: odd, straight at zero, a root far away", "[model]") {
  for (const double p : {0.1, 30.0, 100.0, 5e3, 6.2e6}) {
    CAPTURE(p);
    CHECK(signed_sqrt(-p, kRootEps) == -signed_sqrt(p, kRootEps));
    // The expansion of (1 + (eps/P)^2)^(-1/4) gives a relative difference from a root of at most
    // (eps/P)^2 / 4.
    const double below = 0.25 * (kRootEps / p) * (kRootEps / p);
    CHECK(signed_sqrt(p, kRootEps) <= std::sqrt(p));
    CHECK(signed_sqrt(p, kRootEps) >= std::sqrt(p) * (1.0 - below - 1e-15));
  }
  CHECK(signed_sqrt(0.0, kRootEps) == 0.0);
  CHECK_THAT(signed_sqrt(D::variable(0.0, 0), kRootEps).derivative[0],
             WithinRel(1.0 / std::sqrt(kRootEps), 1e-15));
}

TEST_CASE("smooth_sign: odd, slope 1 / width at zero, 1 far away", "[model]") {
  const double width = 1e-3;
  CHECK_THAT(smooth_sign(D::variable(0.0, 0), width).derivative[0], WithinRel(1e3, 1e-15));
  CHECK(smooth_sign(-0.7e-3, width) == -smooth_sign(0.7e-3, width));
  CHECK(smooth_sign(0.1, width) == 1.0);
  CHECK(smooth_sign(-0.1, width) == -1.0);
}

TEST_CASE("clamp_symmetric: value and derivative switch at the limit", "[model]") {
  struct Row {
    double x, value, slope;
  };
  for (const Row& row : {Row{-11.0, -10.0, 0.0}, Row{-9.9, -9.9, 1.0}, Row{0.0, 0.0, 1.0},
                         Row{10.0, 10.0, 1.0}, Row{10.1, 10.0, 0.0}}) {
    CAPTURE(row.x);
    const D y = clamp_symmetric(D::variable(row.x, 0), 10.0);
    CHECK(y.value == row.value);
    CHECK(y.derivative[0] == row.slope);
  }
  // If the limit is the variable, its derivative is passed on with the sign of the side.
  CHECK(clamp_symmetric(D(12.0), D::variable(10.0, 0)).derivative[0] == 1.0);
  CHECK(clamp_symmetric(D(-12.0), D::variable(10.0, 0)).derivative[0] == -1.0);
}

TEST_CASE("dead_band: nothing within, continuous at the edge, slope 1 beyond", "[model]") {
  struct Row {
    double x, value, slope;
  };
  for (const Row& row : {Row{-3.0, -1.0, 1.0}, Row{-2.0, 0.0, 0.0}, Row{0.5, 0.0, 0.0},
                         Row{2.0, 0.0, 0.0}, Row{2.25, 0.25, 1.0}}) {
    CAPTURE(row.x);
    const D y = dead_band(D::variable(row.x, 0), 2.0);
    CHECK(y.value == row.value);
    CHECK(y.derivative[0] == row.slope);
  }
  CHECK(dead_band(0.3, 0.0) == 0.3);
  CHECK(dead_band(D(3.0), D::variable(2.0, 0)).derivative[0] == -1.0);
}
