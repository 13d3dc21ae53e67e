#include "calib/trust/sandwich.hpp"

#include <Eigen/Cholesky>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/sanitized.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A linear model in orthonormal coordinates whose columns oscillate slowly, like those of a rig.
MatrixXd slow_model(Index samples) {
  MatrixXd columns(samples, 3);
  for (Index t = 0; t < samples; ++t) {
    const double phase = 12.0 * static_cast<double>(t) / static_cast<double>(samples);
    columns.row(t) << std::sin(phase), 1.0, std::cos(phase) * (1.0 + phase);
  }
  const MatrixXd factor = MatrixXd((columns.transpose() * columns).llt().matrixL());
  return factor.triangularView<Eigen::Lower>().solve(columns.transpose()).transpose();
}

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  VectorXd draw(Index samples, double rho, double jump_at = 2.0) {
    VectorXd noise(samples);
    double state = normal_(random_);
    for (Index t = 0; t < samples; ++t) {
      const bool louder = static_cast<double>(t) > jump_at * static_cast<double>(samples);
      noise(t) = state * (louder ? 4.0 : 1.0);
      state = rho * state + std::sqrt(1.0 - rho * rho) * normal_(random_);
    }
    return noise;
  }

 private:
  boost::random::mt19937_64 random_;
  boost::random::normal_distribution<double> normal_;
};

/// The number of draws is divided by this factor.
constexpr int kPart = test::kSanitized ? 4 : 1;
/// Fewer draws widen the limits on coverage by this factor.
const double kWider = std::sqrt(kPart);

/// Fraction of draws in which the 95 % interval of a direction includes the true value, 0. The
/// other fraction is for intervals that use Student's t without any other correction.
struct Coverage {
  double found = 0.0;
  double by_freedom = 0.0;
};

std::vector<Coverage> coverage_of_each(const MatrixXd& model, double rho, int draws,
                                       double jump_at = 2.0) {
  const MatrixXd none = MatrixXd::Zero(model.cols(), model.cols());
  Noise noise(11);
  std::vector<Coverage> covered(static_cast<std::size_t>(model.cols()));
  for (int draw = 0; draw < draws; ++draw) {
    const VectorXd measured = noise.draw(model.rows(), rho, jump_at);
    const VectorXd found = model.transpose() * measured;
    const MatrixXd each = MatrixXd::Identity(model.cols(), model.cols());
    const auto scatter = score_contributions({{model, measured - model * found, 1}}, none, each);
    for (Index j = 0; j < model.cols(); ++j) {
      const auto robust = robust_variance(scatter, none, each, j);
      const double error = std::abs(found(j)) / std::sqrt(robust.variance);
      Coverage& direction = covered[static_cast<std::size_t>(j)];
      direction.found += error <= robust.quantile() ? 1.0 / draws : 0.0;
      direction.by_freedom += error <= student_t(robust.freedom) ? 1.0 / draws : 0.0;
    }
  }
  return covered;
}

/// Returns the coverage for all directions together.
double coverage(const MatrixXd& model, double rho, int draws, double jump_at = 2.0) {
  double sum = 0.0;
  for (const Coverage& each : coverage_of_each(model, rho, draws, jump_at)) sum += each.found;
  return sum / static_cast<double>(model.cols());
}

/// The first of two columns is an oscillation that decays within a few samples.
MatrixXd brief_model(Index samples) {
  MatrixXd columns = MatrixXd::Zero(samples, 2);
  for (Index t = 0; t < samples; ++t) {
    const auto time = static_cast<double>(t);
    columns(t, 1) = std::sin(12.0 * time / static_cast<double>(samples));
    if (t < 100) columns(200 + t, 0) = std::exp(-time / 15.0) * std::sin(6.283 * time / 6.0 + 0.7);
  }
  const MatrixXd factor = MatrixXd((columns.transpose() * columns).llt().matrixL());
  return factor.triangularView<Eigen::Lower>().solve(columns.transpose()).transpose();
}

}  // namespace

TEST_CASE("sandwich: white noise gives the plain covariance", "[calib]") {
  const MatrixXd model = slow_model(4000);
  const VectorXd noise = Noise(2).draw(4000, 0.0);
  const VectorXd residual = noise - model * (model.transpose() * noise);
  const MatrixXd none = MatrixXd::Zero(3, 3);
  const auto scatter = score_contributions({{model, residual, 1}}, none, MatrixXd::Identity(3, 3));
  REQUIRE(scatter.size() == 1);
  // The standard deviation of a sum of 4000 squares is 2 %, and the kernel doubles it; the limit is
  // four times that.
  CHECK((scatter[0].covariance - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff() < 0.16);
  CHECK(scatter[0].noise.at(0).phi.empty());
  CHECK(scatter[0].independent_residuals == 4000.0);
  CHECK(scatter[0].freedom.minCoeff() > 500.0);
}

TEST_CASE("sandwich: rows of seven digits give the same covariance", "[calib]") {
  constexpr Index kSamples = 400;
  Noise noise(3);
  ScoreRows wide;
  wide.jacobian = slow_model(kSamples);
  wide.residual = noise.draw(kSamples, 0.5);
  wide.channels = 2;
  ScoreRows narrow = wide;
  narrow.make_narrow();
  CHECK(narrow.jacobian.size() == 0);
  CHECK((narrow.all_rows() - wide.jacobian).norm() < 1e-6 * wide.jacobian.norm());
  CHECK((narrow.rows(200, 50) - wide.jacobian.middleRows(200, 50)).norm() < 1e-6);
  const MatrixXd unit = MatrixXd::Identity(3, 3);
  const auto exact = score_contributions({wide}, MatrixXd::Zero(3, 3), unit);
  const auto found = score_contributions({narrow}, MatrixXd::Zero(3, 3), unit);
  CHECK((found[0].covariance - exact[0].covariance).norm() < 1e-5 * exact[0].covariance.norm());
}

TEST_CASE("sandwich: without the own part, and with directions that are combinations themselves",
          "[calib]") {
  constexpr Index kSamples = 400;
  ScoreRows rows;
  rows.jacobian = slow_model(kSamples);
  rows.residual = Noise(4).draw(kSamples, 0.7);
  rows.channels = 2;
  MatrixXd others(2, 3);
  others << 0.5, -1.0, 2.0, 3.0, 0.25, -0.75;
  MatrixXd all(5, 3);
  all << MatrixXd::Identity(3, 3), others;
  const MatrixXd none = MatrixXd::Zero(3, 3);
  const auto apart = score_contributions({rows}, none, others)[0];
  const auto together = score_contributions({rows}, none, all)[0];
  const auto left_out = score_contributions({rows}, none, all, 1, OwnPart::left_out)[0];
  CHECK((together.freedom.tail(2) - apart.freedom).norm() < 1e-12 * apart.freedom.norm());
  CHECK((together.own.tail(2) - apart.own).norm() < 1e-12 * apart.own.norm());
  CHECK(left_out.own.size() == 0);
  CHECK(left_out.freedom == together.freedom);
  CHECK(left_out.covariance == together.covariance);
}

TEST_CASE("sandwich: intervals cover under white, correlated and uneven noise", "[calib]") {
  const MatrixXd model = slow_model(1500);
  // If the directions are independent, the coverage of 600 intervals at 95 % has a binomial
  // standard deviation of 0.9 %; the limit is 3.5 times that.
  CHECK_THAT(coverage(model, 0.0, 200 / kPart), WithinAbs(0.95, 0.031 * kWider));
  // 38 effective samples determine their own correlation only to within a fifth, so that t is not
  // exact.
  CHECK_THAT(coverage(model, 0.95, 200 / kPart), WithinAbs(0.95, 0.035 * kWider));
  CHECK_THAT(coverage(model, 0.0, 200 / kPart, 0.8), WithinAbs(0.95, 0.031 * kWider));
}

TEST_CASE("sandwich: what a few correlated samples tell is covered no more than it should be",
          "[calib]") {
  const auto covered = coverage_of_each(brief_model(1500), 0.95, 1000 / kPart);
  // With 1000 draws, a coverage of 95 % has a binomial standard deviation of 0.7 %; the limit is
  // 3.5 times that. If few samples matter, their residuals contain their own error, so that
  // Student's t alone covers more.
  CHECK_THAT(covered[0].found, WithinAbs(0.95, 0.025 * kWider));
  CHECK(covered[0].by_freedom > 0.98);
  CHECK_THAT(covered[1].found, WithinAbs(0.95, 0.035 * kWider));
  // If least squares is the best estimator, its residuals are independent of its error.
  const MatrixXd model = brief_model(1500);
  const VectorXd noise = Noise(4).draw(1500, 0.0);
  const VectorXd residual = noise - model * (model.transpose() * noise);
  const MatrixXd none = MatrixXd::Zero(2, 2);
  const MatrixXd each = MatrixXd::Identity(2, 2);
  const auto scatter = score_contributions({{model, residual, 1}}, none, each);
  CHECK(scatter[0].own.cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("sandwich: half width of the interval", "[calib]") {
  RobustVariance robust{1.0, 10.0, 0.0};
  CHECK_THAT(robust.quantile(), WithinRel(student_t(10.0), 1e-12));
  // Three squares that include the error: |sum| / root(sum of squares) is root 3 times the cosine
  // of the angle to a fixed direction in space, which is uniform for normal numbers.
  robust = {1.0, 3.0, 1.0 / 3.0};
  CHECK_THAT(robust.quantile(), WithinRel(0.95 * std::sqrt(3.0), 1e-9));
  robust = {1.0, std::numeric_limits<double>::infinity(), 0.0};
  CHECK_THAT(robust.quantile(), WithinRel(1.959964, 1e-6));
}

TEST_CASE("sandwich: two channels with the same noise count once", "[calib]") {
  const MatrixXd half = slow_model(2000) / std::sqrt(2.0);
  MatrixXd model(4000, 3);
  model << half, half;
  const VectorXd noise = Noise(5).draw(2000, 0.3);
  VectorXd both(4000);
  both << noise, noise;
  const VectorXd residual = both - model * (model.transpose() * both);
  const MatrixXd none = MatrixXd::Zero(3, 3);
  const MatrixXd each = MatrixXd::Identity(3, 3);
  const auto shared = score_contributions({{model, residual, 2}}, none, each);
  const auto single = score_contributions({{slow_model(2000), residual.head(2000), 1}}, none, each);
  // The result is twice the variance of one channel in these coordinates. The limit is 5 % because
  // the small-sample corrections differ.
  CHECK_THAT(robust_variance(shared, none, each, 0).variance,
             WithinRel(2.0 * robust_variance(single, none, each, 0).variance, 0.05));
}

TEST_CASE("sandwich: the freedom of conditions adds up, that of priors has no end", "[calib]") {
  ScoreContribution one;
  one.covariance = MatrixXd::Identity(1, 1);
  one.freedom = VectorXd::Constant(1, 10.0);
  const MatrixXd none = MatrixXd::Zero(1, 1);
  const MatrixXd each = MatrixXd::Identity(1, 1);
  CHECK_THAT(robust_variance({one, one}, none, each, 0).freedom, WithinRel(20.0, 1e-12));
  CHECK_THAT(robust_variance({one}, none, each, 0).freedom, WithinRel(10.0, 1e-12));
  const auto prior = robust_variance({}, MatrixXd::Identity(1, 1), each, 0);
  CHECK(prior.variance == 1.0);
  CHECK(std::isinf(prior.freedom));
}

TEST_CASE("sandwich: residuals of zero and records of few samples stay finite", "[calib]") {
  const MatrixXd none = MatrixXd::Zero(3, 3);
  const MatrixXd each = MatrixXd::Identity(3, 3);
  const auto silent = score_contributions({{slow_model(50), VectorXd::Zero(50), 1}}, none, each);
  CHECK(silent[0].covariance.isZero());
  const auto few =
      score_contributions({{slow_model(4), VectorXd::Constant(4, 0.1), 1}}, none, each);
  CHECK(few[0].covariance.allFinite());
  CHECK(std::isfinite(robust_variance(few, none, each, 1).freedom));
  // A residual that is pure drift has no correlation time, but must still give finite values.
  const auto drift =
      score_contributions({{slow_model(200), VectorXd::LinSpaced(200, -1.0, 1.0), 1}}, none, each);
  CHECK(drift[0].covariance.allFinite());
  CHECK(drift[0].independent_residuals >= 1.0);
}

TEST_CASE("sandwich: far from an optimum, one record much further than the other, it stays finite",
          "[calib]") {
  // The model misses most of the first record, and the correction then attributes its errors to the
  // residuals of the second. After subtracting all that, the autocovariances do not belong to any
  // series.
  constexpr Index kSamples = 1000;
  const MatrixXd slow = slow_model(kSamples) / std::sqrt(2.0);
  MatrixXd fast(kSamples, 3);
  VectorXd far(kSamples);
  VectorXd near(kSamples);
  for (Index t = 0; t < kSamples; ++t) {
    const double turn = 2.0 * std::acos(-1.0) * static_cast<double>(t);
    // Orthonormal except for a factor of sqrt(2) that `slow` also has.
    fast.row(t) << std::sin(turn / 20.0), std::cos(turn / 20.0), std::sin(turn / 25.0);
    far(t) = 1.4 * std::cos(turn / 800.0);
    near(t) = std::sin(turn / 200.0) + 0.1 * std::sin(turn / 70.0);
  }
  fast /= std::sqrt(static_cast<double>(kSamples));
  const MatrixXd none = MatrixXd::Zero(3, 3);
  const MatrixXd each = MatrixXd::Identity(3, 3);
  const auto scatter = score_contributions({{slow, far, 1}, {fast, near, 1}}, none, each);
  for (Index j = 0; j < 3; ++j) {
    const RobustVariance robust = robust_variance(scatter, none, each, j);
    // Upper limit: the square of a normalised combination of all residuals cannot exceed their sum
    // of squares.
    CHECK(robust.variance > 0.0);
    CHECK(robust.variance < far.squaredNorm() + near.squaredNorm());
    CHECK(std::isfinite(robust.quantile()));
  }
}

}  // namespace rigcal::calib
