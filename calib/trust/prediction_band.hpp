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

/// The covariance of a fit's estimates, including the uncertainty of known values. It is the
/// sandwich of the score covariance if that exists, else sigma^2 (J^T J)^-1. It is widened by one
/// factor, so that correlations stay, until 1.96 standard deviations of every estimate reach the
/// half width of its 95 % interval: intervals from differences between repeats, or with few degrees
/// of freedom, are wider. Directions that the data do not determine get the standard deviation of
/// the least singular value that would count.
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

/// What each effect of a spread does to the channels of a condition at the times of its record: per
/// channel a matrix of shape (times, effects), SI per unit of size. Empty: not known, or not asked
/// for.
using EffectChanges = std::vector<Eigen::MatrixXd>;

/// Adds to each scored condition the expected standard deviation of a measurement about the
/// simulation: the uncertainty of the estimates, to first order, and the noise of the record. If
/// the model is right, 95 % of the samples are within 1.96 of them. Values that are estimated only
/// from the record of a condition count as known there, unless they are among the estimates. A
/// condition whose sensitivities cannot be simulated gets none.
///
/// Of conditions that no estimate rests on, each channel gets the part of its residual that a step
/// of the estimates would take off, with their covariance as a prior (ChannelScore::explained).
///
/// Small effects that the model leaves out act on a prediction by themselves, less what the fit has
/// mistaken for a change of the estimates: of both follows how far the prediction may be off. In
/// the records of a fit that difference is what the residuals show, which limits it. A record of
/// another date than those of the fit may differ by what differs between days, too
/// (day_quantities()); nothing is added where a date is missing.
///
/// @param z        of `problem`, shape (its unknowns)
/// @param changes  by the effects of the spread, per condition; empty: effects are left out
/// @param scores   of the problem's conditions, in their order
void add_prediction_sd(const Problem& problem, std::span<const double> z,
                       const EstimateSpread& spread, const std::vector<EffectChanges>& changes,
                       int threads, std::vector<ConditionScore>& scores);

}  // namespace rigcal::calib
