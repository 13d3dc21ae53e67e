#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/range.hpp"
#include "diagnosis/machine_state.hpp"

namespace rigcal::diagnosis {

/// Change of one machine's leak from date to date.
struct LeakTrend {
  std::string leak_level, specimen;  ///< common to its states; empty if not stated
  std::string duty;                  ///< signal whose share is stated
  int first_day = 0, last_day = 0;   ///< since 1970-01-01
  int dates = 0;
  double coefficient_per_day = 0.0;
  double share_per_day = 0.0;  ///< at the duty, close to the last date
  Range share_per_day_ci95{};
  double p = 1.0;            ///< p-value, two-sided, for no change
  bool significant = false;  ///< at 5 %
  double chi_squared = 0.0;  ///< variation of the states around the line
  double freedom = 0.0;      ///< dates - 2
  double widened = 1.0;      ///< factor on the error; above 1 if states are too far from the line
  /// Set if the leak rises significantly: the next limit above its share on the last date, and the
  /// day on which the line reaches it, with the days for the ends of the interval. An open end
  /// means never.
  std::optional<LeakClass> next_class;
  double next_limit = 0.0;
  double reached_day = 0.0;
  double earliest_day = 0.0;
  std::optional<double> latest_day;
};

/// Returns the trend of every machine that was diagnosed on three or more dates, in order of
/// appearance. A machine consists of the states with one leak level and specimen.
///
/// The trend is metrics::weighted_trend() of the coefficients. Each coefficient has its own error,
/// and all share the error from the rig's parameters. The covariance also includes differences
/// between days.
///
/// @param rig_covariance  covariance of the rig's parameters, shape (rig_moves)^2
/// @param days_factor     variance between days relative to the squares of PooledLeak::day_moves
std::vector<LeakTrend> leak_trends(const std::vector<MachineState>& states,
                                   const Eigen::MatrixXd& rig_covariance,
                                   const datasets::DiagnosisSettings& settings,
                                   double days_factor = 0.0);

/// Lists, in words, machines that were diagnosed on only two dates. They get no trend, because
/// their difference could be the usual one between two days.
std::vector<std::string> too_few_dates(const std::vector<MachineState>& states);

}  // namespace rigcal::diagnosis
