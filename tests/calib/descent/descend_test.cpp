#include "calib/descent/descend.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace rigcal::calib;

namespace {

/// Rosenbrock's valley over [-2, 2]^2 with residuals 10 (y - x^2) and 1 - x; the minimum is at
/// (1, 1).
DescentOptions valley() {
  DescentOptions options;
  options.linearise = [](std::span<const double> z, bool) -> std::optional<Linearisation> {
    const double x = 4.0 * z[0] - 2.0;
    const double y = 4.0 * z[1] - 2.0;
    Linearisation at{Eigen::MatrixXd(2, 2), Eigen::Vector2d(10.0 * (y - x * x), 1.0 - x)};
    at.jacobian << -80.0 * x, 40.0, -4.0, 0.0;
    return at;
  };
  options.trust_radius = 10.0;
  options.most_iterations = 100;
  return options;
}

Descent descend(const DescentOptions& options, std::vector<double>& z) {
  return rigcal::calib::descend(options, 2, {false, false}, z);
}

}  // namespace

TEST_CASE("descend: to the minimum of a curved valley", "[calib]") {
  std::vector<double> z{0.2, 0.75};  // (-1.2, 1), the traditional start point
  int told = 0;
  DescentOptions options = valley();
  options.enough = [&](const DescentStep& step) { return step.number != told++; };
  const Descent found = descend(options, z);
  CHECK(found.converged);
  CHECK(found.failure.empty());
  CHECK(found.iterations + 1 == told);
  CHECK(z[0] == Approx(0.75).epsilon(1e-8));
  CHECK(z[1] == Approx(0.75).epsilon(1e-8));
}

TEST_CASE("descend: an unknown at an active bound stays there", "[calib]") {
  std::vector<double> z{0.2, 0.5};  // at y = 0, 100 x^4 + (1 - x)^2 has its minimum at x = 0.16126
  CHECK(rigcal::calib::descend(valley(), 2, {false, true}, z).converged);
  CHECK(z[1] == 0.5);
  const double x = 4.0 * z[0] - 2.0;
  CHECK(200.0 * x * x * x == Approx(1.0 - x).epsilon(1e-3));
}

TEST_CASE("descend: ends where it is told to, or cannot go on", "[calib]") {
  std::vector<double> z{0.2, 0.75};
  DescentOptions options = valley();
  options.enough = [](const DescentStep& step) { return step.number == 3; };
  CHECK(descend(options, z).iterations == 3);

  options = valley();
  options.most_iterations = 2;
  const Descent cut_short = descend(options, z);
  CHECK_FALSE(cut_short.converged);
  CHECK(cut_short.failure.empty());

  options = valley();
  options.linearise = [](std::span<const double>, bool) { return std::nullopt; };
  const Descent nowhere = descend(options, z);
  CHECK_FALSE(nowhere.converged);
  CHECK_THAT(nowhere.failure, Catch::Contains("gave up"));
}

TEST_CASE("descend: what is thrown comes out again", "[calib]") {
  std::vector<double> z{0.2, 0.75};
  DescentOptions options = valley();
  const auto whole = options.linearise;
  int calls = 0;
  options.linearise = [&](std::span<const double> at, bool jacobian) {
    if (++calls > 3) throw std::runtime_error("out of order");
    return whole(at, jacobian);
  };
  CHECK_THROWS_WITH(descend(options, z), "out of order");
  CHECK(calls == 4);  // not called again after the exception

  options = valley();
  options.enough = [](const DescentStep&) -> bool { throw std::runtime_error("no more"); };
  CHECK_THROWS_WITH(descend(options, z), "no more");
}
