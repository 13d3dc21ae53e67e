#include "diagnosis/parity/common_causes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rigcal::diagnosis {
namespace {

/// The largest component of pure noise varies around the edge. A component is significant above
/// this multiple of the edge. (Missing a weak cause leads to alarms, while mistaking noise for a
/// cause only makes a threshold slightly higher.)
constexpr double kBeyondEdge = 1.05;
/// Smaller autocorrelations are attributed to noise.
constexpr double kNoCorrelation = 0.05;

/// Returns the number of independent squares that would estimate a variance as precisely as all
/// samples do: n / (1 + 2 sum rho^2), summed up to the first autocorrelation below kNoCorrelation.
double independent_samples(const Eigen::MatrixXd& series) {
  const Eigen::Index n = series.rows();
  const double power = series.squaredNorm();
  double sum = 0.0;
  for (Eigen::Index lag = 1; power > 0.0 && lag < n / 2; ++lag) {
    const double rho =
        series.topRows(n - lag).cwiseProduct(series.bottomRows(n - lag)).sum() / power;
    if (rho < kNoCorrelation) break;
    sum += rho * rho;
  }
  return static_cast<double>(n) / (1.0 + 2.0 * sum);
}

}  // namespace

CommonCauses common_causes(const Eigen::MatrixXd& residuals) {
  const Eigen::Index records = residuals.cols();
  const Eigen::Index most = records - 1;  // the residuals sum to zero
  CommonCauses result{Eigen::MatrixXd(residuals.rows(), 0), residuals};
  const double own = static_cast<double>(most) / static_cast<double>(records);
  const Eigen::MatrixXd deviations = own * residuals;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(deviations.transpose() * deviations);
  const Eigen::VectorXd powers = solver.eigenvalues().reverse().cwiseMax(0.0);
  const Eigen::MatrixXd directions = solver.eigenvectors().rowwise().reverse();
  for (Eigen::Index c = 0; c + 1 < most; ++c) {
    const Eigen::Index left = most - c - 1;
    const double noise = powers.segment(c + 1, left).mean();
    const Eigen::VectorXd direction = directions.col(c);
    const Eigen::MatrixXd rest = result.rest - result.rest * direction * direction.transpose();
    const double edge = 1.0 + std::sqrt(static_cast<double>(left + 1) / independent_samples(rest));
    if (!(powers(c) > kBeyondEdge * edge * edge * noise)) break;
    result.patterns.conservativeResize(Eigen::NoChange, c + 1);
    result.patterns.col(c) = deviations * direction / std::sqrt(powers(c)) *
                             std::sqrt((powers(c) - noise) / static_cast<double>(most));
    result.rest = rest;
  }
  const auto found = static_cast<double>(result.patterns.cols());
  result.rest *= std::sqrt(static_cast<double>(most) / (static_cast<double>(most) - found));
  return result;
}

}  // namespace rigcal::diagnosis
