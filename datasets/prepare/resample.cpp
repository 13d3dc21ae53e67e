#include "datasets/prepare/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace rigcal::datasets {
namespace {

constexpr long kReach = 16;  // samples on each side

/// Weights of x[k - kReach + 1 .. k + kReach] for the value at k + fraction.
std::array<double, 2 * kReach> band_limited_weights(double fraction) {
  std::array<double, 2 * kReach> weights{};
  for (std::size_t j = 0; j < weights.size(); ++j) {
    const double z = fraction - static_cast<double>(static_cast<long>(j) - kReach + 1);
    const double angle = std::numbers::pi * z;
    const double sinc = std::abs(angle) < 1e-9 ? 1.0 : std::sin(angle) / angle;
    const double window = 0.5 + 0.5 * std::cos(angle / kReach);
    weights[j] = sinc * window;
  }
  // The weights are normalised so that a constant remains unchanged.
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

double reflected(const std::vector<double>& x, long index) {
  const long last = static_cast<long>(x.size()) - 1;
  const auto value = [&](long k) { return x[static_cast<std::size_t>(std::clamp(k, 0L, last))]; };
  if (index < 0) return 2.0 * x.front() - value(-index);
  if (index > last) return 2.0 * x.back() - value(2 * last - index);
  return value(index);
}

std::vector<double> shifted(const std::vector<double>& x, double shift, std::size_t samples,
                            Interpolator interpolator) {
  std::vector<double> result(samples, std::numeric_limits<double>::quiet_NaN());
  const long last = static_cast<long>(x.size()) - 1;
  const double nearest = std::round(shift);
  const bool whole = std::abs(shift - nearest) < 1e-6;
  const double below = whole ? nearest : std::floor(shift);
  const double fraction = whole ? 0.0 : shift - below;
  const auto weights = band_limited_weights(fraction);
  for (std::size_t i = 0; i < samples; ++i) {
    const long k = static_cast<long>(i) + static_cast<long>(below);
    if (k < 0 || k > last || (!whole && k + 1 > last)) continue;
    const auto at = static_cast<std::size_t>(k);
    if (whole) {
      result[i] = x[at];
    } else if (interpolator == Interpolator::linear) {
      result[i] = (1.0 - fraction) * x[at] + fraction * x[at + 1];
    } else {
      double sum = 0.0;
      const bool inner = k - kReach + 1 >= 0 && k + kReach <= last;
      for (std::size_t j = 0; j < weights.size(); ++j) {
        const long index = k - kReach + 1 + static_cast<long>(j);
        sum += weights[j] * (inner ? x[static_cast<std::size_t>(index)] : reflected(x, index));
      }
      result[i] = sum;
    }
  }
  return result;
}

}  // namespace rigcal::datasets
