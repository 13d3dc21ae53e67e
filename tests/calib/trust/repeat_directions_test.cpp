#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "calib/trust/between_repeats.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "metrics/distributions.hpp"
#include "tests/calib/twin.hpp"

// Deviations of repeats along one direction, compared with hand calculations.

namespace rigcal::calib {
namespace {

using Catch::WithinRel;
using datasets::Channel;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t kSamples = 40;  // twenty intervals of two samples each

/// One condition whose mean rises by 3 m/s, with given deviations of its repeats.
struct Ramp {
  Twin twin;
  std::vector<datasets::Record> records;

  explicit Ramp(const std::vector<std::vector<double>>& deviations) {
    twin.free("mass", 80.0, 10.0, 500.0);
    twin.add("square", datasets::Waveform::square, 2.0, 0.01);
    records = twin.records(kSamples, 500.0, 1);
    datasets::Series& series = records[0].channels[Channel::position];
    for (std::size_t i = 0; i < kSamples; ++i) series.mean[i] = 3.0 * records[0].time_s[i];
    series.deviations = deviations;
  }
  Problem problem() const { return problem_of(twin, records); }
  double start_by_noise() const {
    const Problem of = problem();
    const std::vector<double> z = of.start();
    CauseEffects effects(of, z);
    return difference_by_noise(effects, "start");
  }
};

/// Returns two repeats with deviations +-(common + ripple); the sign of the ripple changes every
/// two samples.
std::vector<std::vector<double>> two_repeats(double common, double ripple) {
  std::vector<std::vector<double>> result(2);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double value = common + ((i / 2) % 2 == 0 ? ripple : -ripple);
    result[0].push_back(value);
    result[1].push_back(-value);
  }
  return result;
}

}  // namespace

TEST_CASE("difference by noise: nineteen degrees of freedom of twenty stretches", "[calib]") {
  // Along a constant direction of length 1 the sum of squares is 2 * 40 * common^2. Each interval
  // has a noise of (2 ripple)^2 / 40. Twenty intervals in two repeats give 4 ripple^2, with
  // nineteen degrees of freedom.
  for (const double common : {0.2, 0.5, 1.0, 2.0}) {
    CAPTURE(common);
    const double ratio = 2.0 * 40.0 * common * common / (20.0 / 19.0 * 4.0);
    CHECK_THAT(Ramp(two_repeats(1e-5 * common, 1e-5)).start_by_noise(),
               WithinRel(metrics::fisher_f_exceedance(ratio, 1.0, 19.0), 1e-6));
  }
}

TEST_CASE("difference by noise: nothing is said of repeats that are equal, or of one", "[calib]") {
  CHECK(Ramp(two_repeats(0.0, 0.0)).start_by_noise() == 1.0);
  CHECK(Ramp({two_repeats(1e-5, 1e-5)[0]}).start_by_noise() == 1.0);
  CHECK(Ramp({}).start_by_noise() == 1.0);
}

TEST_CASE("explained_by_declared: a repeat is as many times noisier as their mean", "[calib]") {
  Ramp ramp(two_repeats(1e-5, 1e-5));
  datasets::ParameterSetting& supply = ramp.twin.setting("mass");
  supply.prior = datasets::Prior{80.0, 2.0};
  supply.between_repeats = true;
  const Problem problem = ramp.problem();
  const std::vector<double> z = problem.start();
  MatrixXd felt = known_sensitivities(problem, 0, z, {Twin::index("mass")});
  REQUIRE(felt.cols() == 1);
  felt *= 2.0;
  const double square = felt.squaredNorm();
  REQUIRE(square > 0.0);
  MatrixXd deviations(felt.rows(), 3);
  deviations << felt, -2.0 * felt, 0.5 * felt;
  const MatrixXd explained = explained_by_declared(problem, 0, z, deviations);
  REQUIRE(explained.cols() == 3);
  // Ridge regression explains the fraction F / (F + repeats) along this direction.
  CHECK_THAT(explained.col(1).norm() / deviations.col(1).norm(),
             WithinRel(square / (square + 3.0), 1e-9));
  CHECK((explained.array() * deviations.array()).minCoeff() >= 0.0);
  CHECK(explained_by_declared(problem, 0, z, MatrixXd()).size() == 0);
  supply.between_repeats = false;
  CHECK(explained_by_declared(problem, 0, z, deviations).size() == 0);
}

TEST_CASE("repeat_deviations: weighted, what is missing as nothing", "[calib]") {
  auto deviations = two_repeats(1e-5, 2e-6);
  deviations[0][3] = std::nan("");
  const Ramp ramp(deviations);
  const Problem problem = ramp.problem();
  const double sd = problem.conditions[0].channels[0].sd;
  const MatrixXd found = repeat_deviations(problem.conditions[0], {});
  REQUIRE(found.rows() == static_cast<Index>(kSamples));
  REQUIRE(found.cols() == 2);
  CHECK_THAT(found(0, 0), WithinRel(1.2e-5 / sd, 1e-12));
  CHECK_THAT(found(2, 1), WithinRel(-0.8e-5 / sd, 1e-12));
  CHECK(found(3, 0) == 0.0);
  // The component explained by recorded inputs is subtracted, provided that it has a column for
  // each repeat.
  const MatrixXd half = 0.5 * found;
  CHECK((repeat_deviations(problem.conditions[0], half) - half).norm() < 1e-12);
  CHECK((repeat_deviations(problem.conditions[0], half.leftCols(1)) - found).norm() < 1e-12);
}

TEST_CASE("repeat_scores: about their mean", "[calib]") {
  const MatrixXd jacobian = MatrixXd::Identity(2, 2);
  MatrixXd deviations(2, 3);
  deviations << 1.0, 2.0, 6.0, -1.0, 0.0, 1.0;
  const MatrixXd scores = repeat_scores(jacobian, deviations);
  MatrixXd expected(2, 3);
  expected << -2.0, -1.0, 3.0, -1.0, 0.0, 1.0;
  CHECK((scores - expected).norm() < 1e-12);
  CHECK(repeat_scores(jacobian, MatrixXd(2, 0)).size() == 0);
}

TEST_CASE("exceedance: of nothing known it is certain", "[calib]") {
  CHECK(exceedance({1.0, 0.0}, {1.0, 20.0, 0.0}) == 1.0);
  CHECK(exceedance({1.0, 3.0}, {0.0, 20.0, 0.0}) == 1.0);
  CHECK_THAT(exceedance({3.0, 3.0}, {1.5, 20.0, 0.0}),
             WithinRel(metrics::fisher_f_exceedance(2.0, 3.0, 20.0), 1e-12));
}

}  // namespace rigcal::calib
