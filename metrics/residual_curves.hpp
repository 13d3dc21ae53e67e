#pragma once

#include <optional>
#include <vector>

#include "common/describe.hpp"

// The curves behind the residual tests, thinned for drawing.

namespace rigcal::metrics {

/// An autocorrelation or cross-correlation at equally spaced lags.
struct Correlogram {
  double first_lag_s = 0.0, lag_step_s = 0.0;
  double band = 0.0;               ///< 95 % band for a single lag
  Omittable<double> band_of_peak;  ///< 95 % bound for the largest of all lags
  std::vector<double> values;
  RIGCAL_DESCRIBE(first_lag_s, lag_step_s, band, band_of_peak, values)
};

/// Mean one-sided power density [unit^2/Hz] in logarithmic bins, shape (bins).
struct Spectrum {
  std::vector<double> frequency_hz, density;
  RIGCAL_DESCRIBE(frequency_hz, density)
};

/// Quantiles of (e - mean) / std and those of the standard normal distribution, shape (points).
struct Quantiles {
  std::vector<double> normal_quantile, residual_quantile;
  RIGCAL_DESCRIBE(normal_quantile, residual_quantile)
};

/// Fraction of the power up to each frequency, shape (51). The frequencies are equally spaced from
/// zero. For white noise it is a straight line from 0 to 1.
struct CumulativePower {
  double last_frequency_hz = 0.0;  ///< half the sampling rate
  double limit = 0.0;              ///< 5 % critical distance from the line of white noise
  std::vector<double> fraction;
  RIGCAL_DESCRIBE(last_frequency_hz, limit, fraction)
};

struct ResidualCurves {
  Correlogram autocorrelation;  ///< from lag 0; biased estimate
  /// corr(e(t), u(t - lag)) on both sides of lag 0; absent if the input is constant.
  std::optional<Correlogram> cross_correlation;
  Spectrum periodogram;
  Quantiles normality;
  /// From lag 1, at most 50 lags, not thinned: the order of a model is the number of the last lag
  /// beyond the band.
  Later<std::optional<Correlogram>> partial_autocorrelation;
  Later<std::optional<CumulativePower>> cumulative_periodogram;
  RIGCAL_DESCRIBE(autocorrelation, cross_correlation, periodogram, normality,
                  partial_autocorrelation, cumulative_periodogram)
};

}  // namespace rigcal::metrics
