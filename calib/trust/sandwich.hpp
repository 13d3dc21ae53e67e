#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "metrics/autoregression.hpp"

namespace rigcal::calib {

/// Highest order of the autoregression that residuals are taken for.
inline constexpr int kMostLags = 20;

/// Weighted residuals r and their Jacobian J of one condition at the optimum. Jacobian rows are in
/// coordinates in which the sum of J^T J over all conditions and priors is the identity; those that
/// belong to other conditions alone are left out.
struct ScoreRows {
  /// Shape (channels * samples, own directions + shared directions), channel after channel.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;  ///< shape (channels * samples)
  Eigen::Index channels = 1;
  Eigen::MatrixXf narrow{};  ///< the Jacobian once make_narrow() was called

  /// Stores the Jacobian in half of the memory. Simulations are exact to 1e-6 of a sensitivity, far
  /// less than seven digits.
  void make_narrow();
  /// Rows [first, first + count) of the Jacobian, wherever it is stored.
  Eigen::MatrixXd rows(Eigen::Index first, Eigen::Index count) const;
  Eigen::MatrixXd all_rows() const { return rows(0, std::max(narrow.rows(), jacobian.rows())); }
};

/// Contribution of one condition to the long-run covariance of the score J^T r.
struct ScoreScatter {
  Eigen::MatrixXd covariance;  ///< shape (directions)^2, positive semidefinite
  Eigen::VectorXd freedom;     ///< degrees of freedom of its variance of each combination
  /// Contribution of the error of each combination to that variance if the error is one standard
  /// error, divided by the expected variance of all conditions; empty: none.
  Eigen::VectorXd own;
  std::vector<metrics::Autoregression> noise;  ///< models of the weighted residuals, per channel
  double independent_residuals = 0.0;          ///< sum over all channels
};

/// Covariance of the score of every condition where residuals may be correlated in time and between
/// channels, and their size may change with time (heteroscedasticity and autocorrelation
/// consistent, HAC; Andrews, Econometrica 59, 1991).
///
/// An autoregression, of an order that the data choose, whitens the residuals of each channel:
/// r = L u with L unit lower triangular, hence J^T r = (L^T J)^T u exactly. The contributions
/// (L^T J)_t u_t of the samples, summed over channels, are nearly uncorrelated. A Parzen kernel
/// with Andrews' automatic bandwidth accounts for the remaining correlation. The residuals are
/// whitened, not the scores, so that the changing Jacobian does not enter the estimate of the
/// correlation.
///
/// The fit has removed a part of the noise, mostly slow, in the space of the Jacobian. The
/// autocovariances are corrected by the bias of (I - H) Sigma (I - H) at the covariance Sigma
/// found, H = J J^T.
///
/// Degrees of freedom: Satterthwaite's, from the variance of a sum of squares with the weights of
/// each combination, and 4 / independent residuals of a whitened long-run variance.
///
/// Under correlated noise least squares is not the best estimate, and the residuals still contain a
/// part of its error: an estimate far from the truth also looks uncertain. `own` is the size of
/// this part, from the covariance of u with the error, (I - H) Sigma J c whitened, with the same
/// kernel.
///
/// @param rows          all conditions of the fit
/// @param priors        J^T J of the priors, whose errors have the variance that they state
/// @param combinations  of the directions, one per unknown
std::vector<ScoreScatter> score_scatter(const std::vector<ScoreRows>& rows,
                                        const ArrowMatrix& priors, const ArrowRoot& combinations,
                                        int threads = 1);

/// Degrees of freedom with which a condition knows its part of the variance of an unknown. What it
/// tells of an own unknown of another condition it tells by way of the shared ones: the least of
/// theirs.
double freedom_in(const ScoreScatter& scatter, const ArrowRoot& combinations, Eigen::Index unknown,
                  std::size_t condition);

/// Variance c^T (sum of all covariances + priors) c of a combination.
struct RobustVariance {
  double variance = 0.0;
  double freedom = 0.0;  ///< Satterthwaite's; infinite if only priors contribute
  double own = 0.0;      ///< fraction b of the variance due to the error of the combination itself

  /// Half width of the 95 % interval divided by the root of the variance. With the error z sigma
  /// and the variance sigma^2 ((1 - b) chi^2_f / f + b z^2), z standard normal, |error| > q
  /// root(variance) exactly if |z| root(f) / chi_f > t, with q^2 = t^2 / (1 - b + b t^2). That is
  /// Student's t for b = 0, and less if the error widens its own interval. f is `freedom` without
  /// the variance of z^2.
  double quantile() const;
};

/// 97.5 % quantile of Student's t; degrees of freedom below 1 count as 1.
double student_t(double freedom);

RobustVariance robust_variance(const std::vector<ScoreScatter>& scatter, const ArrowMatrix& priors,
                               const ArrowRoot& combinations, Eigen::Index unknown);

}  // namespace rigcal::calib
