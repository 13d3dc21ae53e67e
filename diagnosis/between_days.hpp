#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "calib/problem/day_effects.hpp"
#include "datasets/campaign/campaign.hpp"
#include "diagnosis/leak/leak_estimate.hpp"
#include "metrics/significance.hpp"

namespace rigcal::diagnosis {

/// Where the assumed size of the variation between days comes from.
enum class DaySource { usual, stated, estimated };

/// Variation between the days of a campaign. Each quantity has a separate deviation on each day.
/// The deviations are independent, with the standard deviations of the quantities.
struct BetweenDays {
  std::vector<calib::DayQuantity> quantities;
  std::vector<std::string> days;  ///< a date, or the text that replaces it
  DaySource source = DaySource::usual;
  double variance = 1.0;  ///< factor on the variances of quantities, from healthy days
  double freedom = metrics::kManyDegrees;  ///< degrees of freedom of that factor
  int dates = 0;                           ///< stated dates of healthy records

  /// Error that the days cause in a coefficient that changes by `effects` per standard deviation.
  double error(double weight, const Eigen::VectorXd& effects) const;
};

/// Day of a condition: its date, if it has one. Otherwise, conditions with use `fit` belong to the
/// day of the fit, and the others to a separate day for each state of the machine.
std::string day_label(const datasets::Condition& condition);

/// How the day of a record differs from the days of its reference: 1 for the day of the record,
/// minus the fraction of the reference recorded on each day. All zero if both are from one day.
struct DayWeights {
  Eigen::VectorXd own;        ///< shape (days)
  Eigen::VectorXd reference;  ///< fractions, shape (days)
  Eigen::VectorXd difference() const { return own - reference; }
  double norm() const { return own.size() > 0 ? difference().norm() : 0.0; }
  /// Norm of the difference for a record from a day on which none of the reference was recorded.
  double norm_of_another_day() const { return std::sqrt(1.0 + reference.squaredNorm()); }
};

/// @param references  conditions of the reference, one for each repeat in it; if empty, the
///                    conditions of the fit
DayWeights day_weights(const BetweenDays& between, const datasets::Campaign& campaign,
                       const datasets::Condition& condition,
                       const std::vector<const datasets::Condition*>& references);

/// Values of the rig in the first condition of a campaign, including the fitted ones.
model::ParameterValues rig_values(const LeakProblem& problem);
/// Shortest sampling interval of the records.
double shortest_interval(const std::vector<datasets::RepeatRecords>& records);

/// Returns the days and quantities of a campaign, with the stated or usual sizes.
///
/// @param values    values of the rig
/// @param sample_s  shortest sampling interval
BetweenDays between_days_of(const datasets::Campaign& campaign,
                            const model::ParameterValues& values, double sample_s);

/// A healthy average that is compared with averages from other days.
struct HealthyDay {
  double coefficient = 0.0;
  double variance = 0.0;       ///< variance of its own error
  double days_variance = 0.0;  ///< variance that the days would cause at the usual sizes
};

/// Minimum number of dates of healthy records from which to estimate the variation between days.
inline constexpr int kLeastHealthyDates = 4;

/// Estimates the factor on the variances from healthy averages: their squares minus the variances
/// of their own errors, divided by what the usual sizes would cause, and weighted by the
/// information in each. Does nothing if the campaign states sizes or has too few dates.
void estimate_days(const std::vector<HealthyDay>& healthy, BetweenDays& between);

/// Describes, in words, how much days are assumed to differ: "records of 2026-03-02: another day
/// than their reference's ...". Empty if no record is from another day.
///
/// @param other_days  days of records that differ from the days of their references
std::string in_words(const BetweenDays& between, const std::vector<std::string>& other_days);

/// Returns an error increased by the contribution of the days.
CoefficientError with_days(CoefficientError error, double days_se, double freedom);

}  // namespace rigcal::diagnosis
