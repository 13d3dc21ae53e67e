#include "diagnosis/parity/common_causes.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal;

namespace {

constexpr Eigen::Index kSamples = 1000;
constexpr Eigen::Index kRecords = 5;

/// Records of unit noise plus a sine whose amplitude varies between them, each minus the mean of
/// the others.
Eigen::MatrixXd residuals_with(double cause, std::uint64_t seed) {
  boost::random::mt19937_64 stream(seed);
  boost::random::normal_distribution<double> normal;
  Eigen::MatrixXd records(kSamples, kRecords);
  for (Eigen::Index j = 0; j < kRecords; ++j) {
    const double amplitude = cause * normal(stream);
    for (Eigen::Index i = 0; i < kSamples; ++i)
      records(i, j) = normal(stream) + amplitude * std::sin(0.01 * static_cast<double>(i));
  }
  const Eigen::VectorXd sum = records.rowwise().sum();
  Eigen::MatrixXd residuals(kSamples, kRecords);
  for (Eigen::Index j = 0; j < kRecords; ++j)
    residuals.col(j) = records.col(j) - (sum - records.col(j)) / (kRecords - 1.0);
  return residuals;
}

}  // namespace

TEST_CASE("common_causes: noise has none, a sine that differs is one", "[diagnosis]") {
  int in_noise = 0;
  int found = 0;
  double power = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    in_noise += diagnosis::common_causes(residuals_with(0.0, seed)).patterns.cols() > 0 ? 1 : 0;
    const auto causes = diagnosis::common_causes(residuals_with(1.5, seed));
    found += causes.patterns.cols() == 1 ? 1 : 0;
    if (causes.patterns.cols() > 0)
      power += causes.patterns.col(0).squaredNorm() / kSamples / 100.0;
    // The rest has the variance of noise minus the mean of the others: 1 + 1/4.
    CHECK(causes.rest.squaredNorm() / (kSamples * kRecords) > 0.9);
    CHECK(causes.rest.squaredNorm() / (kSamples * kRecords) < 1.7);
  }
  CHECK(in_noise <= 12);
  CHECK(found >= 90);
  // The power is 1.5^2 / 2. The limits allow for four degrees of freedom in each of a hundred
  // trials.
  CHECK(power > 0.85);
  CHECK(power < 1.45);
}
