#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/condition_score.hpp"
#include "calib/result/estimate_spread.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// The covariance of a fit's estimates: that of the scatter of its residuals (sandwich), where
/// there is one, else sigma^2 (J^T J)^-1; with the uncertainty of known values. It is widened, as a
/// whole so that correlations stay, until 1.96 standard deviations of no estimate are less than the
/// half width of its 95 % interval by the same error: intervals that rest on the difference of
/// repeats or on few degrees of freedom are wider. Directions that the data do not determine have
/// the spread of the least singular value that would count.
EstimateSpread estimate_spread(const Problem& problem, std::span<const double> z,
                               const Uncertainty& found);

/// Standard deviation of a prediction, sqrt(|g S|^2 + sd^2) for each row g of the gradient.
///
/// @param gradient  d output / d estimate, SI; shape (samples, estimates)
/// @param root      shape (estimates, columns)
/// @param noise_sd  of a measured sample, SI
/// @return          shape (samples), SI
std::vector<double> prediction_sd(const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& root,
                                  double noise_sd);

/// Adds to each scored condition what a measurement is expected to scatter by about the simulation:
/// the estimates' uncertainty, to first order, and the noise of the record. 95 % of the samples lie
/// within 1.96 of it where the model is right. What is estimated from a condition's own record
/// alone counts as known there, unless it is among the estimates. A condition whose sensitivities
/// cannot be simulated gets none.
///
/// @param z       of `problem`, shape (its unknowns)
/// @param scores  of the problem's conditions, in their order
void add_prediction_sd(const Problem& problem, std::span<const double> z,
                       const EstimateSpread& spread, int threads,
                       std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
