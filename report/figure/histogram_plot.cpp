#include "report/figure/histogram_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace rigcal::report {
namespace {

constexpr int kFewestBins = 11;
constexpr int kMostBins = 41;
constexpr int kNormalPoints = 81;

/// Chooses the number of bins by the rule of Freedman and Diaconis. Uses selection instead of
/// sorting, because a record is too long to sort just for two quartiles.
int bins_of(double span, std::vector<double> values) {
  const auto quantile = [&values](std::size_t rank) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  const double quartiles = quantile(values.size() * 3 / 4) - quantile(values.size() / 4);
  const double width = 2.0 * quartiles / std::cbrt(static_cast<double>(values.size()));
  if (!(width > 0.0)) return kMostBins;
  return static_cast<int>(
      std::clamp(std::ceil(span / width), double{kFewestBins}, double{kMostBins}));
}

}  // namespace

Plot histogram_plot(const std::string& title, std::span<const double> residual,
                    const std::string& unit, double si) {
  Plot plot{title, fmt::format("residual [{}]", unit), fmt::format("density [1/{}]", unit), 300.0,
            170.0};
  std::vector<double> values;
  for (const double value : residual)
    if (std::isfinite(value)) values.push_back(value / si);
  if (values.empty()) return plot;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const double low = *lowest;
  const double high = *highest;
  if (!(low < high)) return plot;
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values) mean += value / n;
  double variance = 0.0;
  for (const double value : values) variance += (value - mean) * (value - mean) / n;
  const double sd = std::sqrt(variance);

  const int bins = bins_of(high - low, values);
  const double width = (high - low) / bins;
  std::vector<double> counts(static_cast<std::size_t>(bins), 0.0);
  for (const double value : values) {
    const auto bin = static_cast<std::size_t>((value - low) / width);
    counts[std::min(bin, counts.size() - 1)] += 1.0;
  }
  Trace area = empty_trace(Trace::Kind::band, "residual", "residual");
  Trace outline = empty_trace(Trace::Kind::line, "residual");
  outline.x.push_back(low);
  outline.y.push_back(0.0);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double density = counts[k] / (n * width);
    for (const double edge :
         {low + static_cast<double>(k) * width, low + static_cast<double>(k + 1) * width}) {
      area.x.push_back(edge);
      area.y.push_back(0.0);
      area.upper.push_back(density);
      outline.x.push_back(edge);
      outline.y.push_back(density);
    }
  }
  outline.x.push_back(high);
  outline.y.push_back(0.0);
  Trace normal = empty_trace(Trace::Kind::line, "reference", "normal");
  const double first = std::min(low, mean - 3.0 * sd);
  const double last = std::max(high, mean + 3.0 * sd);
  for (int i = 0; i < kNormalPoints; ++i) {
    const double x = first + (last - first) * i / (kNormalPoints - 1);
    const double z = (x - mean) / sd;
    normal.x.push_back(x);
    normal.y.push_back(std::exp(-0.5 * z * z) / (sd * std::sqrt(2.0 * std::numbers::pi)));
  }
  plot.traces = {std::move(area), std::move(outline), std::move(normal)};
  return plot;
}

}  // namespace rigcal::report
