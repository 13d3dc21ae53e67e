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

/// Returns the covariance of a fit's estimates, including the uncertainty of known values. It is
/// the sandwich of the score covariance if that exists, otherwise sigma^2 (J^T J)^-1. A single
/// factor widens it, so that correlations are kept, until 1.96 standard deviations of every
/// estimate reach the half-width of its 95 % interval. This is needed because intervals based on
/// differences between repeats, or on few degrees of freedom, are wider. Directions that the data
/// do not determine get the standard deviation that belongs to the smallest singular value still
/// counted.
EstimateSpread estimate_spread(const Problem& problem, std::span<const double> z,
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

/// How each effect changes the channels of a condition at the times of its record: for each channel
/// a matrix of shape (times, effects), SI per unit of the effect's size. Empty if unknown or not
/// requested.
using EffectChanges = std::vector<Eigen::MatrixXd>;

/// Adds to each scored condition the expected standard deviation of a measurement about the
/// simulation. It combines the uncertainty of the estimates, to first order, with the noise of the
/// record. If the model is right, 95 % of the samples are within 1.96 of these standard deviations.
/// A value estimated only from the record of a condition counts as known there, unless it is among
/// the estimates. Conditions whose sensitivities cannot be simulated get no standard deviation.
///
/// In conditions that no estimate is based on, each channel also gets the component of its residual
/// that a step of the estimates would remove, with their covariance as the prior
/// (ChannelScore::explained).
///
/// Small effects that the model leaves out act on a prediction directly; the part that the fit has
/// absorbed into the estimates is subtracted. Together they show how far the prediction may be off.
/// In the records of a fit the residuals show that difference and therefore limit it. A record from
/// another date than those of the fit may also differ by day-to-day differences (day_quantities()).
/// Nothing is added if a date is missing.
///
/// @param z        unknowns of `problem`
/// @param changes  changes by the effects in `spread`, for each condition; empty: effects are left
///                 out
/// @param scores   scores of the problem's conditions, in their order
void add_prediction_sd(const Problem& problem, std::span<const double> z,
                       const EstimateSpread& spread, const std::vector<EffectChanges>& changes,
                       int threads, std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
