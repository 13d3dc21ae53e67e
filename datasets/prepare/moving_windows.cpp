#include "datasets/prepare/moving_windows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "datasets/checks/median.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kHeldShare = 0.02;   // fraction of the command's range
constexpr double kStepShare = 0.05;   // fraction of the command's range
constexpr double kLongestRise = 0.1;  // fraction of the time for which the command is constant
constexpr double kLeastTravelShare = 0.05;  // fraction of the range of positions
constexpr double kArrivedShare = 0.01;      // fraction of the travel
constexpr double kNoiseFactor = 6.0;        // in standard deviations of the noise
constexpr double kSpreadFactor = 2.0;       // in standard deviations over the repeats
constexpr double kTailShare = 0.05;     // final fraction of a level, used to find where motion ends
constexpr std::size_t kFewestHeld = 5;  // samples at one level

/// Samples [begin, end).
struct SampleSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

double median_over(std::span<const double> x, SampleSpan span) {
  return median({x.begin() + static_cast<std::ptrdiff_t>(span.begin),
                 x.begin() + static_cast<std::ptrdiff_t>(span.end)});
}

/// Returns the running median over 2 half + 1 samples, or fewer at the ends.
std::vector<double> smoothed(std::span<const double> x, std::size_t half) {
  std::vector<double> result(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t reach = std::min({half, i, x.size() - 1 - i});
    result[i] = median_over(x, {i - reach, i + reach + 1});
  }
  return result;
}

double range_of(std::span<const double> x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

/// Returns the standard deviation of white noise, from the median of the second differences. Slopes
/// cancel, and edges and spikes are too few to affect the median.
double noise_sd(std::span<const double> x) {
  if (x.size() < 3) return 0.0;
  std::vector<double> differences;
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    differences.push_back(std::abs(x[i - 1] - 2.0 * x[i] + x[i + 1]));
  constexpr double kMedianOfNormal = 0.6745;  // median of |N(0, 1)|
  return median(differences) / (kMedianOfNormal * std::sqrt(6.0));
}

/// Returns the stretches in which the command remains at one level.
std::vector<SampleSpan> held_levels(std::span<const double> command) {
  const std::vector<double> clean = smoothed(command, 2);  // removes spikes, keeps edges
  const double tolerance = std::max(kHeldShare * range_of(clean), kNoiseFactor * noise_sd(command));
  std::vector<SampleSpan> levels;
  for (std::size_t begin = 0; begin < clean.size();) {
    std::size_t end = begin + 1;
    while (end < clean.size() && std::abs(clean[end] - clean[begin]) <= tolerance) ++end;
    if (end - begin >= kFewestHeld) levels.push_back({begin, end});
    begin = end;
  }
  return levels;
}

/// Returns the constant levels that follow a step. Each begins with the first sample that leaves
/// the previous level.
std::vector<SampleSpan> stepped_levels(std::span<const double> time_s,
                                       std::span<const double> command) {
  const double least =
      std::max(kStepShare * range_of(smoothed(command, 2)), 2.0 * kNoiseFactor * noise_sd(command));
  std::vector<SampleSpan> stepped;
  const auto levels = held_levels(command);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const SampleSpan level = levels[k];
    if (k == 0) {
      if (level.begin == 0) stepped.push_back(level);
      continue;
    }
    const SampleSpan before = levels[k - 1];
    const double held_s = time_s[level.end - 1] - time_s[level.begin];
    const double rise_s = time_s[level.begin] - time_s[before.end];
    const double step = std::abs(median_over(command, level) - median_over(command, before));
    if (step > least && rise_s <= kLongestRise * held_s) stepped.push_back({before.end, level.end});
  }
  return stepped;
}

/// Finds the motion of the piston under one constant command; empty if it does not move.
std::vector<Motion> motion_in(SampleSpan held, std::span<const double> time_s,
                              std::span<const double> position_m, std::span<const double> spread_m,
                              double least_travel_m, double noise_m) {
  const auto tail = std::max<std::size_t>(
      kFewestHeld, static_cast<std::size_t>(kTailShare * static_cast<double>(held.size())));
  if (held.size() < 3 * tail) return {};
  const auto x = smoothed(position_m.subspan(held.begin, held.size()),
                          std::clamp<std::size_t>(held.size() / 500, 2, 25));
  Motion motion;
  motion.from_m = median_over(x, {0, kFewestHeld});
  motion.to_m = median_over(x, {x.size() - tail, x.size()});
  const double travel_m = std::abs(motion.to_m - motion.from_m);
  if (travel_m <= least_travel_m) return {};

  const double before_m = median_over(x, {x.size() - 2 * tail, x.size() - tail});
  const double least_margin_m = std::max(kArrivedShare * travel_m, 2.0 * noise_m);
  std::size_t last = x.size() - 1;
  motion.arrived = std::abs(motion.to_m - before_m) <= least_margin_m;
  motion.margin_m = least_margin_m;
  if (motion.arrived) {
    const auto spread = [&](std::size_t i) {
      if (spread_m.empty()) return 0.0;
      const SampleSpan around{held.begin + (i > 2 ? i - 2 : 0),
                              std::min(held.begin + i + 3, spread_m.size())};
      std::vector<double> known;
      for (std::size_t j = around.begin; j < around.end; ++j)
        if (std::isfinite(spread_m[j])) known.push_back(spread_m[j]);
      return known.empty() ? 0.0 : median(known);
    };
    for (std::size_t i = 0; i < x.size(); ++i) {
      motion.margin_m = std::max(least_margin_m, kSpreadFactor * spread(i));
      if (std::abs(x[i] - motion.to_m) > motion.margin_m) continue;
      last = i;
      break;
    }
  }
  motion.window = {time_s[held.begin], time_s[held.begin + last]};
  return {motion};
}

}  // namespace

std::vector<Motion> find_motions(std::span<const double> time_s, std::span<const double> command,
                                 std::span<const double> position_m,
                                 std::span<const double> spread_m) {
  if (command.size() != time_s.size() || position_m.size() != time_s.size() ||
      (!spread_m.empty() && spread_m.size() != time_s.size()))
    throw std::invalid_argument("find_motions: times, command, position and spread differ in size");
  if (time_s.size() < 3 * kFewestHeld) return {};
  const double noise_m = noise_sd(position_m);
  const double least_travel_m =
      std::max(kLeastTravelShare * range_of(smoothed(position_m, 2)), kNoiseFactor * noise_m);
  std::vector<Motion> motions;
  for (const SampleSpan held : stepped_levels(time_s, command)) {
    const auto found = motion_in(held, time_s, position_m, spread_m, least_travel_m, noise_m);
    motions.insert(motions.end(), found.begin(), found.end());
  }
  return motions;
}

}  // namespace rigcal::datasets
