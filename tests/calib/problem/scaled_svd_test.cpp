#include "calib/problem/scaled_svd.hpp"

#include <catch2/catch.hpp>

using rigcal::calib::ScaledSvd;

TEST_CASE("scaled_svd: the step of least squares, whatever the units of the columns", "[calib]") {
  // Straight line through (0, 1), (1, 3), (2, 5), (3, 8): intercept 0.8, slope 2.3.
  Eigen::MatrixXd jacobian(4, 2);
  jacobian << 1.0, 0.0, 1.0, 1e9, 1.0, 2e9, 1.0, 3e9;
  const Eigen::Vector4d residual(-1.0, -3.0, -5.0, -8.0);
  const ScaledSvd svd(jacobian, 1e-8);
  REQUIRE(svd.rank() == 2);
  const Eigen::VectorXd step = svd.step(residual);
  CHECK(step(0) == Approx(0.8).epsilon(1e-12));
  CHECK(step(1) == Approx(2.3e-9).epsilon(1e-12));
  CHECK(svd.explained(residual).squaredNorm() ==
        Approx(residual.squaredNorm() - (residual + jacobian * step).squaredNorm()).epsilon(1e-12));
  // (J^T J)^-1 for a straight line: 0.7, -0.3, 0.2.
  const Eigen::MatrixXd inverse = svd.root() * svd.root().transpose();
  CHECK(inverse(0, 0) == Approx(0.7).epsilon(1e-12));
  CHECK(inverse(0, 1) == Approx(-0.3e-9).epsilon(1e-12));
  CHECK(inverse(1, 1) == Approx(0.2e-18).epsilon(1e-12));
}

TEST_CASE("scaled_svd: what a Jacobian does not determine stays where it is", "[calib]") {
  Eigen::MatrixXd jacobian(3, 3);
  jacobian << 1.0, 2.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0;  // the second column is twice the first
  const Eigen::Vector3d residual(-4.0, -4.0, -4.0);
  const ScaledSvd svd(jacobian, 1e-8);
  CHECK(svd.rank() == 1);
  CHECK(svd.inverse_lengths()(2) == 0.0);
  const Eigen::VectorXd step = svd.step(residual);
  CHECK((residual + jacobian * step).norm() < 1e-12);
  CHECK(step(0) == Approx(2.0).epsilon(1e-12));  // the shortest step for columns of length 1
  CHECK(step(1) == Approx(1.0).epsilon(1e-12));
  CHECK(step(2) == 0.0);
  CHECK(ScaledSvd(Eigen::MatrixXd::Zero(3, 2), 1e-8).rank() == 0);
}
