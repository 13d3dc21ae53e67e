#pragma once

#include <optional>
#include <vector>

namespace rigcal::datasets {

/// Delay of one record against another.
struct Lag {
  double samples = 0.0;      ///< positive if the second record is late
  double sd_samples = 0.0;   ///< its standard deviation for white noise in both records
  double correlation = 0.0;  ///< height of the peak of the normalised cross-correlation
};

/// Delay of b against a: the maximum of the normalised cross-correlation, found between samples.
///
/// Both records are smoothed by the same Gaussian, of the width that promises the smallest standard
/// deviation: a delay passes through it unchanged, the noise does not. Of the peaks of a periodic
/// record that noise cannot tell apart the one of the smallest |lag| counts, so that no period is
/// ever jumped.
///
/// @param a, b     same sampling, any lengths; values finite
/// @param max_lag  [samples], > 0; no more than a third of the shorter record is searched
/// @return         empty: a record is constant, too short (64 samples), unlike the other, a
/// sinusoid
///                 above 0.35 of the sample rate (its periods cannot be told apart), or the maximum
///                 lies at the edge of the search
std::optional<Lag> find_lag(const std::vector<double>& a, const std::vector<double>& b,
                            int max_lag);

/// The same for several records against one, which is smoothed once for all of them.
std::vector<std::optional<Lag>> find_lags(const std::vector<double>& a,
                                          const std::vector<const std::vector<double>*>& others,
                                          int max_lag);

}  // namespace rigcal::datasets
