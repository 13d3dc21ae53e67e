#pragma once

#include <optional>
#include <span>
#include <vector>

#include "metrics/agreement.hpp"

namespace rigcal::metrics {

/// The measured side of a score, with its sources of uncertainty.
struct MeasuredMean {
  std::span<const double> mean;  ///< shape (n)
  /// Each repeat minus the mean, NaN where it has no sample; shape (repeats, n)
  std::vector<std::vector<double>> deviations;
  double gain_sd = 0.0;    ///< standard uncertainty of the sensor's gain, relative
  double offset_sd = 0.0;  ///< standard uncertainty of its offset, unit of the mean
  /// Change of the mean by one standard uncertainty of each other cause; shape (causes, n)
  std::vector<std::vector<double>> changes = {};
};

/// Expanded uncertainties of each score of a given model, against the mean of unlimited repeats and
/// a true sensor.
struct ScoreUncertainty {
  /// The score is falsely better by more in at most 2.5 % of cases: the guard band of a limit.
  Agreement one_sided;
  /// The score differs by no more, in either direction, in 95 %: printed after +-.
  Agreement two_sided;
};

/// Expanded uncertainty of each score.
///
/// The contribution of the repeats is the jackknife, u^2 = (R - 1) / R sum (S_r - mean S_r)^2,
/// where S_r is the score without repeat r. It makes no assumption on the correlation of deviations
/// within a repeat. The contribution of gain, offset or another cause is the largest change of the
/// score when the mean changes by one standard uncertainty in either direction, so that it counts
/// even at the best score, where the slope is zero. An offset may be constant, or change from one
/// end of the range to the other; the larger effect counts, since certificates do not say which,
/// and rho2 is blind to a constant. Contributions add as squares. The factor is that of Student's t
/// with the degrees of freedom by Welch-Satterthwaite, R - 1 for the repeats and unlimited for the
/// sensor (JCGM 100:2008, G.4).
///
/// Noise that remains in the mean makes a score worse on average. One-sided, that is not included:
/// a limit that is kept in spite of it is kept. Two-sided it is: by the bias of the jackknife, of
/// the score (fractions such as rho2), or of its square (rms and absolute errors), as the noise
/// enters. The largest error moves by no more than the largest noise of the
/// mean, estimated by the largest deviation of the repeats; its square is added.
///
/// @return nothing with fewer than two repeats, if all are equal (copies carry no information), or
///         if a score does not exist without one of them
/// @throws as agreement()
std::optional<ScoreUncertainty> agreement_uncertainty(const MeasuredMean& measured,
                                                      std::span<const double> simulated);

}  // namespace rigcal::metrics
