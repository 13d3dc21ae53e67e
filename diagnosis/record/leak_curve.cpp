#include "diagnosis/record/leak_curve.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rigcal::diagnosis {
namespace {

/// An interpolated value and its slope.
struct ValueAt {
  double value = 0.0;
  double slope = 0.0;
};

ValueAt hermite(const std::vector<LeakPoint>& points, double LeakPoint::*member,
                double LeakPoint::*slope, double coefficient) {
  const LeakPoint& first = points.front();
  const LeakPoint& last = points.back();
  for (const LeakPoint* end : {&first, &last}) {
    const double beyond = coefficient - end->coefficient;
    if (end == &last ? beyond >= 0.0 : beyond <= 0.0)
      return {end->*member + end->*slope * beyond, end->*slope};
  }
  const auto above = std::upper_bound(
      points.begin(), points.end(), coefficient,
      [](double value, const LeakPoint& point) { return value < point.coefficient; });
  const LeakPoint& b = *above;
  const LeakPoint& a = *(above - 1);
  const double width = b.coefficient - a.coefficient;
  const double t = (coefficient - a.coefficient) / width;
  const double secant = (b.*member - a.*member) / width;
  // Newton's form: the value and the slope at a, and the terms for the secant and for the slope at
  // b.
  const double second = secant - a.*slope;
  const double third = a.*slope + b.*slope - 2.0 * secant;
  const double step = width * t;
  return {a.*member + step * (a.*slope + t * (second + (t - 1.0) * third)),
          a.*slope + t * (2.0 * second + (3.0 * t - 2.0) * third)};
}

/// Fraction of the next coefficient that is so small that the leak is proportional to it. The slope
/// there is used at zero, where |leakage flow| has no derivative.
constexpr double kProportional = 0.02;

/// Whether an estimate is so close to zero that it gets no point of its own. All records without a
/// leak then need the same simulations.
bool is_none(double coefficient, double reach) { return coefficient <= kProportional * reach; }

LeakPoint without_leak(const LeakAt& leak_at, double next) {
  // Records whose next coefficients are similar share this one.
  const LeakPoint small = leak_at(std::exp2(std::floor(std::log2(kProportional * next))));
  return {0.0, 0.0, 0.0, small.share / small.coefficient,
          small.leak_flow_m3_per_s / small.coefficient};
}

}  // namespace

LeakCurve::LeakCurve(std::vector<LeakPoint> points) : points_(std::move(points)) {
  bool increasing = points_.size() >= 2 && points_.front().coefficient >= 0.0;
  for (std::size_t i = 1; i < points_.size(); ++i)
    increasing = increasing && points_[i].coefficient > points_[i - 1].coefficient;
  if (!increasing)
    throw std::invalid_argument("LeakCurve: expected at least 2 points of increasing coefficient");
}

double LeakCurve::share(double coefficient) const {
  if (!(coefficient > 0.0)) return 0.0;
  return std::max(0.0,
                  hermite(points_, &LeakPoint::share, &LeakPoint::share_slope, coefficient).value);
}

double LeakCurve::leak_flow_m3_per_s(double coefficient) const {
  if (!(coefficient > 0.0)) return 0.0;
  return std::max(
      0.0,
      hermite(points_, &LeakPoint::leak_flow_m3_per_s, &LeakPoint::flow_slope, coefficient).value);
}

double LeakCurve::share_slope(double coefficient) const {
  return hermite(points_, &LeakPoint::share, &LeakPoint::share_slope, std::max(0.0, coefficient))
      .slope;
}

LeakCurve curve_about(const LeakAt& leak_at, double coefficient, double reach) {
  const double low = coefficient - reach;
  const bool none = is_none(coefficient, reach);
  const double high = none ? reach : coefficient + reach;
  std::vector<LeakPoint> points{low > 0.0 ? leak_at(low) : without_leak(leak_at, high)};
  if (!none) points.push_back(leak_at(coefficient));
  points.push_back(leak_at(high));
  return LeakCurve(std::move(points));
}

LeakPoint point_about(const LeakAt& leak_at, double coefficient, double reach) {
  if (!is_none(coefficient, reach)) return leak_at(coefficient);
  const LeakCurve curve = curve_about(leak_at, coefficient, reach);
  LeakPoint point;
  point.coefficient = coefficient;
  point.share = curve.share(coefficient);
  point.leak_flow_m3_per_s = curve.leak_flow_m3_per_s(coefficient);
  return point;
}

}  // namespace rigcal::diagnosis
