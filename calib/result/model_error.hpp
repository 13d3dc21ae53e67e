#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/record.hpp"
#include "metrics/residual_tests.hpp"

// Model errors that the records show: error relative to the noise, differences between repeats,
// predictions of omitted records.

namespace rigcal::calib {

/// Model error of one channel of one condition against its pure error (lack_of_fit.hpp).
struct LackOfFit : metrics::Judged {
  std::string condition;
  datasets::Channel channel = datasets::Channel::position;
  double ratio = 0.0;         ///< variance of the residual over that of the pure error
  double freedom = 0.0;       ///< effective degrees of freedom of the residual
  double pure_freedom = 0.0;  ///< and of the pure error; infinite where `sd` states it
  bool by_repeats = false;    ///< pure error from repeats; else from `sd`
  /// Probability of such a ratio, or a larger one, of noise alone. The outcome is that of all tests
  /// together.
  double p = 1.0;
};

/// Differences between the repeats of the fitted conditions (between_repeats.hpp).
struct BetweenRepeats {
  bool differ = false;  ///< beyond the residuals of their mean, at 5 %
  double p = 1.0;       ///< for the most significant parameter, times the number of parameters
  double ratio = 0.0;   ///< largest of error by the repeats over error by the residuals
  std::vector<std::string> parameters;  ///< parameters whose interval is based on the repeats
  std::string cause;      ///< that would explain it: key of a parameter, or "start"; empty: none
  double cause_sd = 0.0;  ///< standard deviation of the cause: relative; in s for the start
  double cause_explains = 0.0;  ///< share of how the repeats differ, 0 to 1
};

/// A condition that was left out of the fit and predicted by it.
struct HeldOut {
  std::string condition;
  std::string problem;  ///< why there is no prediction, in words; empty if there is one
  std::vector<std::pair<datasets::Channel, double>> rms;         ///< error of the prediction, SI
  std::vector<std::pair<datasets::Channel, double>> fitted_rms;  ///< in its own fit, SI
  double largest_shift = 0.0;  ///< largest change of a parameter, in its error; 0 if none has one
  std::string shifted;         ///< the parameter that changes most
};

}  // namespace rigcal::calib
