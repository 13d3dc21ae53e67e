#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rigcal::diagnosis {

/// Least number of healthy records from which their variation can be estimated. With two, each
/// minus the other gives the same residual.
inline constexpr std::size_t kLeastHealthyRecords = 3;

/// Threshold that a new healthy record exceeds with a given probability: the one-sided prediction
/// bound of the next of n independent values whose logarithms are normally distributed, exp(mean +
/// t(n - 1; 1 - alpha) sd sqrt(1 + 1/n)) (Hahn and Meeker, Statistical Intervals, 1991, 4.8). Empty
/// for fewer than kLeastHealthyRecords values, or one that is not positive.
///
/// @param healthy      one value per healthy record
/// @param false_alarm  alpha, in (0, 1)
std::optional<double> alarm_threshold(std::span<const double> healthy, double false_alarm);

/// A cause that may change a record as a whole: the square that a value of a record has by one
/// standard deviation of it, and the degrees of freedom with which that is known.
struct CausePart {
  double square = 0.0;
  double freedom = 0.0;
};

/// Threshold where causes add to what records have of their own: squares add up, and that of the
/// causes together is exceeded as F is, with the degrees of freedom of Satterthwaite for their sum
/// (F. E. Satterthwaite, Biometrics 2, 1946). A single cause of n records is the prediction bound
/// of Student's t, two-sided.
///
/// @param own  threshold without the causes
double threshold_with(double own, std::span<const CausePart> causes, double false_alarm);

/// Root mean square of the last `window` samples at each sample. Samples before the series, or
/// before a gap (NaN), count as zero: a large residual raises it before the window is full, and
/// noise gives no larger values there than later. NaN in a gap.
///
/// @param x       shape (n)
/// @param window  >= 1
std::vector<double> moving_rms(std::span<const double> x, std::size_t window);

}  // namespace rigcal::diagnosis
