#include "calib/posterior/effect_step.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSizeDraws = 40000;

double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * M_PI); }

}  // namespace

TEST_CASE("effect step: a truncated normal has its closed moments", "[calib]") {
  auto stream = datasets::random_stream(3, {"truncated"});
  const double sd = 2.0;
  for (const double centre : {1.5, 0.0, -1.0, -8.0}) {
    CAPTURE(centre);
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < kSizeDraws; ++i) {
      const double x = positive_normal(stream, sd * centre, sd);
      REQUIRE(x >= 0.0);
      sum += x;
      squares += x * x;
    }
    // Mills' ratio gives the mean, and the mean gives the mean square.
    const double mills = normal_density(centre) / metrics::normal_cdf(centre);
    const double mean = sd * (centre + mills);
    const double square = sd * sd + sd * centre * mean;
    const double deviation = std::sqrt(square - mean * mean);
    CHECK_THAT(sum / kSizeDraws, WithinAbs(mean, 4.0 * deviation / std::sqrt(kSizeDraws)));
    CHECK_THAT(squares / kSizeDraws, WithinRel(square, 0.03));
  }
}

TEST_CASE("effect step: sweeps draw from their distribution", "[calib]") {
  SizesBeside sizes;
  sizes.precision.resize(2, 2);
  sizes.precision << 2.0, -1.2, -1.2, 3.0;
  sizes.slope = VectorXd::Constant(2, 0.7);
  const MatrixXd covariance = sizes.precision.inverse();
  const VectorXd mean = covariance * sizes.slope;
  auto stream = datasets::random_stream(4, {"sweeps"});
  VectorXd e = VectorXd::Zero(2);

  sizes.one_sided = {false, false};
  VectorXd sum = VectorXd::Zero(2);
  MatrixXd squares = MatrixXd::Zero(2, 2);
  for (int i = 0; i < kSizeDraws; ++i) {
    sweep_sizes(sizes, 3, stream, e);
    sum += e;
    squares += (e - mean) * (e - mean).transpose();
  }
  for (Eigen::Index k = 0; k < 2; ++k) {
    CHECK_THAT(sum(k) / kSizeDraws, WithinAbs(mean(k), 0.02));
    for (Eigen::Index l = 0; l < 2; ++l)
      CHECK_THAT(squares(k, l) / kSizeDraws, WithinAbs(covariance(k, l), 0.02));
  }

  // Truncated at zero, the density at two points has the ratio of the plain one: compare how many
  // draws fall into two small boxes.
  sizes.one_sided = {true, true};
  const auto log_density = [&](double a, double b) {
    const VectorXd x = (VectorXd(2) << a, b).finished();
    return sizes.slope.dot(x) - 0.5 * x.dot(sizes.precision * x);
  };
  e.setOnes();
  int low = 0;
  int high = 0;
  for (int i = 0; i < 5 * kSizeDraws; ++i) {
    sweep_sizes(sizes, 1, stream, e);
    REQUIRE(e.minCoeff() >= 0.0);
    low += e(0) < 0.2 && e(1) < 0.2 ? 1 : 0;
    high += std::abs(e(0) - 0.7) < 0.1 && std::abs(e(1) - 0.6) < 0.1 ? 1 : 0;
  }
  CHECK_THAT(static_cast<double>(high) / low,
             WithinRel(std::exp(log_density(0.7, 0.6) - log_density(0.1, 0.1)), 0.08));
}

}  // namespace rigcal::calib
