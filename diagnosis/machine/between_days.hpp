#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib/problem/day_effects.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"
#include "diagnosis/record/leak_estimate.hpp"
#include "metrics/significance.hpp"

namespace rigcal::diagnosis {

/// Source of the assumed size of the variation between days.
enum class DaySource { usual, stated, estimated };
RIGCAL_NAMES(DaySource, usual, stated, estimated)

/// Variation between the days of a campaign. On each day, each quantity has an independent
/// deviation with the standard deviation of that quantity.
struct BetweenDays {
  /// Days of records that are not from the day of their reference.
  std::vector<std::string> other_days;
  DaySource source = DaySource::usual;
  double factor = 1.0;            ///< factor on the usual sizes, estimated from healthy days
  std::optional<double> freedom;  ///< degrees of freedom of the factor; absent if not estimated
  int healthy_dates = 0;          ///< number of stated dates of healthy records
  std::vector<calib::DayQuantity> quantities;
  std::optional<std::string> sentence;  ///< in_words(); absent without other days
  RIGCAL_DESCRIBE(other_days, source, factor, freedom, healthy_dates, quantities, sentence)

  double variance = 1.0;          ///< square of the factor; not stored
  std::vector<std::string> days;  ///< dates, or the text that replaces a missing date; not stored

  double degrees_of_freedom() const { return freedom.value_or(metrics::kManyDegrees); }
  /// Returns the error that the days cause in a coefficient that changes by `effects` per standard
  /// deviation.
  double error(double weight, const Eigen::VectorXd& effects) const;
};

/// Returns the day of a condition, which is its date if it has one. Otherwise, conditions with use
/// `fit` belong to the day of the fit, and the others to a separate day for each state of the
/// machine.
std::string day_label(const datasets::Condition& condition);

/// @param references  condition of each repeat in the reference; if empty, the conditions of the
///                    fit are used
DayWeights day_weights(const BetweenDays& between, const datasets::Campaign& campaign,
                       const datasets::Condition& condition,
                       const std::vector<const datasets::Condition*>& references);

/// Returns the values of the rig in the first condition of a campaign, including fitted values.
model::ParameterValues rig_values(const LeakProblem& problem);
/// Returns the shortest sampling interval of any record.
double shortest_interval(const std::vector<datasets::RepeatRecords>& records);

/// Returns the days of a campaign, and the quantities with their stated or usual sizes.
///
/// @param values    values of the rig
/// @param sample_s  shortest sampling interval
BetweenDays between_days_of(const datasets::Campaign& campaign,
                            const model::ParameterValues& values, double sample_s);

/// A healthy average, for comparison with averages from other days.
struct HealthyDay {
  double coefficient = 0.0;
  double variance = 0.0;       ///< variance of the average's own error
  double days_variance = 0.0;  ///< variance that the days would cause with the usual sizes
};

/// Minimum number of dates with healthy records for an estimate of the variation between days.
inline constexpr int kLeastHealthyDates = 4;

/// Estimates the factor on the variances from the coefficients of healthy averages. For each
/// average, the square of the coefficient, minus the variance of its own error, is divided by the
/// variance that the usual sizes would cause. These ratios are averaged with weights according to
/// their information. The sizes of the quantities become the estimated ones. Does nothing if the
/// campaign states sizes or has too few dates.
void estimate_days(const std::vector<HealthyDay>& healthy, BetweenDays& between);

/// Describes, in words, how much days are assumed to differ: "records of 2026-03-02: another day
/// than their reference's ...". Returns std::nullopt if every record is from the day of its
/// reference.
std::optional<std::string> in_words(const BetweenDays& between);

/// Returns an error increased by the contribution of day-to-day differences.
CoefficientError with_days(CoefficientError error, double days_se, double freedom);

}  // namespace rigcal::diagnosis
