#include "datasets/prepare/lag.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "datasets/prepare/lag_sums.hpp"

namespace rigcal::datasets {
namespace {

// Number of lags beyond the search range that are needed to interpolate a peak at its edge.
constexpr int kMargin = 4;

// Fraction of the sample rate. The peaks of a faster sinusoid are so close together, with so few
// samples on each, that noise decides which one is nearest.
constexpr double kFastest = 0.35;

constexpr int kShortest = 64;

/// A record, with the sums of its first i values and of their squares, i = 0..n.
struct Trace {
  explicit Trace(std::vector<double> values)
      : x(std::move(values)), sum(x.size() + 1), squares(x.size() + 1) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum[i + 1] = sum[i] + x[i];
      squares[i + 1] = squares[i] + x[i] * x[i];
    }
  }

  std::vector<double> x;
  std::vector<double> sum;
  std::vector<double> squares;
};

Trace without_mean(const std::vector<double>& x) {
  const Eigen::Map<const Eigen::VectorXd> map(x.data(), static_cast<Eigen::Index>(x.size()));
  const double mean = x.empty() ? 0.0 : map.mean();
  std::vector<double> centred(x.size());
  std::transform(x.begin(), x.end(), centred.begin(), [&](double value) { return value - mean; });
  return Trace(std::move(centred));
}

/// Pearson's correlation of the overlap at each lag in a range; 0 if one of the two is constant.
struct Correlation {
  int first_lag = 0;
  std::vector<double> r;

  int last_lag() const { return first_lag + static_cast<int>(r.size()) - 1; }
  double at(int lag) const { return r[static_cast<std::size_t>(lag - first_lag)]; }
};

/// Returns the sum of products over the overlap, at each lag in a range.
std::vector<double> products(const Trace& a, const Trace& b, int first_lag, int last_lag) {
  std::vector<double> result;
  if (first_lag < 0) {
    result = shifted_products(b.x, a.x, std::max(1, -last_lag), -first_lag);
    std::reverse(result.begin(), result.end());
  }
  if (last_lag >= 0) {
    const auto late = shifted_products(a.x, b.x, std::max(0, first_lag), last_lag);
    result.insert(result.end(), late.begin(), late.end());
  }
  return result;
}

Correlation correlate(const Trace& a, const Trace& b, int first_lag, int last_lag) {
  const std::vector<double> product = products(a, b, first_lag, last_lag);
  const auto size_a = static_cast<long>(a.x.size());
  const auto size_b = static_cast<long>(b.x.size());
  const auto over = [](const std::vector<double>& sums, long begin, long end) {
    return sums[static_cast<std::size_t>(end)] - sums[static_cast<std::size_t>(begin)];
  };
  Correlation result{first_lag, {}};
  for (int lag = first_lag; lag <= last_lag; ++lag) {
    const long begin = std::max(0, -lag);
    const long end = std::min(size_a, size_b - lag);
    const auto n = static_cast<double>(end - begin);
    const double total_a = over(a.sum, begin, end);
    const double total_b = over(b.sum, begin + lag, end + lag);
    const double variance_a = over(a.squares, begin, end) - total_a * total_a / n;
    const double variance_b = over(b.squares, begin + lag, end + lag) - total_b * total_b / n;
    const double covariance =
        product[static_cast<std::size_t>(lag - first_lag)] - total_a * total_b / n;
    // In a constant overlap, rounding leaves a small fraction of the whole record's energy.
    const bool constant =
        variance_a <= 1e-12 * a.squares.back() || variance_b <= 1e-12 * b.squares.back();
    result.r.push_back(constant ? 0.0 : covariance / std::sqrt(variance_a * variance_b));
  }
  return result;
}

/// Returns the cosine of the phase advance per sample of a sinusoid with this correlation.
double cosine_at(const Correlation& c, int lag) {
  return (c.at(lag - 1) + c.at(lag + 1)) / (2.0 * c.at(lag));
}

/// A maximum of the correlation, located between lags.
struct Peak {
  double lag = 0.0;
  double height = 0.0;
};

/// Returns the peak at a lag that is higher than its neighbours, interpolated exactly for a
/// sinusoid. A peak half way between two lags must look neither lower nor nearer than one at a
/// whole lag.
Peak peak_at(const Correlation& c, int lag) {
  const double r = c.at(lag);
  const Peak sample{static_cast<double>(lag), r};
  if (lag == c.first_lag || lag == c.last_lag()) return sample;
  const double before = c.at(lag - 1);
  const double after = c.at(lag + 1);
  if (r <= 0.0 || r < before || r < after) return sample;
  const double cosine = cosine_at(c, lag);
  const double sine_squared = 1.0 - cosine * cosine;
  if (sine_squared < 1e-12) return sample;
  const double quadrature = (after - before) / (2.0 * std::sqrt(sine_squared));
  return {lag + std::atan2(quadrature, r) / std::acos(cosine),
          std::min(1.0, std::hypot(r, quadrature))};
}

/// Chooses a whole lag: among the peaks that are practically as high as the highest, the one
/// nearest to zero. Two maxima are different peaks only if there is a real valley between them, not
/// just the ripple that noise leaves on a flat top.
int peak_lag(const Correlation& c, int samples) {
  std::vector<Peak> peaks;
  for (int lag = c.first_lag; lag <= c.last_lag(); ++lag) peaks.push_back(peak_at(c, lag));
  const auto peak = [&](int lag) { return peaks[static_cast<std::size_t>(lag - c.first_lag)]; };
  double highest = -1.0;
  for (const Peak& each : peaks) highest = std::max(highest, each.height);
  // Incomplete periods at the ends of the overlap change a height by about 1 / samples.
  const double tolerance = 0.5 * (1.0 - highest) + std::max(1e-4, 2.0 / samples);
  std::optional<int> nearest;
  std::optional<int> top;
  const auto close_peak = [&] {
    if (top && (!nearest || std::abs(peak(*top).lag) < std::abs(peak(*nearest).lag))) nearest = top;
    top.reset();
  };
  for (int lag = c.first_lag; lag <= c.last_lag(); ++lag) {
    if (peak(lag).height < highest - 3.0 * tolerance) close_peak();
    if (peak(lag).height < highest - tolerance) continue;
    if (!top || c.at(lag) > c.at(*top)) top = lag;
  }
  close_peak();
  return *nearest;
}

/// Returns the number of lags from the peak to where the correlation has fallen by 0.1, or to the
/// end of the search range.
int half_width(const Correlation& c, int peak) {
  int width = 0;
  while (peak - width > c.first_lag && peak + width < c.last_lag() &&
         std::min(c.at(peak - width), c.at(peak + width)) > c.at(peak) - 0.1)
    ++width;
  return width;
}

/// Smooths with a Gaussian, and drops the ends that the kernel does not cover.
Trace smooth(const Trace& trace, double sd_samples) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(4.0 * sd_samples));
  Eigen::VectorXd kernel(2 * reach + 1);
  for (Eigen::Index j = -reach; j <= reach; ++j) {
    const double z = static_cast<double>(j) / sd_samples;
    kernel[j + reach] = std::exp(-0.5 * z * z);
  }
  kernel /= kernel.sum();
  return Trace(weighted_sums(trace.x, {kernel.data(), static_cast<std::size_t>(kernel.size())}));
}

/// Slope and curvature of the correlation between samples. The interpolation uses a Gaussian with a
/// standard deviation of one sample (its aliasing is exp(-2 pi^2), 3e-9).
struct Shape {
  double slope = 0.0;
  double curvature = 0.0;
};

Shape shape_at(const Correlation& c, double lag) {
  const auto centre = static_cast<int>(std::lround(lag));
  Shape shape;
  for (int k = centre - kMargin; k <= centre + kMargin; ++k) {
    const double z = lag - k;
    const double weight =
        std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi) * (c.at(k) - c.at(centre));
    shape.slope -= z * weight;
    shape.curvature += (z * z - 1.0) * weight;
  }
  return shape;
}

/// The significant peak at which the refinement starts.
struct Coarse {
  int peak = 0;       ///< lag of the peak
  int hill = 0;       ///< half width of the peak, in lags
  double height = 0;  ///< height of the peak
  int shorter = 0;    ///< number of samples in the shorter record
};

/// Refines the lag around the peak, using smoothed records; empty if there is no maximum.
std::optional<Lag> refine(const Trace& x, const Trace& y, const Coarse& coarse, double smoothing) {
  const int peak = coarse.peak;
  const int reach = std::clamp(coarse.hill, 1, static_cast<int>(std::ceil(smoothing)) + 1);
  const auto left = static_cast<int>(std::min(x.x.size(), y.x.size()));
  if (left <= std::abs(peak) + reach + kMargin + 1) return std::nullopt;  // no overlap
  const Correlation c = correlate(x, y, peak - reach - kMargin - 1, peak + reach + kMargin + 1);
  int top = peak;
  for (int lag = peak - reach; lag <= peak + reach; ++lag)
    if (c.at(lag) > c.at(top)) top = lag;

  double low = top - 1.0;
  double high = top + 1.0;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (low + high);
    (shape_at(c, middle).slope > 0.0 ? low : high) = middle;
  }
  const double samples = 0.5 * (low + high);
  const double curvature = -shape_at(c, samples).curvature;
  if (!(curvature > 0.0)) return std::nullopt;
  // The variance has a noise-signal term and a noise-noise term. Smoothing reduces the second.
  const double noise_per_sample = std::max(0.0, 1.0 - coarse.height) / curvature;
  const auto n = static_cast<double>(coarse.shorter);
  const double width = std::sqrt(2.0 * smoothing * smoothing + 1.0);
  const double variance =
      2.0 * noise_per_sample / n + noise_per_sample * noise_per_sample /
                                       (n * 4.0 * std::sqrt(std::numbers::pi) * std::pow(width, 3));
  return Lag{samples, std::sqrt(variance), coarse.height};
}

double norm(const Trace& trace) {
  return Eigen::Map<const Eigen::VectorXd>(trace.x.data(),
                                           static_cast<Eigen::Index>(trace.x.size()))
      .norm();
}

/// Finds the maximum of the correlation of two records; empty if it is not significant.
std::optional<Coarse> coarse_peak(const Trace& x, const Trace& y, double first_x, double first_y,
                                  int max_lag) {
  const auto shorter = static_cast<int>(std::min(x.x.size(), y.x.size()));
  if (shorter < kShortest || max_lag < 1) return std::nullopt;
  max_lag = std::min(max_lag, shorter / 3);
  const double rounding = 1e-13 * std::sqrt(shorter);
  if (norm(x) <= rounding * std::abs(first_x) || norm(y) <= rounding * std::abs(first_y))
    return std::nullopt;
  const Correlation c = correlate(x, y, -max_lag - kMargin, max_lag + kMargin);
  const int peak = peak_lag(c, shorter);
  const double height = peak_at(c, peak).height;
  // Six standard deviations of the correlation between unrelated noise records.
  if (std::abs(peak) >= max_lag || height < 6.0 / std::sqrt(shorter)) return std::nullopt;
  if (cosine_at(c, peak) < std::cos(2.0 * std::numbers::pi * kFastest)) return std::nullopt;
  return Coarse{peak, half_width(c, peak), height, shorter};
}

}  // namespace

std::vector<std::optional<Lag>> find_lags(const std::vector<double>& a,
                                          const std::vector<const std::vector<double>*>& others,
                                          int max_lag) {
  std::vector<std::optional<Lag>> best(others.size());
  const Trace x = without_mean(a);
  std::vector<Trace> y;
  std::vector<std::optional<Coarse>> coarse;
  for (const std::vector<double>* b : others) {
    y.push_back(without_mean(*b));
    coarse.push_back(coarse_peak(x, y.back(), a.empty() ? 0.0 : a.front(),
                                 b->empty() ? 0.0 : b->front(), max_lag));
  }
  // Smoothing removes noise, but it also removes signal at any edges in the record.
  for (const double smoothing : {0.7, 1.5, 3.0, 6.0, 12.0, 24.0}) {
    std::optional<Trace> smooth_x;
    for (std::size_t k = 0; k < others.size(); ++k) {
      if (!coarse[k] || (best[k] && smoothing > coarse[k]->shorter / 60.0)) continue;
      if (!smooth_x) smooth_x = smooth(x, smoothing);
      const auto lag = refine(*smooth_x, smooth(y[k], smoothing), *coarse[k], smoothing);
      if (lag && (!best[k] || lag->sd_samples < best[k]->sd_samples)) best[k] = lag;
    }
  }
  return best;
}

std::optional<Lag> find_lag(const std::vector<double>& a, const std::vector<double>& b,
                            int max_lag) {
  return find_lags(a, {&b}, max_lag).front();
}

}  // namespace rigcal::datasets
