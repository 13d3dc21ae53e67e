#include "calib/descent/box_step.hpp"

#include <Eigen/Cholesky>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>

namespace rigcal::calib {
namespace {

StepLimits wide(Eigen::Index n, double radius) {
  return {Eigen::VectorXd::Constant(n, -1e3), Eigen::VectorXd::Constant(n, 1e3),
          Eigen::VectorXd::Ones(n), radius};
}

bool within(const StepLimits& limits, const Eigen::VectorXd& step) {
  return (step - limits.lower).minCoeff() >= 0.0 && (limits.upper - step).minCoeff() >= 0.0 &&
         limits.scale.cwiseProduct(step).norm() <= limits.radius * (1.0 + 1e-6);
}

}  // namespace

TEST_CASE("box_step: a short step is Newton's", "[calib]") {
  const QuadraticModel model{(Eigen::Matrix2d() << 2.0, 0.5, 0.5, 1.0).finished(),
                             Eigen::Vector2d(-1.0, 0.3)};
  const BoxStep found = box_step(model, wide(2, 10.0));
  CHECK((model.hessian * found.step + model.gradient).norm() < 1e-12);
  CHECK_FALSE(found.at_radius);
  CHECK(found.fall == Approx(0.5 * -model.gradient.dot(found.step)));
}

TEST_CASE("box_step: a long one ends on the trust region, where nothing is lower", "[calib]") {
  const QuadraticModel model{(Eigen::Matrix2d() << 2.0, 0.5, 0.5, 0.01).finished(),
                             Eigen::Vector2d(-1.0, 0.3)};
  StepLimits limits = wide(2, 0.7);
  limits.scale << 3.0, 0.2;
  const BoxStep found = box_step(model, limits);
  CHECK(found.at_radius);
  CHECK(limits.scale.cwiseProduct(found.step).norm() == Approx(0.7).epsilon(1e-6));
  for (int k = 0; k < 3600; ++k) {
    const double angle = k * M_PI / 1800.0;
    const Eigen::Vector2d other(0.7 / 3.0 * std::cos(angle), 0.7 / 0.2 * std::sin(angle));
    REQUIRE(model.fall(other) <= found.fall * (1.0 + 1e-9));
  }
}

TEST_CASE("box_step: negative curvature is followed, with a gradient along it or without",
          "[calib]") {
  const double slope = GENERATE(0.0, 1e-12, 0.1);
  const QuadraticModel model{Eigen::Vector2d(-2.0, 4.0).asDiagonal(), Eigen::Vector2d(slope, 1.0)};
  const BoxStep found = box_step(model, wide(2, 1.0));
  CHECK(found.at_radius);
  CHECK(found.step.norm() == Approx(1.0).epsilon(1e-6));
  // Without a gradient along the negative curvature, the decrease on the unit circle is 1 - 3 y^2 -
  // y. It is largest at y = -1 / 6, where both components have the multiplier 2.
  if (slope < 0.01) CHECK(found.fall == Approx(1.0 + 1.0 / 12.0).epsilon(1e-6));
  for (int k = 0; k < 3600; ++k) {
    const double angle = k * M_PI / 1800.0;
    REQUIRE(model.fall(Eigen::Vector2d(std::cos(angle), std::sin(angle))) <=
            found.fall * (1.0 + 1e-9));
  }
}

TEST_CASE("box_step: a direction without curvature or gradient is left alone", "[calib]") {
  const Eigen::RowVector2d row(1.0, 1.0);  // the data determine only the sum
  const QuadraticModel model{row.transpose() * row, Eigen::Vector2d(-1.0, -1.0)};
  const BoxStep found = box_step(model, wide(2, 10.0));
  CHECK(found.step(0) == Approx(0.5));
  CHECK(found.step(1) == Approx(0.5));
}

TEST_CASE("box_step: an unknown at its bound stays there, or is drawn back inside", "[calib]") {
  StepLimits limits = wide(2, 10.0);
  limits.lower(0) = 0.0;
  QuadraticModel model{Eigen::Matrix2d::Identity(), Eigen::Vector2d(0.5, -1.0)};
  CHECK(box_step(model, limits).step(0) == 0.0);
  CHECK(box_step(model, limits).step(1) == Approx(1.0));
  // The step in the other unknown reverses the sign of the slope: -0.8 * 1 + 0.5 < 0.
  model.hessian.blocks.shared(0, 1) = model.hessian.blocks.shared(1, 0) = -0.8;
  const BoxStep found = box_step(model, limits);
  CHECK((model.hessian * found.step + model.gradient).norm() < 1e-12);
  CHECK(found.step(0) > 0.0);
}

TEST_CASE("box_step: within the box it is the least of a convex model", "[calib]") {
  boost::random::mt19937_64 random(7);
  boost::random::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&] { return uniform(random); };
  int at_bounds = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(3, 3, draw);
    const QuadraticModel model{root.transpose() * root + 0.01 * Eigen::Matrix3d::Identity(),
                               Eigen::VectorXd::NullaryExpr(3, draw)};
    StepLimits limits = wide(3, 100.0);
    limits.lower = Eigen::VectorXd::NullaryExpr(3, [&] { return std::min(0.0, draw()); });
    limits.upper = Eigen::VectorXd::NullaryExpr(3, [&] { return std::max(0.0, draw()); });
    const BoxStep found = box_step(model, limits);
    REQUIRE(within(limits, found.step));
    // Coordinate descent finds the minimum of a convex function in a box.
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int sweep = 0; sweep < 3000; ++sweep) {
      for (int j = 0; j < 3; ++j) {
        const double slope = model.gradient(j) + model.hessian.blocks.shared.row(j).dot(x);
        x(j) = std::clamp(x(j) - slope / model.hessian.blocks.shared(j, j), limits.lower(j),
                          limits.upper(j));
      }
    }
    at_bounds += (x - limits.lower).minCoeff() == 0.0 || (limits.upper - x).minCoeff() == 0.0;
    REQUIRE(found.fall == Approx(model.fall(x)).epsilon(1e-6).margin(1e-12));
  }
  CHECK(at_bounds > 100);
}

TEST_CASE("box_step: what is indefinite never leads up, nor out", "[calib]") {
  boost::random::mt19937_64 random(8);
  boost::random::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&] { return uniform(random); };
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(5, 5, draw);
    const QuadraticModel model{half + half.transpose(), Eigen::VectorXd::NullaryExpr(5, draw)};
    StepLimits limits = wide(5, 0.5 + std::abs(draw()));
    limits.scale = Eigen::VectorXd::NullaryExpr(5, [&] { return 0.1 + std::abs(draw()); });
    limits.lower = Eigen::VectorXd::NullaryExpr(5, [&] { return std::min(0.0, draw()); });
    limits.upper = Eigen::VectorXd::NullaryExpr(5, [&] { return std::max(0.0, draw()); });
    const BoxStep found = box_step(model, limits);
    REQUIRE(within(limits, found.step));
    REQUIRE(found.fall >= 0.0);
    REQUIRE(found.fall == model.fall(found.step));
  }
}

}  // namespace rigcal::calib
