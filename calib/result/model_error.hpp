#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/record.hpp"
#include "metrics/residual_tests.hpp"

// Signs of model error in the records: errors relative to the noise, differences between repeats,
// and predictions of records that were not fitted.

namespace rigcal::calib {

/// Test of the model error against the pure error for one channel of one condition
/// (lack_of_fit.hpp).
struct LackOfFit : metrics::Judged {
  std::string condition;                                    ///< id of the condition
  datasets::Channel channel = datasets::Channel::position;  ///< key of the channel
  std::string against = "sd";       ///< source of the pure error: "repeats" or "sd"
  double ratio = 0.0;               ///< variance of the residual divided by that of the pure error
  double freedom = 0.0;             ///< effective degrees of freedom of the residual
  double pure_error_freedom = 0.0;  ///< for the pure error; infinite if the campaign states `sd`
  /// Probability that noise alone gives this ratio or a larger one. The outcome takes the number of
  /// tests into account.
  double p = 1.0;
  RIGCAL_DESCRIBE(condition, channel, against, ratio, freedom, pure_error_freedom, p, outcome,
                  reason)

  bool by_repeats() const { return against == "repeats"; }
};

/// The tests of a fit, and their joint result.
struct LackOfFitTests {
  std::optional<bool> misfit;    ///< true if the lack of fit is significant; absent if not judged
  std::vector<LackOfFit> tests;  ///< one per channel with known noise
  RIGCAL_DESCRIBE(misfit, tests)

  bool has(const std::string& condition, datasets::Channel channel) const {
    return std::any_of(tests.begin(), tests.end(), [&](const LackOfFit& test) {
      return test.condition == condition && test.channel == channel;
    });
  }
};

/// Differences between the repeats of the fitted conditions (between_repeats.hpp).
struct BetweenRepeats {
  /// True if the repeats differ significantly (5 %) more than the mean's residuals explain.
  bool differ = false;
  double p = 1.0;  ///< p-value of the most significant parameter, times the number of parameters
  double ratio = 0.0;  ///< largest ratio of the error from the repeats to that from the residuals
  std::vector<std::string> parameters;  ///< parameters whose interval is based on the repeats
  /// Possible cause of the differences: the key of a parameter, or "start". If no cause was found,
  /// this and the next two members are absent.
  std::optional<std::string> cause;
  /// Standard deviation of the cause: relative, or in s for the start.
  std::optional<double> cause_sd;
  std::optional<double> cause_explains;  ///< fraction of the differences that the cause explains
  RIGCAL_DESCRIBE(differ, p, ratio, parameters, cause, cause_sd, cause_explains)
};

/// Prediction of a condition by a fit that did not use its record.
struct HeldOut {
  std::string condition;                         ///< id of the condition
  std::optional<std::string> problem;            ///< why there is no prediction, in words
  Keyed<double, datasets::Channel> rmse;         ///< RMS error of the prediction, SI
  Keyed<double, datasets::Channel> fitted_rmse;  ///< RMS error in the full fit, SI
  /// Largest change in a parameter, in units of its error. 0 if no parameter has an error; absent
  /// if there is no prediction.
  std::optional<double> largest_shift;
  std::optional<std::string> shifted;  ///< the parameter that changes most
  RIGCAL_DESCRIBE(condition, problem, rmse, fitted_rmse, largest_shift, shifted)
};

}  // namespace rigcal::calib
