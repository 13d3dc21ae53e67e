#pragma once

#include <optional>
#include <span>
#include <vector>

#include "metrics/agreement.hpp"

namespace rigcal::metrics {

/// What makes the measured side of a score uncertain.
struct MeasuredMean {
  std::span<const double> mean;  ///< shape (n)
  /// Each repeat minus the mean, NaN where it has no sample; shape (repeats, n)
  std::vector<std::vector<double>> deviations;
  double gain_sd = 0.0;    ///< standard uncertainty of the sensor's gain, relative
  double offset_sd = 0.0;  ///< that of its offset, unit of the mean
};

/// Expanded uncertainty of each score against a given model: by so much, with 95 % confidence, may
/// it differ from the score against the mean of unlimited repeats and a true sensor.
///
/// The repeats' part is the jackknife, u^2 = (R - 1) / R sum (S_r - mean S_r)^2 with S_r the score
/// without repeat r, which needs no assumption on how deviations within a repeat go together. That
/// of gain or offset is the largest change of the score when the mean is changed by one standard
/// uncertainty either way, so that it counts where the score is at its best and has no slope. An
/// offset may be off by as much at every sample, or change from one end of the range to the other,
/// whichever changes the score more: no certificate tells, and rho2 is blind to a constant. They
/// add as squares; the factor is that of Student's t with the degrees of freedom by
/// Welch-Satterthwaite, R - 1 for the repeats and unlimited for the sensor (JCGM 100:2008, G.4).
///
/// Noise that the mean has kept makes a score worse in the mean, by what noise_floor() tells. That
/// is not in here: a limit that is kept in spite of it is kept.
///
/// @return nothing with fewer than two repeats, where they are all equal (copies tell nothing), or
///         where a score does not exist without one of them
/// @throws as agreement()
std::optional<Agreement> agreement_uncertainty(const MeasuredMean& measured,
                                               std::span<const double> simulated);

}  // namespace rigcal::metrics
