#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/describe.hpp"
#include "common/range.hpp"
#include "diagnosis/machine/machine_state.hpp"

namespace rigcal::diagnosis {

/// The next class limit that a growing leak reaches.
struct NextLimit {
  LeakClass class_ = LeakClass::normal;  ///< the class that begins at the limit
  double percent = 0.0;
  std::string reached, earliest;      ///< dates
  std::optional<std::string> latest;  ///< absent if the limit may never be reached
  /// The same in days since 1970-01-01; not stored.
  double reached_day = 0.0;
  std::optional<double> latest_day = {};
  RIGCAL_DESCRIBE(class_, percent, reached, earliest, latest)
};

/// Change in one machine's leak from date to date.
struct LeakTrend {
  std::optional<std::string> leak_level, specimen;  ///< common to all its states
  std::string sentence;                             ///< for an operator
  int dates = 0;
  std::string first_date, last_date;
  std::string duty;  ///< signal whose share is stated
  double coefficient_per_day = 0.0;
  /// Standard error of coefficient_per_day due to the errors of the states, without `widened`. Not
  /// stored.
  double coefficient_per_day_error = 0.0;
  double share_percent_per_day = 0.0;  ///< slope of the share at the duty, close to the last date
  Range share_percent_per_day_ci95{};
  double p_value = 1.0;      ///< two-sided, for no change
  bool significant = false;  ///< whether the trend is significant at 5 %
  double chi_squared = 0.0;  ///< measure of the variation of the states about the line
  double freedom = 0.0;      ///< degrees of freedom of chi_squared: dates - 2
  double widened = 1.0;  ///< factor on the error; above 1 if the states are too far from the line
  std::optional<NextLimit> next_limit;  ///< present if the leak grows significantly
  RIGCAL_DESCRIBE(leak_level, specimen, sentence, dates, first_date, last_date, duty,
                  coefficient_per_day, share_percent_per_day, share_percent_per_day_ci95, p_value,
                  significant, chi_squared, freedom, widened, next_limit)
};

/// A day is predicted up to this multiple of the observed time span beyond the last date.
inline constexpr double kAhead = 3.0;

/// Describes a trend in a sentence for an operator: "66.66 %: the leak rises by 1.2 percentage
/// points of the servo flow in 30 days ...".
std::string trend_sentence(const LeakTrend& trend);

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
