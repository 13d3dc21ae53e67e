#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rigcal::diagnosis {

/// Minimum number of healthy records from which their variation can be estimated. With only two,
/// the residuals are equal apart from their signs.
inline constexpr std::size_t kLeastHealthyRecords = 3;

/// Returns the threshold that a new healthy record exceeds with a given probability. It is the
/// one-sided prediction bound for the next value, given n independent values whose logarithms are
/// normally distributed: exp(mean + t(n - 1; 1 - alpha) sd sqrt(1 + 1/n)) (Hahn and Meeker,
/// Statistical Intervals, 1991, 4.8). Empty for fewer than kLeastHealthyRecords values, or if a
/// value is not positive.
///
/// @param healthy      one value per healthy record
/// @param false_alarm  alpha, in (0, 1)
std::optional<double> alarm_threshold(std::span<const double> healthy, double false_alarm);

/// Contribution of a cause that may change a whole record: the square of the value that a record
/// gets if the cause deviates by one standard deviation, with its degrees of freedom.
struct CausePart {
  double square = 0.0;
  double freedom = 0.0;
};

/// Returns the threshold for records that vary because of common causes in addition to their own
/// noise. The squares of the two contributions are added. That of the causes is their total
/// variance times a quantile of F, with Satterthwaite's degrees of freedom (F. E. Satterthwaite,
/// Biometrics 2, 1946). For a single cause estimated from n records, this is the two-sided
/// prediction bound of Student's t.
///
/// @param own  threshold without the causes
double threshold_with(double own, std::span<const CausePart> causes, double false_alarm);

/// Returns the root mean square of the last `window` samples at each sample; NaN in a gap. Samples
/// before the beginning of the series, or before the end of a gap (NaN), count as zero. A large
/// residual therefore raises the result even before the window is full, while noise gives no larger
/// values there than later.
///
/// @param x       shape (n)
/// @param window  >= 1
std::vector<double> moving_rms(std::span<const double> x, std::size_t window);

}  // namespace rigcal::diagnosis
