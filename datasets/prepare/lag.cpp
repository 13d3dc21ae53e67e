#include "datasets/prepare/lag.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace rigcal::datasets {
namespace {

// Lags beyond the search that the interpolation of its outermost peak needs.
constexpr int kMargin = 4;

// Of the sample rate. A faster sinusoid has its peaks so close together, and so few samples on
// each, that noise decides which is the nearest.
constexpr double kFastest = 0.35;

Eigen::VectorXd without_mean(const std::vector<double>& x) {
  const Eigen::Map<const Eigen::VectorXd> map(x.data(), static_cast<Eigen::Index>(x.size()));
  return map.array() - map.mean();
}

/// Sums of the first i values, i = 0..n.
Eigen::VectorXd running_sum(const Eigen::VectorXd& x) {
  Eigen::VectorXd sum(x.size() + 1);
  sum[0] = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) sum[i + 1] = sum[i] + x[i];
  return sum;
}

/// Pearson's correlation of the overlap at each lag of a range; 0 where one side is constant.
struct Correlation {
  int first_lag = 0;
  std::vector<double> r;

  int last_lag() const { return first_lag + static_cast<int>(r.size()) - 1; }
  double at(int lag) const { return r[static_cast<std::size_t>(lag - first_lag)]; }
};

Correlation correlate(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int first_lag,
                      int last_lag) {
  const Eigen::VectorXd sum_a = running_sum(a);
  const Eigen::VectorXd sum_b = running_sum(b);
  const Eigen::VectorXd sum_aa = running_sum(a.cwiseAbs2());
  const Eigen::VectorXd sum_bb = running_sum(b.cwiseAbs2());
  Correlation result{first_lag, {}};
  for (int lag = first_lag; lag <= last_lag; ++lag) {
    const Eigen::Index begin = std::max<Eigen::Index>(0, -lag);
    const Eigen::Index end = std::min<Eigen::Index>(a.size(), b.size() - lag);
    const auto n = static_cast<double>(end - begin);
    const double total_a = sum_a[end] - sum_a[begin];
    const double total_b = sum_b[end + lag] - sum_b[begin + lag];
    const double variance_a = sum_aa[end] - sum_aa[begin] - total_a * total_a / n;
    const double variance_b = sum_bb[end + lag] - sum_bb[begin + lag] - total_b * total_b / n;
    const double covariance =
        a.segment(begin, end - begin).dot(b.segment(begin + lag, end - begin)) -
        total_a * total_b / n;
    // Rounding leaves a trace of the whole record's energy in a constant overlap.
    const bool constant =
        variance_a <= 1e-12 * sum_aa[a.size()] || variance_b <= 1e-12 * sum_bb[b.size()];
    result.r.push_back(constant ? 0.0 : covariance / std::sqrt(variance_a * variance_b));
  }
  return result;
}

/// Cosine of the phase that a sinusoid of this correlation passes per sample.
double cosine_at(const Correlation& c, int lag) {
  return (c.at(lag - 1) + c.at(lag + 1)) / (2.0 * c.at(lag));
}

/// A maximum between the samples.
struct Peak {
  double lag = 0.0;
  double height = 0.0;
};

/// The peak around a lag that is higher than its neighbours, exact for a sinusoid: one half way
/// between two samples must look neither lower nor nearer than one that a sample hits.
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

/// The whole lag to trust: of the peaks that are as good as the highest, the one nearest to zero.
/// Two maxima are different peaks only with a real valley between them, which the ripple that noise
/// leaves on a flat top is not.
int peak_lag(const Correlation& c, int samples) {
  std::vector<Peak> peaks;
  for (int lag = c.first_lag; lag <= c.last_lag(); ++lag) peaks.push_back(peak_at(c, lag));
  const auto peak = [&](int lag) { return peaks[static_cast<std::size_t>(lag - c.first_lag)]; };
  double highest = -1.0;
  for (const Peak& each : peaks) highest = std::max(highest, each.height);
  // The ends of the overlap, which hold parts of periods, change a height by 1 / samples or so.
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

/// Lags from the peak to where the correlation has fallen by a tenth, or to the end of the search.
int half_width(const Correlation& c, int peak) {
  int width = 0;
  while (peak - width > c.first_lag && peak + width < c.last_lag() &&
         std::min(c.at(peak - width), c.at(peak + width)) > c.at(peak) - 0.1)
    ++width;
  return width;
}

/// Gaussian smoothing, without the ends that the kernel does not cover.
Eigen::VectorXd smooth(const Eigen::VectorXd& x, double sd_samples) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(4.0 * sd_samples));
  Eigen::VectorXd kernel(2 * reach + 1);
  for (Eigen::Index j = -reach; j <= reach; ++j) {
    const double z = static_cast<double>(j) / sd_samples;
    kernel[j + reach] = std::exp(-0.5 * z * z);
  }
  kernel /= kernel.sum();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(x.size() - 2 * reach);
  for (Eigen::Index j = 0; j < kernel.size(); ++j)
    result += kernel[j] * x.segment(j, result.size());
  return result;
}

/// Slope and curvature of the correlation between samples, interpolated by a Gaussian of one sample
/// (its aliasing is exp(-2 pi^2), 3e-9).
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

/// The lag near `peak` after both records were smoothed; empty where there is no maximum.
/// @param hill  lags over which the peak stretches, @param r  its height
std::optional<Lag> refine(const Eigen::VectorXd& x, const Eigen::VectorXd& y, int peak, int hill,
                          double r, double smoothing) {
  const int reach = std::clamp(hill, 1, static_cast<int>(std::ceil(smoothing)) + 1);
  const Correlation c = correlate(smooth(x, smoothing), smooth(y, smoothing),
                                  peak - reach - kMargin - 1, peak + reach + kMargin + 1);
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
  // Noise against signal, then noise against noise behind the smoothing of both records.
  const double noise_per_sample = std::max(0.0, 1.0 - r) / curvature;
  const auto n = static_cast<double>(std::min(x.size(), y.size()));
  const double width = std::sqrt(2.0 * smoothing * smoothing + 1.0);
  const double variance =
      2.0 * noise_per_sample / n + noise_per_sample * noise_per_sample /
                                       (n * 4.0 * std::sqrt(std::numbers::pi) * std::pow(width, 3));
  return Lag{samples, std::sqrt(variance), r};
}

}  // namespace

std::optional<Lag> find_lag(const std::vector<double>& a, const std::vector<double>& b,
                            int max_lag) {
  const auto shorter = static_cast<int>(std::min(a.size(), b.size()));
  if (shorter < 64 || max_lag < 1) return std::nullopt;
  max_lag = std::min(max_lag, shorter / 3);

  const Eigen::VectorXd x = without_mean(a);
  const Eigen::VectorXd y = without_mean(b);
  const double rounding = 1e-13;
  if (x.norm() <= rounding * std::sqrt(shorter) * std::abs(a.front()) ||
      y.norm() <= rounding * std::sqrt(shorter) * std::abs(b.front()))
    return std::nullopt;
  const Correlation coarse = correlate(x, y, -max_lag - kMargin, max_lag + kMargin);
  const int peak = peak_lag(coarse, shorter);
  const double r = peak_at(coarse, peak).height;
  // Six standard deviations of what unrelated noise correlates by chance.
  if (std::abs(peak) >= max_lag || r < 6.0 / std::sqrt(shorter)) return std::nullopt;
  if (cosine_at(coarse, peak) < std::cos(2.0 * std::numbers::pi * kFastest)) return std::nullopt;

  // Smoothing takes noise away and, where the record has edges, the signal with it.
  std::optional<Lag> best;
  for (const double smoothing : {0.7, 1.5, 3.0, 6.0, 12.0, 24.0}) {
    if (best && smoothing > shorter / 60.0) break;
    const auto lag = refine(x, y, peak, half_width(coarse, peak), r, smoothing);
    if (lag && (!best || lag->sd_samples < best->sd_samples)) best = lag;
  }
  return best;
}

}  // namespace rigcal::datasets
