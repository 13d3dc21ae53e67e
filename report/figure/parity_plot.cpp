#include "report/figure/parity_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "metrics/distributions.hpp"

namespace rigcal::report {
namespace {

constexpr int kCells = 72;  ///< number of cells along an axis, three pixels each
/// Upper limits of the shades, as fractions of the fullest cell's count.
constexpr std::array kShades{std::pair{0.05, "sparse"}, std::pair{0.35, "medium"},
                             std::pair{1.0, "dense"}};

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Trace diagonal(const Extent& range, double shift, const std::string& style, std::string name) {
  Trace line = empty_trace(Trace::Kind::line, style, std::move(name));
  // The line is clipped to the square in which both axes have this range.
  const double first = std::max(range.low, range.low - shift);
  const double last = std::min(range.high, range.high - shift);
  if (first > last) return line;
  line.x = {first, last};
  line.y = {first + shift, last + shift};
  return line;
}

}  // namespace

ResidualMoments residual_moments(std::span<const double> measured,
                                 std::span<const double> simulated) {
  ResidualMoments result;
  double squares = 0.0;
  const std::size_t size = std::min(measured.size(), simulated.size());
  for (std::size_t i = 0; i < size; ++i) {
    const double e = measured[i] - simulated[i];
    if (!std::isfinite(e)) continue;
    ++result.samples;
    const double before = e - result.mean;
    result.mean += before / static_cast<double>(result.samples);
    squares += before * (e - result.mean);
  }
  if (result.samples > 0) result.sd = std::sqrt(squares / static_cast<double>(result.samples));
  return result;
}

Plot parity_plot(const std::string& title, std::span<const double> measured,
                 std::span<const double> simulated, const std::string& unit, double si) {
  Plot plot{title, fmt::format("measured [{}]", unit), fmt::format("model [{}]", unit), 290.0,
            274.0};
  plot.same_axes = true;
  Extent range;
  const std::size_t size = std::min(measured.size(), simulated.size());
  const auto there = [&](std::size_t i) {
    return std::isfinite(measured[i]) && std::isfinite(simulated[i]);
  };
  for (std::size_t i = 0; i < size; ++i) {
    if (!there(i)) continue;
    range.take(measured[i] / si);
    range.take(simulated[i] / si);
  }
  if (!(range.low < range.high)) return plot;
  const double cell = (range.high - range.low) / kCells;
  const auto index = [&](double value) {
    const int at = std::clamp(static_cast<int>((value / si - range.low) / cell), 0, kCells - 1);
    return static_cast<std::size_t>(at);
  };
  std::vector<std::size_t> counts(std::size_t{kCells} * kCells, 0);  // in column order
  for (std::size_t i = 0; i < size; ++i)
    if (there(i)) ++counts[index(measured[i]) * kCells + index(simulated[i])];
  const std::size_t fullest = *std::max_element(counts.begin(), counts.end());

  const ResidualMoments moments = residual_moments(measured, simulated);
  plot.traces.push_back(diagonal(range, 0.0, "measured", "model = measured"));
  for (const double side : {-1.0, 1.0})
    plot.traces.push_back(diagonal(
        range, (-moments.mean + side * metrics::kNormal95 * moments.sd) / si, "reference", {}));
  double from = 0.0;
  for (const auto& [share, style] : kShades) {
    Trace shade = empty_trace(Trace::Kind::cells, style);
    shade.cell = cell;
    for (std::size_t at = 0; at < counts.size(); ++at) {
      const double of_fullest = static_cast<double>(counts[at]) / static_cast<double>(fullest);
      if (of_fullest <= from || of_fullest > share) continue;
      const std::size_t column = at / kCells;
      const std::size_t row = at % kCells;
      shade.x.push_back(range.low + (static_cast<double>(column) + 0.5) * cell);
      shade.y.push_back(range.low + (static_cast<double>(row) + 0.5) * cell);
    }
    from = share;
    if (!shade.x.empty()) plot.traces.push_back(std::move(shade));
  }
  // The lines are drawn above the samples.
  std::rotate(plot.traces.begin(), plot.traces.begin() + 3, plot.traces.end());
  return plot;
}

}  // namespace rigcal::report
