#include "model/plant/terms.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal::model;
using Catch::WithinRel;

namespace {

using D = Dual<1>;
constexpr double kSupply = 6.2e6;
constexpr double kCd = 0.6;
constexpr double kWidth = 0.02075;
constexpr double kRho = 847.0;
constexpr double kEps = 100.0;

template <typename X>
X servo(const X& spool, const X& load_pressure) {
  return servo_flow(spool, load_pressure, kSupply, valve_conductance(kCd, kWidth, kRho), kEps);
}

}  // namespace

TEST_CASE("servo_flow: eq. 4 where the head is large", "[model]") {
  struct Row {
    double spool, pressure, head;
  };
  // At heads above 1 MPa, the smoothing at 100 Pa changes the flow by less than 1e-8.
  for (const Row& row : {Row{1e-4, 0.0, 6.2e6}, Row{1e-4, 2e6, 4.2e6}, Row{1e-4, -2e6, 8.2e6},
                         Row{-1e-4, 2e6, 8.2e6}, Row{-1e-4, -2e6, 4.2e6}}) {
    CAPTURE(row.spool, row.pressure);
    CHECK_THAT(servo(row.spool, row.pressure),
               WithinRel(kCd * kWidth * row.spool * std::sqrt(row.head / kRho), 1e-8));
  }
}

TEST_CASE("servo_flow: odd under mirror of spool and pressure, nothing at zero spool", "[model]") {
  for (const double pressure : {-7e6, -1e6, 0.0, 3e6, 6.5e6}) {
    CAPTURE(pressure);
    CHECK(servo(-2e-4, -pressure) == -servo(2e-4, pressure));
    CHECK(servo(0.0, pressure) == 0.0);
  }
}

TEST_CASE("servo_flow: turns back where the load pressure passes the supply", "[model]") {
  CHECK(servo(1e-4, kSupply - 1.0) > 0.0);
  CHECK(servo(1e-4, kSupply) == 0.0);
  CHECK(servo(1e-4, kSupply + 1.0) < 0.0);
  CHECK(servo(-1e-4, -kSupply - 1.0) > 0.0);
  // The slope always opposes the pressure. A runaway would need a positive slope.
  for (const double pressure : {-6.2e6, 0.0, 6.1e6, 6.2e6, 6.3e6}) {
    CAPTURE(pressure);
    CHECK(servo(D(1e-4), D::variable(pressure, 0)).derivative[0] < 0.0);
    CHECK(servo(D(-1e-4), D::variable(pressure, 0)).derivative[0] < 0.0);
  }
}

TEST_CASE("orifice_leakage: odd, eq. 11 far from zero, finite slope at it", "[model]") {
  const auto leak = [](auto pressure) {
    return orifice_leakage(pressure, orifice_conductance(0.35, 4.456e-6, kRho), kEps);
  };
  const double gain = 0.35 * 4.456e-6 * std::sqrt(2.0 / kRho);
  CHECK(leak(-3e5) == -leak(3e5));
  CHECK_THAT(leak(1e6), WithinRel(gain * 1e3, 1e-8));  // (eps/P)^2 / 4 = 2.5e-9
  CHECK_THAT(leak(D::variable(0.0, 0)).derivative[0], WithinRel(gain / std::sqrt(kEps), 1e-14));
  CHECK(orifice_leakage(1e6, orifice_conductance(0.0, 4.456e-6, kRho), kEps) == 0.0);
}

TEST_CASE("dry_friction: breakaway, Coulomb limit, odd, nothing at rest", "[model]") {
  const auto friction = [](auto v) { return dry_friction(v, 200.0, 80.0, 0.01, 1e-4); };
  CHECK(friction(0.0) == 0.0);
  CHECK(friction(-0.02) == -friction(0.02));
  CHECK_THAT(friction(0.2), WithinRel(200.0, 1e-14));  // exp(-400) is negligible
  CHECK_THAT(friction(0.01), WithinRel(200.0 + 80.0 * std::exp(-1.0), 1e-14));
  CHECK_THAT(friction(D::variable(0.0, 0)).derivative[0], WithinRel(280.0 / 1e-4, 1e-14));
}

TEST_CASE("leaking_opening: fades under the land, continuous with its slope", "[model]") {
  const double c = 0.2;
  CHECK_THAT(leaking_opening(0.0, c), WithinRel(c, 1e-14));
  CHECK_THAT(leaking_opening(1.0, c), WithinRel(1.2, 1e-14));
  CHECK_THAT(leaking_opening(-1.0, c), WithinRel(c * c / 1.2, 1e-14));
  const double h = 1e-6;
  const double left = (leaking_opening(0.0, c) - leaking_opening(-h, c)) / h;
  const double right = (leaking_opening(h, c) - leaking_opening(0.0, c)) / h;
  CHECK_THAT(left, WithinRel(right, 1e-4));
}

TEST_CASE("stop_force: a spring that never pulls", "[model]") {
  CHECK(stop_force(-1e-3, 5.0, 1e8, 100.0) == 0.0);
  CHECK_THAT(stop_force(1e-5, 0.0, 1e8, 100.0), WithinRel(1e3, 1e-12));
  CHECK_THAT(stop_force(1e-5, 0.02, 1e8, 100.0), WithinRel(3e3, 1e-12));
  CHECK(stop_force(1e-5, -0.02, 1e8, 100.0) == 0.0);
}

TEST_CASE("aerated_bulk_modulus: oil at high pressure, the air's at low", "[model]") {
  const double oil = 1.4e9;
  CHECK_THAT(aerated_bulk_modulus(1e6, oil, 0.0, 1.4), WithinRel(oil, 1e-14));
  CHECK_THAT(aerated_bulk_modulus(5e8, oil, 0.01, 1.4), WithinRel(oil, 1e-2));
  // With rigid oil, only the air yields: n p divided by its volume fraction of 0.5.
  CHECK_THAT(aerated_bulk_modulus(0.0, 1e15, 0.5, 1.4), WithinRel(2.0 * 1.4 * 101325.0, 1e-6));
  double before = 0.0;
  for (const double p : {-1e5, 0.0, 1e5, 1e6, 1e7}) {
    const double beta = aerated_bulk_modulus(p, oil, 0.01, 1.4);
    CHECK(beta > before);
    before = beta;
  }
  // beta = -V dp/dV, with oil and air compressed independently.
  const double p = 8e5;
  const auto volume = [&](double at) {
    return 0.99 * std::exp(-at / oil) + 0.01 * std::pow(101325.0 / (at + 101325.0), 1.0 / 1.4);
  };
  const double slope = (volume(p + 10.0) - volume(p - 10.0)) / 20.0;
  // The law neglects how much the oil itself has shrunk, p / beta.
  CHECK_THAT(aerated_bulk_modulus(p, oil, 0.01, 1.4), WithinRel(-volume(p) / slope, 2.0 * p / oil));
}

TEST_CASE("terms: a hose is stiff where its pressure turns and yields as it goes on", "[model]") {
  const double yield_pa = 5e5;
  double memory = 1.0;  // the pressure came from below
  const auto walk = [&](double to_pa) {
    double taken = 0.0;
    const double step_pa = to_pa / 20000.0;
    for (int i = 0; i < 20000; ++i) {
      const double share = yielding_share(memory, to_pa > 0.0);
      memory += (1.0 - share) * step_pa / yield_pa;
      taken += share * step_pa;
    }
    return taken / to_pa;
  };
  CHECK(yielding_share(memory, true) == 1.0);
  CHECK(yielding_share(memory, false) == 0.0);
  CHECK(walk(-0.1 * yield_pa) < 0.01);
  CHECK(walk(-20.0 * yield_pa) > 0.7);
  CHECK(memory < -0.9);
  CHECK(memory >= -1.0);
  CHECK(walk(0.1 * yield_pa) < 0.03);
}

TEST_CASE("terms: a braid yields later the higher the pressure", "[model]") {
  CHECK_THAT(hose_yield(0.0, 2e5, 0.4), WithinRel(2e5 + 0.4 * 101325.0, 1e-12));
  CHECK_THAT(hose_yield(4e6, 0.0, 0.4) / hose_yield(2e6, 0.0, 0.4),
             WithinRel(4101325.0 / 2101325.0, 1e-12));
  CHECK(hose_yield(-1e6, 0.0, 0.4) > 0.0);
}

TEST_CASE("terms: two orifices in series pass the flow of one", "[model]") {
  // With the pressure p between them: y sqrt(P - p) = l sqrt(p) = o sqrt(P).
  const double head_pa = 3e6;
  for (const double y : {0.0, 0.3, 2.0, 40.0}) {
    const double l = 7.0;
    const double between_pa = head_pa * y * y / (y * y + l * l);
    CHECK(series_opening(y, l) * std::sqrt(head_pa) ==
          Approx(l * std::sqrt(between_pa)).epsilon(1e-12));
  }
}

TEST_CASE("absolute_pressure: from the atmosphere down to 1 kPa", "[model]") {
  CHECK_THAT(absolute_pressure(2e5), WithinRel(301325.0, 1e-14));
  CHECK_THAT(absolute_pressure(-1e5), WithinRel(1325.0, 1e-12));
  CHECK(absolute_pressure(-1.01e5) == 1e3);
  CHECK(absolute_pressure(-5e6) == 1e3);
}
