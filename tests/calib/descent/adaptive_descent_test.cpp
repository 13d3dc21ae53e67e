#include "calib/descent/adaptive_descent.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "calib/descent/descend.hpp"

namespace rigcal::calib {
namespace {

/// A problem with a few unknowns in a box, with analytical derivatives.
struct TestProblem {
  Eigen::VectorXd lower, upper;
  std::function<Linearisation(const Eigen::VectorXd&)> at;
  int evaluations = 0;

  std::vector<double> unit(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd z = (x - lower).cwiseQuotient(upper - lower);
    return {z.data(), z.data() + z.size()};
  }
  Eigen::VectorXd physical(std::span<const double> z) const {
    return lower + (upper - lower)
                       .cwiseProduct(Eigen::Map<const Eigen::VectorXd>(
                           z.data(), static_cast<Eigen::Index>(z.size())));
  }
  DescentOptions options() {
    DescentOptions options;
    options.linearise = [this](std::span<const double> z, bool) -> std::optional<Linearisation> {
      ++evaluations;
      Linearisation found = at(physical(z));
      found.jacobian *= (upper - lower).asDiagonal();
      return found;
    };
    options.trust_radius = 10.0;
    options.most_iterations = 500;
    return options;
  }
  double cost(std::span<const double> z) const {
    return 0.5 * at(physical(z)).residual.squaredNorm();
  }
};

TestProblem problem_in(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                       std::function<Linearisation(const Eigen::VectorXd&)> at) {
  return {lower, upper, std::move(at), 0};
}

/// Brown and Dennis: 20 residuals of up to 3e4 at the minimum, where the cost is 42 911.1 (Moré,
/// Garbow and Hillstrom, ACM Trans. Math. Softw. 7, 1981, problem 16).
TestProblem brown_dennis() {
  return problem_in(Eigen::Vector4d(-100.0, -100.0, -100.0, -100.0),
                    Eigen::Vector4d(100.0, 100.0, 100.0, 100.0), [](const Eigen::VectorXd& x) {
                      Linearisation at{Eigen::MatrixXd(20, 4), Eigen::VectorXd(20)};
                      for (int i = 0; i < 20; ++i) {
                        const double t = (i + 1) / 5.0;
                        const double a = x(0) + t * x(1) - std::exp(t);
                        const double b = x(2) + x(3) * std::sin(t) - std::cos(t);
                        at.residual(i) = a * a + b * b;
                        at.jacobian.row(i) << 2.0 * a, 2.0 * a * t, 2.0 * b, 2.0 * b * std::sin(t);
                      }
                      return at;
                    });
}

/// Jennrich and Sampson: the cost is 62.1811 at x = y = 0.257825 (problem 6 in the same paper).
TestProblem jennrich_sampson() {
  return problem_in(Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, 1.0),
                    [](const Eigen::VectorXd& x) {
                      Linearisation at{Eigen::MatrixXd(10, 2), Eigen::VectorXd(10)};
                      for (int i = 0; i < 10; ++i) {
                        const double t = i + 1;
                        const double a = std::exp(t * x(0));
                        const double b = std::exp(t * x(1));
                        at.residual(i) = 2.0 + 2.0 * t - a - b;
                        at.jacobian.row(i) << -t * a, -t * b;
                      }
                      return at;
                    });
}

/// Rosenbrock's valley.
TestProblem curved_valley(double upper_y) {
  return problem_in(Eigen::Vector2d(-2.0, -2.0), Eigen::Vector2d(2.0, upper_y),
                    [](const Eigen::VectorXd& x) {
                      Linearisation at{Eigen::MatrixXd(2, 2),
                                       Eigen::Vector2d(10.0 * (x(1) - x(0) * x(0)), 1.0 - x(0))};
                      at.jacobian << -20.0 * x(0), 10.0, -1.0, 0.0;
                      return at;
                    });
}

int evaluations_of_ceres(TestProblem problem, std::vector<double> z) {
  DescentOptions options = problem.options();
  const auto n = z.size();
  descend(options, problem.at(problem.physical(z)).residual.size(), std::vector<bool>(n, false), z);
  return problem.evaluations;
}

}  // namespace

TEST_CASE("adaptive descent: large residuals, where Gauss-Newton creeps", "[calib]") {
  SECTION("Brown and Dennis") {
    TestProblem problem = brown_dennis();
    std::vector<double> z = problem.unit(Eigen::Vector4d(25.0, 5.0, -5.0, -1.0));
    const int by_ceres = evaluations_of_ceres(problem, z);
    CHECK(descend_adaptively(problem.options(), z).converged);
    CHECK(problem.cost(z) == Approx(0.5 * 85822.2016).epsilon(1e-8));
    CHECK(2 * problem.evaluations < by_ceres);
  }
  SECTION("Jennrich and Sampson") {
    TestProblem problem = jennrich_sampson();
    std::vector<double> z = problem.unit(Eigen::Vector2d(0.3, 0.4));
    CHECK(descend_adaptively(problem.options(), z).converged);
    CHECK(problem.cost(z) == Approx(0.5 * 124.362182).epsilon(1e-8));
    CHECK(problem.physical(z)(0) == Approx(0.257825).epsilon(1e-4));
  }
}

TEST_CASE("adaptive descent: where every step of Gauss and Newton is good but short", "[calib]") {
  // The residuals x + 1 and 0.95 x^2 + x - 1 (Dennis and Schnabel, Numerical Methods, example
  // 10.2.5): near the minimum at 0 a step of Gauss and Newton leaves 95 % of the way.
  TestProblem problem = problem_in(Eigen::VectorXd::Constant(1, -1.0),
                                   Eigen::VectorXd::Constant(1, 1.0), [](const Eigen::VectorXd& x) {
                                     Linearisation at{Eigen::MatrixXd(2, 1), Eigen::VectorXd(2)};
                                     at.residual << x(0) + 1.0, 0.95 * x(0) * x(0) + x(0) - 1.0;
                                     at.jacobian << 1.0, 1.9 * x(0) + 1.0;
                                     return at;
                                   });
  std::vector<double> z = problem.unit(Eigen::VectorXd::Constant(1, 0.1));
  CHECK(descend_adaptively(problem.options(), z).converged);
  CHECK(std::abs(problem.physical(z)(0)) < 1e-3);
  CHECK(problem.evaluations < 20);
}

TEST_CASE("adaptive descent: small residuals take no more evaluations than by Ceres", "[calib]") {
  TestProblem problem = curved_valley(2.0);
  std::vector<double> z = problem.unit(Eigen::Vector2d(-1.2, 1.0));
  const int by_ceres = evaluations_of_ceres(problem, z);
  CHECK(descend_adaptively(problem.options(), z).converged);
  CHECK((problem.physical(z) - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-6);
  CHECK(problem.evaluations <= by_ceres);
}

TEST_CASE("adaptive descent: bounds are met within a step, and left again", "[calib]") {
  // On the bound y = 0.25 the cost is (1 - x)^2 + 100 (0.25 - x^2)^2.
  TestProblem problem = curved_valley(0.25);
  std::vector<double> z = problem.unit(Eigen::Vector2d(-1.2, -1.0));
  CHECK(descend_adaptively(problem.options(), z).converged);
  CHECK(z[1] == 1.0);
  const double x = problem.physical(z)(0);
  CHECK(400.0 * x * (x * x - 0.25) == Approx(2.0 * (1.0 - x)).epsilon(1e-4));
  // A start on the bound, with the minimum inside.
  TestProblem free = curved_valley(2.0);
  z = free.unit(Eigen::Vector2d(-1.2, 2.0));
  CHECK(descend_adaptively(free.options(), z).converged);
  CHECK((free.physical(z) - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-6);
}

TEST_CASE("adaptive descent: from where the cost curves down", "[calib]") {
  // (2 - x^2)^2 / 2, starting at 0.01, and a second, independent unknown.
  TestProblem problem = problem_in(
      Eigen::Vector2d(-3.0, -3.0), Eigen::Vector2d(3.0, 3.0), [](const Eigen::VectorXd& x) {
        Linearisation at{Eigen::MatrixXd(2, 2), Eigen::Vector2d(2.0 - x(0) * x(0), x(1) - 1.0)};
        at.jacobian << -2.0 * x(0), 0.0, 0.0, 1.0;
        return at;
      });
  std::vector<double> z = problem.unit(Eigen::Vector2d(0.01, -2.0));
  CHECK(descend_adaptively(problem.options(), z).converged);
  CHECK(std::abs(problem.physical(z)(0)) == Approx(std::sqrt(2.0)).epsilon(1e-6));
  CHECK(problem.physical(z)(1) == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("adaptive descent: an unknown without effect stays where it is", "[calib]") {
  TestProblem problem = problem_in(
      Eigen::Vector2d(-3.0, -3.0), Eigen::Vector2d(3.0, 3.0), [](const Eigen::VectorXd& x) {
        Linearisation at{Eigen::MatrixXd::Zero(2, 2), Eigen::Vector2d(std::exp(x(0)) - 2.0, 5.0)};
        at.jacobian(0, 0) = std::exp(x(0));
        return at;
      });
  std::vector<double> z = problem.unit(Eigen::Vector2d(-1.0, 0.5));
  const double before = z[1];
  CHECK(descend_adaptively(problem.options(), z).converged);
  CHECK(problem.physical(z)(0) == Approx(std::log(2.0)));
  CHECK(z[1] == before);
}

TEST_CASE("adaptive descent: ends where it is told to, or cannot go on", "[calib]") {
  TestProblem problem = curved_valley(2.0);
  const std::vector<double> start = problem.unit(Eigen::Vector2d(-1.2, 1.0));
  std::vector<double> z = start;
  DescentOptions options = problem.options();
  int told = 0;
  options.enough = [&](const DescentStep& step) {
    CHECK(step.number == told++);
    return step.number == 3;
  };
  const Descent stopped = descend_adaptively(options, z);
  CHECK_FALSE(stopped.converged);
  CHECK(stopped.iterations == 3);
  CHECK(problem.evaluations == 4);
  CHECK(problem.cost(z) < problem.cost(start));

  z = start;
  options = problem.options();
  options.most_iterations = 2;
  const Descent cut_short = descend_adaptively(options, z);
  CHECK_FALSE(cut_short.converged);
  CHECK(cut_short.iterations == 2);
  CHECK(cut_short.failure.empty());

  // No point close to the start can be evaluated.
  z = start;
  options = problem.options();
  const auto whole = options.linearise;
  options.linearise = [&](std::span<const double> at, bool jacobian) {
    return std::vector(at.begin(), at.end()) == start ? whole(at, jacobian) : std::nullopt;
  };
  const Descent alone = descend_adaptively(options, z);
  CHECK_FALSE(alone.converged);
  CHECK_THAT(alone.failure, Catch::Contains("gave up"));
  CHECK(z == start);

  options.linearise = [](std::span<const double>, bool) { return std::nullopt; };
  CHECK_THAT(descend_adaptively(options, z).failure, Catch::Contains("gave up"));
}

TEST_CASE("adaptive descent: goes round what cannot be evaluated", "[calib]") {
  TestProblem problem = curved_valley(2.0);
  std::vector<double> z = problem.unit(Eigen::Vector2d(-1.2, 1.0));
  DescentOptions options = problem.options();
  const auto whole = options.linearise;
  options.linearise = [&](std::span<const double> at, bool jacobian) {
    const Eigen::VectorXd x = problem.physical(at);
    return x(1) < x(0) * x(0) - 0.5 ? std::nullopt : whole(at, jacobian);
  };
  CHECK(descend_adaptively(options, z).converged);
  CHECK((problem.physical(z) - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-6);
}

TEST_CASE("adaptive descent: what is thrown comes out", "[calib]") {
  TestProblem problem = curved_valley(2.0);
  std::vector<double> z = problem.unit(Eigen::Vector2d(-1.2, 1.0));
  DescentOptions options = problem.options();
  options.enough = [](const DescentStep& step) {
    if (step.number == 2) throw std::runtime_error("no more");
    return false;
  };
  CHECK_THROWS_WITH(descend_adaptively(options, z), "no more");
}

}  // namespace rigcal::calib
