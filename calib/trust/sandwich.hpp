#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "metrics/autoregression.hpp"

namespace rigcal::calib {

/// Maximum order of the autoregressions fitted to residuals.
inline constexpr int kMostLags = 20;

/// Weighted residuals r and their Jacobian J for one condition at the optimum. The Jacobian is in
/// coordinates in which the sum of J^T J over all conditions and priors is the identity.
/// Coordinates that belong only to other conditions are left out.
struct ScoreRows {
  /// Shape (channels * samples, own directions + shared directions), one channel after the other.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;  ///< shape (channels * samples)
  Eigen::Index channels = 1;
  Eigen::MatrixXf narrow{};  ///< the Jacobian after make_narrow() has been called

  /// Stores the Jacobian in single precision, which halves its memory. The sensitivities are
  /// accurate only to about 1e-6, so nothing is lost.
  void make_narrow();
  /// Returns the rows [first, first + count) of the Jacobian in either precision.
  Eigen::MatrixXd rows(Eigen::Index first, Eigen::Index count) const;
  Eigen::MatrixXd all_rows() const { return rows(0, std::max(narrow.rows(), jacobian.rows())); }
};

/// Whether ScoreContribution::own is computed. Only RobustVariance::quantile() reads it.
enum class OwnPart { computed, left_out };

/// Contribution of one condition to the long-run covariance of the score J^T r.
struct ScoreContribution {
  Eigen::MatrixXd covariance;  ///< shape (directions, directions), positive semidefinite
  Eigen::VectorXd freedom;     ///< degrees of freedom of the variance of each combination
  /// Contribution to this variance from the error of each combination itself, for an error of one
  /// standard error, divided by the expected variance over all conditions. Empty if there is none.
  Eigen::VectorXd own;
  std::vector<metrics::Autoregression> noise;  ///< model of the weighted residuals of each channel
  double independent_residuals = 0.0;          ///< sum over all channels
};

/// Estimates the covariance of the score of every condition. Residuals may be correlated in time
/// and between channels, and their size may change with time (heteroscedasticity and
/// autocorrelation consistent, HAC; Andrews, Econometrica 59, 1991).
///
/// The residuals of each channel are whitened by an autoregression whose order is chosen from the
/// data: r = L u, where L is unit lower triangular, so that J^T r = (L^T J)^T u exactly. The
/// contributions (L^T J)_t u_t of the samples, summed over channels, are almost uncorrelated. A
/// Parzen kernel with Andrews' automatic bandwidth accounts for the remaining correlation. The
/// residuals are whitened rather than the scores, so that the changing Jacobian does not affect the
/// estimate of the correlation.
///
/// The fit has removed part of the noise, mostly slow noise, in the space of the Jacobian. The
/// autocovariances are corrected for the bias of (I - H) Sigma (I - H) at the estimated covariance
/// Sigma, with H = J J^T.
///
/// The degrees of freedom follow from Satterthwaite's formula. It uses the variance of a sum of
/// squares with the weights of each combination, and 4 / independent residuals for a whitened
/// long-run variance.
///
/// If the noise is correlated, least squares is not the best estimator, and the residuals still
/// contain part of its error, so that an estimate far from the truth also appears more uncertain.
/// `own` is the size of this part. It is computed with the same kernel from the covariance of u
/// with the error, which is (I - H) Sigma J c, whitened.
///
/// @param rows          all conditions of the fit
/// @param priors        J^T J of the priors; their errors have the stated variances
/// @param combinations  combinations of the directions, one per unknown
/// @param own           `own` takes about half of the time if there are many combinations
std::vector<ScoreContribution> score_contributions(const std::vector<ScoreRows>& rows,
                                                   const ArrowMatrix& priors,
                                                   const ArrowRoot& combinations, int threads = 1,
                                                   OwnPart own = OwnPart::computed);

/// Returns the degrees of freedom of a condition's contribution to the variance of an unknown. If
/// the unknown belongs to another condition, this condition contributes through the shared
/// unknowns, and the result is the minimum over those.
double freedom_in(const ScoreContribution& scatter, const ArrowRoot& combinations,
                  Eigen::Index unknown, std::size_t condition);

/// Variance c^T (sum of all covariances + priors) c of a combination c.
struct RobustVariance {
  double variance = 0.0;
  double freedom = 0.0;  ///< Satterthwaite's degrees of freedom; infinite if only priors contribute
  /// Fraction b of the variance that is due to the error of the combination itself.
  double own = 0.0;

  /// Returns the half-width of the 95 % interval divided by the square root of the variance. Let
  /// the error be z sigma and the variance sigma^2 ((1 - b) chi^2_f / f + b z^2), where z is
  /// standard normal. Then |error| > q sqrt(variance) if and only if |z| sqrt(f) / chi_f > t, with
  /// q^2 = t^2 / (1 - b + b t^2). For b = 0 this is the quantile of Student's t, and it is smaller
  /// if the error widens its own interval. f is `freedom` without the variance of z^2.
  double quantile() const;
};

/// Returns the 97.5 % quantile of Student's t; degrees of freedom below 1 count as 1.
double student_t(double freedom);

RobustVariance robust_variance(const std::vector<ScoreContribution>& scatter,
                               const ArrowMatrix& priors, const ArrowRoot& combinations,
                               Eigen::Index unknown);

}  // namespace rigcal::calib
