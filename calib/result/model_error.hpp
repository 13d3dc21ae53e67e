#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/record.hpp"
#include "metrics/residual_tests.hpp"

// Model errors that the records show: error relative to the noise, differences between repeats,
// predictions of omitted records.

namespace rigcal::calib {

/// Model error of one channel of one condition against its pure error (lack_of_fit.hpp).
struct LackOfFit : metrics::Judged {
  std::string condition;
  datasets::Channel channel = datasets::Channel::position;
  std::string against = "sd";       ///< source of the pure error: "repeats" or "sd"
  double ratio = 0.0;               ///< variance of the residual over that of the pure error
  double freedom = 0.0;             ///< effective degrees of freedom of the residual
  double pure_error_freedom = 0.0;  ///< and of the pure error; infinite where `sd` states it
  /// Probability of such a ratio, or a larger one, of noise alone. The outcome is that of all tests
  /// together.
  double p = 1.0;
  RIGCAL_DESCRIBE(condition, channel, against, ratio, freedom, pure_error_freedom, p, outcome,
                  reason)

  bool by_repeats() const { return against == "repeats"; }
};

/// Differences between the repeats of the fitted conditions (between_repeats.hpp).
struct BetweenRepeats {
  bool differ = false;  ///< beyond the residuals of their mean, at 5 %
  double p = 1.0;       ///< for the most significant parameter, times the number of parameters
  double ratio = 0.0;   ///< largest of error by the repeats over error by the residuals
  std::vector<std::string> parameters;  ///< parameters whose interval is based on the repeats
  /// What would explain it: key of a parameter, or "start". Absent: nothing would, as the two
  /// below.
  std::optional<std::string> cause;
  std::optional<double> cause_sd;        ///< standard deviation of it: relative; in s for the start
  std::optional<double> cause_explains;  ///< fraction of the differences that it explains
  RIGCAL_DESCRIBE(differ, p, ratio, parameters, cause, cause_sd, cause_explains)
};

/// A condition that was left out of the fit and predicted by it.
struct HeldOut {
  std::string condition;
  std::optional<std::string> problem;            ///< why there is no prediction, in words
  Keyed<double, datasets::Channel> rmse;         ///< error of the prediction, SI
  Keyed<double, datasets::Channel> fitted_rmse;  ///< in its own fit, SI
  /// Largest change of a parameter, in its error; 0 if none has one, absent without a prediction.
  std::optional<double> largest_shift;
  std::optional<std::string> shifted;  ///< the parameter that changes most
  RIGCAL_DESCRIBE(condition, problem, rmse, fitted_rmse, largest_shift, shifted)
};

}  // namespace rigcal::calib
