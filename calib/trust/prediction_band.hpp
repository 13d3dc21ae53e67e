#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/condition_score.hpp"
#include "calib/result/estimate_covariance.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Returns the covariance of a fit's estimates, including the uncertainty of known values. It is
/// the sandwich estimate based on the score covariance if there is one, otherwise sigma^2 (J^T
/// J)^-1. It is widened by a single factor, which preserves the correlations, until 1.96 standard
/// deviations of every estimate reach the half-width of its 95 % interval. This is necessary
/// because intervals based on differences between repeats, or on few degrees of freedom, are wider.
/// Directions that the data do not determine get the standard deviation that corresponds to the
/// smallest singular value that still counts.
EstimateCovariance estimate_covariance(const Problem& problem, std::span<const double> z,
                                       const Uncertainty& found);

/// Returns the standard deviation of a prediction, sqrt(|g S|^2 + sd^2) for each row g of the
/// gradient.
///
/// @param gradient  d output / d estimate, SI; shape (samples, estimates)
/// @param root      S, shape (estimates, columns)
/// @param noise_sd  standard deviation of a measured sample, SI
/// @return          shape (samples), SI
std::vector<double> prediction_sd(const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& root,
                                  double noise_sd);

/// Returns how far a prediction is open, with at most three keys.
///
/// @param gradient  d output / d quantity at the samples that count, SI; shape (samples,
/// quantities)
/// @param root      S, shape (quantities, columns)
/// @param keys      of the first quantities; the others have no name
/// @param measured  shape (samples), SI; not constant
OpenPrediction open_prediction(const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& root,
                               const std::vector<std::string>& keys,
                               const Eigen::VectorXd& measured);

/// How each effect changes the channels of a condition at the times of its record. There is one
/// matrix per channel, of shape (times, effects), in SI units per unit of the effect's size. Empty
/// if unknown or not requested.
using EffectChanges = std::vector<Eigen::MatrixXd>;

/// Adds to each scored condition the expected standard deviation of a measurement about the
/// simulation. It combines the uncertainty of the estimates, to first order, with the noise of the
/// record. If the model is right, 95 % of the samples are within 1.96 of these standard deviations.
/// A value estimated only from the record of a condition counts as known in that condition, unless
/// it is among the estimates. If the sensitivities of a condition cannot be simulated, it gets no
/// standard deviation.
///
/// In conditions that no estimate is based on, each channel also gets the component of its residual
/// that adjusting the estimates would remove, with the covariance of the estimates as the prior
/// (ConditionScore::explained), and how far its prediction is open (ConditionScore::open).
///
/// Small effects that the model omits act directly on a prediction, and the part of them that the
/// fit has absorbed into the estimates is subtracted. The result shows how far the prediction may
/// be off. For fitted records, the residuals show this difference and therefore limit it. A record
/// from a date on which no fitted record was made may also be affected by day-to-day differences
/// (day_quantities()). These are not added if a date is missing.
///
/// @param z        unknowns of `problem`
/// @param changes  for each condition, the changes due to the effects in `of_fit`; if empty,
///                 effects are ignored
/// @param scores   scores of the problem's conditions, in their order
void add_prediction_sd(const Problem& problem, std::span<const double> z,
                       const EstimateCovariance& of_fit, const std::vector<EffectChanges>& changes,
                       int threads, std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
