#include "metrics/residual_tests.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

#include "metrics/autoregression.hpp"
#include "metrics/distributions.hpp"
#include "metrics/shared_transform.hpp"

namespace rigcal::metrics {
namespace {

using Complex = std::complex<double>;

/// Minimum number of samples. A fifth of them are used as lags, which leaves three to test.
constexpr std::size_t kLeastSamples = 16;
constexpr int kTestedLags = 25;

/// 95 % of the autocorrelations of n samples of white noise are within plus or minus this value.
double white_band(double n) { return kNormal95 / std::sqrt(n); }

void conclude(Judged& test, Judged found) { test = std::move(found); }

double two_sided_p(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

std::vector<double> centred(std::span<const double> values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  std::vector<double> result(values.begin(), values.end());
  for (double& value : result) value -= mean;
  return result;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

/// Transforms `values`, padded with zeros to a power of two, so that correlations do not wrap
/// around.
std::vector<Complex> padded_transform(std::vector<double> values) {
  std::size_t length = 1;
  while (length < 2 * values.size()) length *= 2;
  values.resize(length, 0.0);
  std::vector<Complex> result;
  shared_transform().fwd(result, values);
  return result;
}

/// Returns sum_t a(t) b(t - lag) at [lag modulo the length], given the transforms of a and b.
std::vector<double> lagged_products(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  std::vector<Complex> product(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) product[i] = a[i] * std::conj(b[i]);
  std::vector<double> result;
  shared_transform().inv(result, product);
  return result;
}

/// Number of lags to plot for the correlations: four times the lag at which they first enter the
/// band.
std::size_t shown_lags(const std::vector<double>& rho, double band) {
  const std::size_t most = rho.size() / 2;
  std::size_t fall = 1;
  while (fall < most && rho[fall] > band) ++fall;
  return std::min(most, std::max<std::size_t>(4 * fall, 50));
}

/// Keeps every k-th value, so that about 200 values or fewer remain. The value at lag zero is kept.
///
/// @param centre  index of lag zero
Correlogram thinned(std::span<const double> values, std::size_t centre, double band,
                    double sample_interval_s) {
  constexpr std::size_t kMost = 200;
  const std::size_t stride = values.size() / kMost + 1;
  Correlogram result;
  result.first_lag_s =
      (static_cast<double>(centre % stride) - static_cast<double>(centre)) * sample_interval_s;
  result.lag_step_s = static_cast<double>(stride) * sample_interval_s;
  result.band = band;
  for (std::size_t i = centre % stride; i < values.size(); i += stride)
    result.values.push_back(values[i]);
  return result;
}

/// @param lags  number of lags in the curve
Autocorrelation test_autocorrelation(const std::vector<double>& e, const std::vector<double>& rho,
                                     std::size_t lags, double interval_s, ResidualCurves& curves) {
  const auto n = static_cast<double>(e.size());
  const double band = white_band(n);
  Autocorrelation result;
  curves.autocorrelation = thinned(std::span(rho).first(lags + 1), 0, band, interval_s);
  constexpr std::size_t kPartialLags = 50;  // enough to show the order of a model
  curves.partial_autocorrelation = Correlogram{
      interval_s,
      interval_s,
      band,
      {},
      partial_autocorrelations(std::span(rho).first(std::min(rho.size() / 2, kPartialLags) + 1))};
  result.tested_lags = std::min<int>(kTestedLags, static_cast<int>(e.size() / 5));
  double sum = 0.0;
  for (int k = 1; k <= result.tested_lags; ++k) {
    const double r = rho[static_cast<std::size_t>(k)];
    sum += r * r / (n - k);
  }
  result.ljung_box = n * (n + 2.0) * sum;
  result.p_value = chi_squared_exceedance(result.ljung_box, result.tested_lags);
  double steps = 0.0;
  for (std::size_t i = 1; i < e.size(); ++i) steps += (e[i] - e[i - 1]) * (e[i] - e[i - 1]);
  result.durbin_watson = steps / (n * mean_square(e));
  std::size_t fall = 1;
  while (fall < e.size() && rho[fall] > band) ++fall;
  result.correlation_time_s = fall == 1 ? 0.0 : static_cast<double>(fall) * interval_s;
  conclude(result, judge(result.p_value < kWarningLevel,
                         {n, band, kLargestUsefulBound, "an autocorrelation"}));
  return result;
}

/// @param transform  padded transform of e
std::optional<CrossCorrelation> test_cross_correlation(const std::vector<double>& e,
                                                       const std::vector<Complex>& transform,
                                                       const std::vector<double>& u,
                                                       std::size_t lags, double effective,
                                                       double interval_s, ResidualCurves& curves) {
  const double scale =
      static_cast<double>(e.size()) * std::sqrt(mean_square(e)) * std::sqrt(mean_square(u));
  if (!(scale > 0.0) || !std::isfinite(scale)) return std::nullopt;
  const std::vector<double> products = lagged_products(transform, padded_transform(u));
  CrossCorrelation result;
  std::vector<double> values(2 * lags + 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t at = i >= lags ? i - lags : products.size() + i - lags;
    values[i] = products[at] / scale;
    if (std::abs(values[i]) > std::abs(result.peak)) {
      result.peak = values[i];
      result.peak_lag_s = (static_cast<double>(i) - static_cast<double>(lags)) * interval_s;
    }
  }
  const double tests = std::min(static_cast<double>(values.size()), effective);
  result.limit = normal_quantile(1.0 - 0.5 * kWarningLevel / tests) / std::sqrt(effective);
  conclude(result,
           judge(std::abs(result.peak) > result.limit,
                 {effective, result.limit, kLargestUsefulBound, "a correlation with the input"}));
  curves.cross_correlation = thinned(values, lags, white_band(effective), interval_s);
  curves.cross_correlation->band_of_peak = result.limit;
  return result;
}

struct Lines {
  std::vector<double> power;  ///< from the first line above zero to half the sampling rate
  double spacing = 0.0;       ///< in cycles per sample
};

Lines line_powers(const std::vector<double>& e) {
  std::vector<double> values = e;
  // Few lengths are powers of two. Eigen transforms any length with small prime factors, and
  // omitting a few samples does not change a spectrum.
  const auto smooth = [](std::size_t n) {
    for (const std::size_t prime : {2U, 3U, 5U}) {
      while (n % prime == 0) n /= prime;
    }
    return n == 1;
  };
  while (!smooth(values.size())) values.pop_back();
  std::vector<Complex> spectrum;
  shared_transform().fwd(spectrum, values);
  std::vector<double> power(values.size() / 2);
  for (std::size_t k = 1; k <= power.size(); ++k) power[k - 1] = std::norm(spectrum[k]);
  return {std::move(power), 1.0 / static_cast<double>(values.size())};
}

Periodogram test_periodogram(const std::vector<double>& e, double interval_s,
                             ResidualCurves& curves) {
  const auto [power, spacing] = line_powers(e);
  const double lines = static_cast<double>(power.size());
  const double line_hz = spacing / interval_s;
  double total = 0.0;
  for (const double p : power) total += p;
  Periodogram result;
  constexpr std::size_t kSteps = 50;  // number of steps in the cumulative curve, for plots
  std::vector<double> cumulative{0.0};
  double sum = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    // Between two lines the curve is interpolated.
    while (cumulative.size() <= kSteps) {
      const double at = static_cast<double>(cumulative.size()) * lines / kSteps;
      if (at > static_cast<double>(k + 1)) break;
      cumulative.push_back((sum + power[k] * (at - static_cast<double>(k))) / total);
    }
    sum += power[k];
    const double share = sum / total;
    const auto rank = static_cast<double>(k + 1);
    result.distance = std::max(result.distance, std::abs(share - rank / lines));
    if (share >= 0.5 && result.median_frequency_hz == 0.0)
      result.median_frequency_hz = rank * line_hz;
  }
  // Kolmogorov and Smirnov's distance. Bartlett, An Introduction to Stochastic Processes, 1955.
  result.limit = 1.358 / std::sqrt(std::max(1.0, lines - 1.0));
  conclude(result, judge(result.distance > result.limit,
                         {static_cast<double>(e.size()), result.limit, kLargestUsefulBound,
                          "a departure from a flat spectrum"}));
  curves.cumulative_periodogram =
      CumulativePower{lines * line_hz, result.limit, std::move(cumulative)};
  const auto peak = static_cast<std::size_t>(
      std::distance(power.begin(), std::max_element(power.begin(), power.end())));
  result.peak_frequency_hz = static_cast<double>(peak + 1) * line_hz;
  for (std::size_t k = peak > 0 ? peak - 1 : 0; k <= std::min(peak + 1, power.size() - 1); ++k)
    result.peak_share += power[k] / total;
  // By Parseval's theorem all lines together give the mean square.
  const double density = mean_square(e) / (total * line_hz);
  constexpr double kBinsPerDecade = 30.0;  // for plots, like the points below
  for (std::size_t k = 0; k < power.size();) {
    const double upper = static_cast<double>(k + 1) * std::pow(10.0, 1.0 / kBinsPerDecade);
    double mean = 0.0;
    std::size_t last = k;
    while (last < power.size() && (last == k || static_cast<double>(last + 1) < upper))
      mean += power[last++];
    const auto count = static_cast<double>(last - k);
    curves.periodogram.frequency_hz.push_back(static_cast<double>(k + 1 + last) * 0.5 * line_hz);
    curves.periodogram.density.push_back(mean / count * density);
    k = last;
  }
  return result;
}

Normality test_normality(const std::vector<double>& e, double effective, Quantiles& curve) {
  const double sd = std::sqrt(mean_square(e));
  const auto n = static_cast<double>(e.size());
  Normality result;
  for (const double value : e) {
    const double z = value / sd;
    result.skewness += z * z * z / n;
    result.excess_kurtosis += z * z * z * z / n;
  }
  result.excess_kurtosis -= 3.0;
  result.jarque_bera =
      effective / 6.0 *
      (result.skewness * result.skewness + 0.25 * result.excess_kurtosis * result.excess_kurtosis);
  result.p_value = std::exp(-0.5 * result.jarque_bera);
  // Excess kurtosis that alone raises the statistic to the 5 % point of chi-square with two
  // degrees of freedom.
  const double kurtosis = std::sqrt(-2.0 * std::log(kWarningLevel) * 24.0 / effective);
  conclude(result, judge(result.p_value < kWarningLevel,
                         {effective, kurtosis, kLargestUsefulKurtosis, "an excess kurtosis"}));
  std::vector<double> sorted = e;
  std::sort(sorted.begin(), sorted.end());
  // Equal steps of the normal quantile show the tails as well as the middle.
  const double last = -normal_quantile(0.5 / n);
  constexpr int kPoints = 61;
  for (int i = 0; i < kPoints; ++i) {
    const double q = last * (2.0 * i / (kPoints - 1) - 1.0);
    const double rank = 0.5 * std::erfc(-q / std::sqrt(2.0)) * n - 0.5;
    const auto at = static_cast<std::size_t>(std::clamp(std::round(rank), 0.0, n - 1.0));
    curve.normal_quantile.push_back(q);
    curve.residual_quantile.push_back(sorted[at] / sd);
  }
  return result;
}

Drift test_drift(std::span<const double> residual, const std::vector<double>& e, double effective,
                 double interval_s) {
  const auto n = static_cast<double>(e.size());
  const double sd = std::sqrt(mean_square(e));
  Drift result;
  result.mean = residual[0] - e[0];
  double slope = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i)
    slope += e[i] * (static_cast<double>(i) - 0.5 * (n - 1.0));
  const double variance_of_time = (n * n - 1.0) / 12.0;
  slope /= n * variance_of_time;
  result.slope_per_s = slope / interval_s;
  const double error_of_mean = sd / std::sqrt(effective);
  result.mean_p_value = two_sided_p(result.mean / error_of_mean);
  result.slope_p_value = two_sided_p(slope * std::sqrt(variance_of_time) / error_of_mean);
  // These are two tests, so each is at half the level. In units of the standard deviation, both
  // bounds are bounds for a correlation: with a constant, and with time.
  const double level = 0.5 * kWarningLevel;
  conclude(result, judge(result.mean_p_value < level || result.slope_p_value < level,
                         {effective, normal_quantile(1.0 - 0.5 * level) / std::sqrt(effective),
                          kLargestUsefulBound, "an offset or trend, in standard deviations,"}));
  return result;
}

}  // namespace

double effective_sample_size(std::span<const double> rho) {
  const auto n = static_cast<double>(rho.size());
  // A correlation within the band for white noise counts as zero.
  if (rho.size() < 2 || rho[1] <= white_band(n)) return n;
  double sum = 0.0;
  for (std::size_t k = 1; k < rho.size() && rho[k] > 0.0; ++k) sum += rho[k];
  return std::max(1.0, n / (1.0 + 2.0 * sum));
}

TestedResidual residual_tests(std::span<const double> residual, std::span<const double> input,
                              double sample_interval_s) {
  if (residual.size() < kLeastSamples)
    throw std::invalid_argument("residual_tests: fewer than 16 samples");
  if (!input.empty() && input.size() != residual.size())
    throw std::invalid_argument("residual_tests: input and residual differ in size");
  if (!(sample_interval_s > 0.0) || !std::isfinite(sample_interval_s))
    throw std::invalid_argument("residual_tests: the sample interval must be positive");
  const auto finite = [](std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  if (!finite(residual) || !finite(input))
    throw std::invalid_argument("residual_tests: a value is not finite");

  const std::vector<double> e = centred(residual);
  double largest = 0.0;
  for (const double value : residual) largest = std::max(largest, std::abs(value));
  const double variance = mean_square(e);
  // A standard deviation below this is due to rounding of the mean.
  const double least = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  if (!(variance > least * least)) throw std::domain_error("the residual is constant");

  TestedResidual result;
  result.samples = static_cast<long>(e.size());
  result.std = std::sqrt(variance);
  result.sample_interval_s = sample_interval_s;
  const std::vector<Complex> transform = padded_transform(e);
  std::vector<double> rho = lagged_products(transform, transform);
  rho.resize(e.size());
  for (double& value : rho) value /= static_cast<double>(e.size()) * variance;

  const std::size_t lags = shown_lags(rho, white_band(static_cast<double>(e.size())));
  result.autocorrelation = test_autocorrelation(e, rho, lags, sample_interval_s, result.curves);
  result.effective_samples = effective_sample_size(rho);
  if (!input.empty()) {
    result.cross_correlation =
        test_cross_correlation(e, transform, centred(input), lags, result.effective_samples,
                               sample_interval_s, result.curves);
  }
  result.periodogram = test_periodogram(e, sample_interval_s, result.curves);
  result.normality = test_normality(e, result.effective_samples, result.curves.normality);
  result.drift = test_drift(residual, e, result.effective_samples, sample_interval_s);
  return result;
}

}  // namespace rigcal::metrics
