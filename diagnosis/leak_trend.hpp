#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/range.hpp"
#include "diagnosis/machine_state.hpp"

namespace rigcal::diagnosis {

/// Change in one machine's leak from date to date.
struct LeakTrend {
  std::string leak_level, specimen;  ///< common to all its states; empty if not stated
  std::string duty;                  ///< signal whose share is stated
  int first_day = 0, last_day = 0;   ///< days since 1970-01-01
  int dates = 0;
  double coefficient_per_day = 0.0;
  /// Standard error of coefficient_per_day due to the errors of the states, without `widened`.
  double coefficient_per_day_error = 0.0;
  double share_per_day = 0.0;  ///< slope of the share at the duty, close to the last date
  Range share_per_day_ci95{};
  double p = 1.0;            ///< two-sided p-value for no change
  bool significant = false;  ///< whether the trend is significant at 5 %
  double chi_squared = 0.0;  ///< measure of the variation of the states about the line
  double freedom = 0.0;      ///< degrees of freedom of chi_squared: dates - 2
  double widened = 1.0;  ///< factor on the error; above 1 if the states are too far from the line
  /// Set if the leak grows significantly: the next limit above the share on the last date, and the
  /// day on which the line reaches it, with the days for the ends of the interval. If `latest_day`
  /// is absent, the limit may never be reached.
  std::optional<LeakClass> next_class;
  double next_limit = 0.0;
  double reached_day = 0.0;
  double earliest_day = 0.0;
  std::optional<double> latest_day;
};

/// Returns the trend of every machine that was diagnosed on three or more dates, in order of
/// appearance. States with the same leak level and specimen belong to the same machine.
///
/// The trend is metrics::weighted_trend() of the coefficients. Each coefficient has its own error,
/// and all share the error due to the rig's parameters. The covariance also includes day-to-day
/// differences. If it does, the trend counts as one whose days are counted.
///
/// @param rig_covariance  covariance of the rig's parameters, shape (rig_moves)^2
/// @param variance        variance between days, relative to the squares of PooledLeak::day_moves
std::vector<LeakTrend> leak_trends(const std::vector<MachineState>& states,
                                   const Eigen::MatrixXd& rig_covariance,
                                   const datasets::DiagnosisSettings& settings,
                                   const DayVariance& variance = {});

/// Lists, in words, the machines that were diagnosed on only two dates. They get no trend, because
/// the difference could be the usual one between two days.
std::vector<std::string> too_few_dates(const std::vector<MachineState>& states);

}  // namespace rigcal::diagnosis
