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

/// Where the size of the variation between days is from.
enum class DaySource { usual, stated, estimated };

/// The variation between the days of a campaign. Each day has a deviation of its own of each
/// quantity; they are independent, with the standard deviations of the quantities.
struct BetweenDays {
  std::vector<calib::DayQuantity> quantities;
  std::vector<std::string> days;  ///< a date, or the text in its place
  DaySource source = DaySource::usual;
  double variance =
      1.0;  ///< factor on the variances of the quantities, estimated from healthy days
  double freedom = metrics::kManyDegrees;  ///< degrees of freedom of that factor
  int dates = 0;                           ///< stated dates of healthy records

  /// Error that the days cause where a coefficient moves by `effects` per standard deviation.
  double error(double weight, const Eigen::VectorXd& effects) const;
};

/// Day of a condition: its date. Without one a condition of use `fit` is of the day of the fit, and
/// the others are of a day of their own for each state of the machine.
std::string day_label(const datasets::Condition& condition);

/// How far the day of a record is from those of its reference: 1 for its own day, less the fraction
/// of the reference that each day has. All zero where both are of one day.
struct DayWeights {
  Eigen::VectorXd own;        ///< shape (days)
  Eigen::VectorXd reference;  ///< fractions, shape (days)
  Eigen::VectorXd difference() const { return own - reference; }
  double norm() const { return own.size() > 0 ? difference().norm() : 0.0; }
  /// The same of a record of a day that the reference does not have.
  double norm_of_another_day() const { return std::sqrt(1.0 + reference.squaredNorm()); }
};

/// @param references  conditions of the reference, one for each of its repeats; empty: the
///                    conditions of the fit
DayWeights day_weights(const BetweenDays& between, const datasets::Campaign& campaign,
                       const datasets::Condition& condition,
                       const std::vector<const datasets::Condition*>& references);

/// The rig's values in the first condition of a campaign, those of the fit among them.
model::ParameterValues rig_values(const LeakProblem& problem);
/// Shortest sampling interval of the records.
double shortest_interval(const std::vector<datasets::RepeatRecords>& records);

/// Days and quantities of a campaign, at the stated or usual sizes.
///
/// @param values    of the rig
/// @param sample_s  shortest sampling interval
BetweenDays between_days_of(const datasets::Campaign& campaign,
                            const model::ParameterValues& values, double sample_s);

/// A healthy average that is compared with those of other days.
struct HealthyDay {
  double coefficient = 0.0;
  double variance = 0.0;       ///< variance of its own error
  double days_variance = 0.0;  ///< that the days would cause at the usual sizes
};

/// Least number of dates of healthy records from which the variation between days is estimated.
inline constexpr int kLeastHealthyDates = 4;

/// Takes the factor on the variances from healthy averages: their squares less their own errors,
/// over what the usual sizes would cause, weighted by the information in each. Unless the campaign
/// states sizes, or has too few dates.
void estimate_days(const std::vector<HealthyDay>& healthy, BetweenDays& between);

/// What was taken, in words: "records of 2026-03-02 are of another day than the reference ...".
/// Empty where no record is of another day.
///
/// @param other_days  conditions of another day than their reference
std::string in_words(const BetweenDays& between, const std::vector<std::string>& other_days);

/// The error with that by the days.
CoefficientError with_days(CoefficientError error, double days_se, double freedom);

}  // namespace rigcal::diagnosis
