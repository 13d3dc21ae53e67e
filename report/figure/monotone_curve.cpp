#include "report/figure/monotone_curve.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace rigcal::report {
namespace {

/// Returns the slope at a point between two intervals: a weighted harmonic mean of their slopes, or
/// zero at an extreme.
double inner_slope(double length_before, double before, double length_after, double after) {
  if (!(before * after > 0.0)) return 0.0;
  const double weight_before = 2.0 * length_after + length_before;
  const double weight_after = length_after + 2.0 * length_before;
  return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

/// Returns the slope at the first point: that of the parabola through three points, limited so that
/// the curve remains monotone.
double end_slope(double length, double first, double length_after, double after) {
  const double slope =
      ((2.0 * length + length_after) * first - length * after) / (length + length_after);
  if (!(slope * first > 0.0)) return 0.0;
  if (first * after < 0.0 && std::abs(slope) > 3.0 * std::abs(first)) return 3.0 * first;
  return slope;
}

}  // namespace

DrawnCurve monotone_curve(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  DrawnCurve curve{{x.begin(), x.end()}, {y.begin(), y.end()}};
  const bool ascending = std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) == x.end();
  if (n < 3 || !ascending) return curve;
  std::vector<double> length, secant;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    length.push_back(x[i + 1] - x[i]);
    secant.push_back((y[i + 1] - y[i]) / length.back());
  }
  std::vector<double> slope{end_slope(length[0], secant[0], length[1], secant[1])};
  for (std::size_t i = 1; i + 1 < n; ++i)
    slope.push_back(inner_slope(length[i - 1], secant[i - 1], length[i], secant[i]));
  slope.push_back(end_slope(length[n - 2], secant[n - 2], length[n - 3], secant[n - 3]));
  constexpr int kPieces = 8;  // between two points, at which a curve of 300 pixels looks smooth
  curve = {};
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (int piece = 0; piece < kPieces; ++piece) {
      const double t = static_cast<double>(piece) / kPieces;
      const double rest = 1.0 - t;
      curve.x.push_back(x[i] + t * length[i]);
      curve.y.push_back(rest * rest * ((1.0 + 2.0 * t) * y[i] + t * length[i] * slope[i]) +
                        t * t * ((1.0 + 2.0 * rest) * y[i + 1] - rest * length[i] * slope[i + 1]));
    }
  }
  curve.x.push_back(x[n - 1]);
  curve.y.push_back(y[n - 1]);
  return curve;
}

}  // namespace rigcal::report
