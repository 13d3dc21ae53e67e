#include "calib/design/criterion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rigcal::calib {
namespace {

constexpr double kUniformPrecision =
    12.0;  // inverse variance of a uniform distribution from 0 to 1

}  // namespace

double design_score(const Problem& problem, std::span<const double> z, const Eigen::MatrixXd& rows,
                    const std::vector<std::size_t>& named, datasets::DesignCriterion criterion) {
  Eigen::MatrixXd information = rows.transpose() * rows;
  for (Eigen::Index j = 0; j < information.rows(); ++j) {
    const double prior =
        problem.map.prior_slope(static_cast<int>(j), z[static_cast<std::size_t>(j)]);
    information(j, j) += kUniformPrecision + prior * prior;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  const auto count = static_cast<Eigen::Index>(named.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(information.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k)
    columns(static_cast<Eigen::Index>(named[static_cast<std::size_t>(k)]), k) = 1.0;
  const Eigen::MatrixXd covariance = columns.transpose() * factor.solve(columns);
  if (criterion == datasets::DesignCriterion::determinant) {
    const Eigen::VectorXd pivots = covariance.ldlt().vectorD();
    if (!(pivots.minCoeff() > 0.0)) return -std::numeric_limits<double>::infinity();
    return -0.5 * pivots.array().log().sum();
  }
  double worst = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t j = named[static_cast<std::size_t>(k)];
    const Unknown& unknown = problem.map.unknowns()[j];
    const double value = problem.map.to_physical(static_cast<int>(j), z[j]);
    const double size = value != 0.0 ? std::abs(value) : unknown.upper - unknown.lower;
    const double sd = std::sqrt(covariance(k, k)) * problem.map.slope(static_cast<int>(j), z[j]);
    worst = std::max(worst, sd / size);
  }
  return -std::log(worst);
}

}  // namespace rigcal::calib
