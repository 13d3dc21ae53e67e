#include "calib/consider/truncated_normal.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;

NormalMoments normal(double mean, double variance) {
  return {Eigen::VectorXd::Constant(1, mean), Eigen::MatrixXd::Constant(1, 1, variance)};
}

TEST_CASE("truncated normal: half a normal distribution", "[calib]") {
  const auto half = cut_at_zero(normal(0.0, 4.0), {0});
  CHECK_THAT(half.mean(0), WithinRel(2.0 * std::sqrt(2.0 / std::numbers::pi), 1e-9));
  CHECK_THAT(half.covariance(0, 0), WithinRel(4.0 * (1.0 - 2.0 / std::numbers::pi), 1e-9));
}

TEST_CASE("truncated normal: far inside nothing is cut off, far outside the edge is left",
          "[calib]") {
  const auto inside = cut_at_zero(normal(10.0, 1.0), {0});
  CHECK_THAT(inside.mean(0), WithinRel(10.0, 1e-9));
  CHECK_THAT(inside.covariance(0, 0), WithinRel(1.0, 1e-9));
  // The tail beyond a is approximately exponential with mean 1 / a.
  const auto outside = cut_at_zero(normal(-30.0, 1.0), {0});
  CHECK_THAT(outside.mean(0), WithinRel(1.0 / 30.0, 0.01));
  CHECK_THAT(outside.covariance(0, 0), WithinRel(1.0 / 900.0, 0.01));
}

TEST_CASE("truncated normal: what is correlated with a cut component moves with it", "[calib]") {
  NormalMoments pair{Eigen::Vector2d(0.5, -1.0), Eigen::Matrix2d()};
  pair.covariance << 1.0, 0.6, 0.6, 2.0;
  const auto cut = cut_at_zero(pair, {0});
  // The second is 0.6 times the first, plus a remainder that is independent of it.
  const auto first = cut_at_zero(normal(0.5, 1.0), {0});
  CHECK_THAT(cut.mean(1), WithinRel(-1.0 + 0.6 * (first.mean(0) - 0.5), 1e-9));
  CHECK_THAT(cut.covariance(1, 1), WithinRel(2.0 - 0.36 + 0.36 * first.covariance(0, 0), 1e-9));
}

TEST_CASE("truncated normal: two correlated constraints, against draws", "[calib]") {
  NormalMoments pair{Eigen::Vector2d(0.3, -0.2), Eigen::Matrix2d()};
  pair.covariance << 1.0, -0.7, -0.7, 1.0;
  const auto cut = cut_at_zero(pair, {0, 1});
  boost::random::mt19937_64 stream(1);
  boost::random::normal_distribution<double> draw;
  double sum = 0.0;
  double squares = 0.0;
  int kept = 0;
  for (int i = 0; i < 400'000; ++i) {
    const double a = draw(stream);
    const double b = draw(stream);
    const double x = 0.3 + a;
    const double y = -0.2 - 0.7 * a + std::sqrt(1.0 - 0.49) * b;
    if (x < 0.0 || y < 0.0) continue;
    sum += x;
    squares += x * x;
    ++kept;
  }
  const double mean = sum / kept;
  // The moments under two constraints are approximate.
  CHECK_THAT(cut.mean(0), WithinRel(mean, 0.03));
  CHECK_THAT(cut.covariance(0, 0), WithinRel(squares / kept - mean * mean, 0.1));
}

TEST_CASE("truncated normal: no mean below zero, however far out and correlated", "[calib]") {
  const Eigen::Index count = 6;
  boost::random::mt19937_64 stream(3);
  boost::random::normal_distribution<double> draw;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::MatrixXd factor(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j) factor(i, j) = draw(stream);
    // Precisions from 1e-3 to 1e9 in different directions, and means up to 1e4 below zero.
    NormalMoments many{Eigen::VectorXd(count), Eigen::MatrixXd()};
    Eigen::VectorXd sd(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      many.mean(i) = -std::pow(10.0, 2.0 * draw(stream));
      sd(i) = std::pow(10.0, 2.0 * draw(stream));
    }
    many.covariance = sd.asDiagonal() * (factor * factor.transpose()) * sd.asDiagonal();
    const auto cut = cut_at_zero(many, {0, 1, 2, 3, 4, 5});
    INFO("trial " << trial << ": " << cut.mean.transpose());
    CHECK((cut.mean.array() >= 0.0).all());
  }
}

}  // namespace
}  // namespace rigcal::calib
