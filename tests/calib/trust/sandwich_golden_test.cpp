// Compares the covariance of the score with dense matrices
// (tests/golden/make_statistics_golden.py).

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <vector>

#include "calib/trust/sandwich.hpp"
#include "tests/support/golden.hpp"

using namespace rigcal::calib;
using Catch::WithinRel;
using rigcal::test::golden;

TEST_CASE("golden: covariance of the score, its freedom and what the error adds", "[calib]") {
  const std::vector<double> residual = golden("sandwich.residual");
  const std::vector<double> jacobian = golden("sandwich.jacobian");
  const auto samples = static_cast<Eigen::Index>(residual.size());
  ScoreRows rows;
  rows.residual = Eigen::Map<const Eigen::VectorXd>(residual.data(), samples);
  rows.jacobian = Eigen::Map<const Eigen::MatrixXd>(jacobian.data(), samples, 2);
  const auto scatter = score_contributions({rows}, Eigen::MatrixXd::Zero(2, 2),  // no priors
                                           Eigen::MatrixXd::Identity(2, 2));
  REQUIRE(scatter.size() == 1);
  const auto& noise = scatter[0].noise.at(0);
  const std::vector<double> model = golden("sandwich.noise");
  REQUIRE(noise.phi.size() + 1 == model.size());
  // 1e-9, because the dense calculation inverts matrices for 150 samples and reads 15 digits. The
  // degrees of freedom depend on the integral of the squared kernel, which the source gives with
  // six digits.
  CHECK_THAT(noise.variance, WithinRel(model[0], 1e-9));
  for (std::size_t k = 0; k < noise.phi.size(); ++k)
    CHECK_THAT(noise.phi[k], WithinRel(model[k + 1], 1e-9));
  CHECK_THAT(scatter[0].independent_residuals,
             WithinRel(golden("sandwich.effective_samples")[0], 1e-9));
  const std::vector<double> covariance = golden("sandwich.covariance");
  for (Eigen::Index i = 0; i < 4; ++i) {
    CHECK_THAT(scatter[0].covariance(i / 2, i % 2),
               WithinRel(covariance[static_cast<std::size_t>(i)], 1e-8));
  }
  for (Eigen::Index j = 0; j < 2; ++j) {
    const auto u = static_cast<std::size_t>(j);
    CHECK_THAT(scatter[0].own(j), WithinRel(golden("sandwich.own")[u], 1e-8) ||
                                      Catch::WithinAbs(golden("sandwich.own")[u], 1e-12));
    CHECK_THAT(scatter[0].freedom(j), WithinRel(golden("sandwich.freedom")[u], 1e-6));
  }
}
