#pragma once

#include <optional>
#include <span>
#include <vector>

#include "metrics/agreement.hpp"

namespace rigcal::metrics {

/// The measured signal with which a score compares a model, and its sources of uncertainty.
struct MeasuredMean {
  std::span<const double> mean;  ///< shape (n)
  /// Each repeat minus the mean, NaN where the repeat has no sample; shape (repeats, n)
  std::vector<std::vector<double>> deviations;
  double gain_sd = 0.0;    ///< standard uncertainty of the sensor's gain, relative
  double offset_sd = 0.0;  ///< standard uncertainty of the sensor's offset, unit of the mean
  /// For each further cause, the change in the mean at one standard uncertainty; shape (causes, n)
  std::vector<std::vector<double>> changes = {};
};

/// Contributions to the standard uncertainty of each score. Together with the coverage factor they
/// give the two-sided interval: its half width is the factor times the root of the sum of squares.
/// Without `noise_left` they give the one-sided interval.
struct ScoreContributions {
  Agreement repeats;               ///< variation between repeats
  Agreement noise_left;            ///< noise in the mean, which makes a score worse
  Agreement gain, offset;          ///< the sensor's certificate; 0 if none is stated
  std::vector<Agreement> changes;  ///< one per item of MeasuredMean::changes
  Agreement degrees_of_freedom;    ///< effective; at most kManyDegrees
  Agreement coverage_factor;
};

/// Expanded uncertainties of each score of a given model, relative to the mean of infinitely many
/// repeats measured by an ideal sensor.
struct ScoreUncertainty {
  /// The score is better than the true one by more than this in at most 2.5 % of cases. This is the
  /// guard band of a limit.
  Agreement one_sided;
  /// The score differs from the true one by no more than this, in either direction, in 95 % of
  /// cases. This is printed after +-.
  Agreement two_sided;
  ScoreContributions contributions = {};
};

/// Computes the expanded uncertainty of each score.
///
/// The repeats contribute the jackknife variance, u^2 = (R - 1) / R sum (S_r - mean S_r)^2, where
/// S_r is the score without repeat r. This assumes nothing about the correlation of deviations
/// within a repeat. Gain, offset and each other cause contribute the largest change of the score
/// when the mean shifts by one standard uncertainty in either direction. They therefore count even
/// at the best score, where the slope is zero. An offset may be constant, or may change from one
/// end of the range to the other. Certificates do not say which, and rho2 is insensitive to a
/// constant, so the larger effect counts. Contributions are added as squares. The coverage factor
/// is Student's t with Welch-Satterthwaite degrees of freedom: R - 1 for the repeats, infinite for
/// the sensor (JCGM 100:2008, G.4).
///
/// Noise that remains in the mean makes a score worse on average. The one-sided uncertainty does
/// not include this: a limit that is met in spite of the noise is met. The two-sided uncertainty
/// does, as the jackknife bias of the score (for fractions such as rho2) or of its square (for rms
/// and absolute errors), depending on how the noise enters. The error of this bias has the factor
/// of R - 1 degrees of freedom, even if a sensor contributes most of the uncertainty. An error of
/// the sensor makes rms and absolute errors worse, too: their square may fall by as much as it does
/// on the way to the best value of each cause within its 95 % interval.
///
/// The largest error changes by no more than the largest noise in the mean. This is estimated from
/// the largest deviation of the repeats, and its square is added. The interval is at least this
/// noise plus what all causes together change to first order.
///
/// @return nullopt if there are fewer than two repeats, if all are equal (copies carry no
///         information), or if a score is undefined without one of them
/// @throws std::invalid_argument, std::domain_error  under the conditions of agreement()
std::optional<ScoreUncertainty> agreement_uncertainty(const MeasuredMean& measured,
                                                      std::span<const double> simulated);

}  // namespace rigcal::metrics
