#include "diagnosis/record/phase_clusters.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal;
using namespace rigcal::diagnosis;
using Catch::WithinRel;

TEST_CASE("cluster_sandwich: one mean of two clusters", "[diagnosis]") {
  // The scores 2 and -2 each change a mean of four by 1/2. Two clusters minus one unknown give a
  // factor of 2.
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Ones(4, 1);
  const Eigen::VectorXd residual = (Eigen::VectorXd(4) << 1.0, 1.0, -1.0, -1.0).finished();
  const Eigen::MatrixXd bread = Eigen::MatrixXd::Constant(1, 1, 0.25);
  const auto [covariance, freedom] = cluster_sandwich(jacobian, residual, bread, {0, 0, 1, 1});
  CHECK(freedom == 1);
  CHECK_THAT(covariance(0, 0), WithinRel(2.0 * (0.25 + 0.25), 1e-12));
}

TEST_CASE("cluster_sandwich: a cluster each is White's covariance times n / (n - p)",
          "[diagnosis]") {
  // For a mean of ten with residuals +-a, the sum of squares 10 a^2 / 100 times 10 / 9 is the
  // squared error of a mean, s^2 / 10 with s^2 = 10 a^2 / 9.
  constexpr double kA = 0.3;
  Eigen::VectorXd residual(10);
  std::vector<int> clusters;
  for (int i = 0; i < 10; ++i) {
    residual(i) = i % 2 == 0 ? kA : -kA;
    clusters.push_back(i);
  }
  const auto [covariance, freedom] = cluster_sandwich(
      Eigen::MatrixXd::Ones(10, 1), residual, Eigen::MatrixXd::Constant(1, 1, 0.1), clusters);
  CHECK(freedom == 9);
  CHECK_THAT(covariance(0, 0), WithinRel(kA * kA / 9.0, 1e-12));
}

TEST_CASE("cluster_sandwich: channels of one sample fall into one cluster", "[diagnosis]") {
  // There are two samples of two channels. Each cluster sums its sample over both channels: 3 and
  // -3.
  const Eigen::VectorXd residual = (Eigen::VectorXd(4) << 1.0, -1.0, 2.0, -2.0).finished();
  const auto [covariance, freedom] = cluster_sandwich(
      Eigen::MatrixXd::Ones(4, 1), residual, Eigen::MatrixXd::Constant(1, 1, 0.25), {3, 7});
  CHECK(freedom == 1);
  CHECK_THAT(covariance(0, 0), WithinRel(2.0 * 2.0 * 0.75 * 0.75, 1e-12));
}

TEST_CASE("clusters_of: by phase where there is a period, else by place", "[diagnosis]") {
  datasets::Condition condition;
  datasets::Record record;
  calib::ProblemCondition prepared;
  prepared.condition = &condition;
  prepared.record = &record;
  for (std::size_t i = 0; i < 40; ++i) {
    record.time_s.push_back((static_cast<double>(i) + 0.5) / 20.0);  // two periods of 1 Hz
    prepared.rows.push_back(i);
  }
  condition.waveform = datasets::Waveform::sine;
  condition.frequency_hz = 1.0;
  const auto by_phase = clusters_of(prepared);
  CHECK(by_phase[0] == 0);
  CHECK(by_phase[19] == 9);
  CHECK(by_phase[20] == 0);
  CHECK(by_phase[23] == by_phase[3]);
  condition.waveform = datasets::Waveform::recorded;
  const auto by_place = clusters_of(prepared);
  CHECK(by_place[3] == 0);
  CHECK(by_place[4] == 1);
  CHECK(by_place[39] == 9);
}
