#pragma once

#include <optional>
#include <vector>

namespace rigcal::datasets {

/// Delay of one record relative to another.
struct Lag {
  double samples = 0.0;      ///< positive if the second record is late
  double sd_samples = 0.0;   ///< standard deviation of the delay, for white noise in both records
  double correlation = 0.0;  ///< height of the peak of the normalised cross-correlation
};

/// Finds the delay of b relative to a: the maximum of the normalised cross-correlation, located
/// between samples.
///
/// Both records are smoothed with the same Gaussian, which reduces noise and does not change the
/// delay. Its width is chosen to minimise the standard deviation. Among the peaks of a periodic
/// record that noise makes indistinguishable, the one with the smallest lag is taken, so that no
/// period is ever skipped.
///
/// @param a, b  same sampling, any lengths, finite values
/// @param max_lag  [samples], > 0; at most a third of the shorter record is searched
/// @return  std::nullopt if a record is constant, too short (below 64 samples), too unlike the
///          other, or a sinusoid above 0.35 of the sample rate (its periods are indistinguishable),
///          or if the maximum is at the edge of the search range
std::optional<Lag> find_lag(const std::vector<double>& a, const std::vector<double>& b,
                            int max_lag);

/// Finds the delays of several records relative to `a`, which is smoothed only once for all of
/// them.
std::vector<std::optional<Lag>> find_lags(const std::vector<double>& a,
                                          const std::vector<const std::vector<double>*>& others,
                                          int max_lag);

}  // namespace rigcal::datasets
