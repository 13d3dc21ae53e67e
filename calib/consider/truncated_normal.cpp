#include "calib/consider/truncated_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rigcal::calib {
namespace {

/// Returns the density of the standard normal distribution at a, divided by the probability of its
/// upper tail.
double hazard(double a) {
  // Far out the tail underflows, but there the series is accurate to 1e-5.
  constexpr double kFarOut = 20.0;
  if (a > kFarOut) return a + 1.0 / a - 2.0 / (a * a * a);
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
  return density / (0.5 * std::erfc(a / std::numbers::sqrt2));
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// Returns the moments of a normal distribution from which the part below zero has been cut off.
Moments above_zero(const Moments& normal) {
  const double sd = std::sqrt(normal.variance);
  const double a = -normal.mean / sd;
  const double h = hazard(a);
  // For large a, 1 - h (h - a) suffers from cancellation, and is approximately 1 / a^2.
  constexpr double kCancels = 20.0;
  const double share = a > kCancels ? 1.0 / (a * a) : 1.0 - h * (h - a);
  return {normal.mean + sd * h, normal.variance * share};
}

/// Normal factor exp(-precision x^2 / 2 + pull x) for one constraint.
struct Factor {
  double precision = 0.0;
  double pull = 0.0;
};

}  // namespace

NormalMoments cut_at_zero(NormalMoments normal, const std::vector<Eigen::Index>& never_negative) {
  constexpr int kMostSweeps = 50;
  constexpr double kSettled = 1e-9;
  std::vector<Factor> factors(never_negative.size());
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0.0;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const Eigen::Index k = never_negative[i];
      const double variance = normal.covariance(k, k);
      if (!(variance > 0.0)) continue;
      const double left = 1.0 / variance - factors[i].precision;
      if (!(left > 0.0)) continue;
      const Moments without{(normal.mean(k) / variance - factors[i].pull) / left, 1.0 / left};
      const Moments cut = above_zero(without);
      const Factor next{1.0 / cut.variance - left, cut.mean / cut.variance - without.mean * left};
      const double precision = next.precision - factors[i].precision;
      const double pull = next.pull - factors[i].pull;
      factors[i] = next;
      const Eigen::VectorXd column = normal.covariance.col(k);
      const double scale = 1.0 / (1.0 + precision * variance);
      const double step = (pull - precision * normal.mean(k)) * scale;
      moved = std::max(moved, std::abs(step) * std::sqrt(variance));
      normal.mean += step * column;
      normal.covariance -= precision * scale * column * column.transpose();
    }
    if (moved < kSettled) break;
  }
  // The factors of other components move a mean after its own factor has cut it. If a
  // component is confined to zero within rounding, that leaves its mean slightly below zero.
  for (const Eigen::Index k : never_negative) normal.mean(k) = std::max(0.0, normal.mean(k));
  return normal;
}

}  // namespace rigcal::calib
