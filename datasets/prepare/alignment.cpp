#include "datasets/prepare/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "datasets/checks/equal_runs.hpp"
#include "datasets/checks/median.hpp"
#include "datasets/prepare/lag.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kFewestSamples = 0.02;  // a smaller shift is not worth an interpolation
constexpr double kSignificance = 3.0;    // in standard deviations of the offset
constexpr int kSearchSamples = 200;      // searched first, then ten times as many
constexpr double kDisproportion = 10.0;  // distance from the median, in median distances

double interval(const Repeat& repeat) {
  const auto n = repeat.time_s.size();
  return n < 2 ? 0.0 : (repeat.time_s.back() - repeat.time_s.front()) / static_cast<double>(n - 1);
}

/// Whether every sample is within a quarter of an interval of its nominal time.
bool is_uniform(const Repeat& repeat) {
  const double dt = interval(repeat);
  for (std::size_t i = 0; i < repeat.time_s.size(); ++i) {
    const double expected = repeat.time_s.front() + dt * static_cast<double>(i);
    if (std::abs(repeat.time_s[i] - expected) > 0.25 * dt) return false;
  }
  return true;
}

bool same_times(const Repeat& a, const Repeat& b) {
  const double tolerance = 1e-3 * interval(a);
  return a.time_s.size() == b.time_s.size() &&
         std::equal(a.time_s.begin(), a.time_s.end(), b.time_s.begin(),
                    [&](double s, double t) { return std::abs(s - t) <= tolerance; });
}

void require_values(const Repeat& repeat) {
  if (repeat.time_s.empty())
    throw std::invalid_argument(fmt::format("average: {} has no samples", repeat.source));
  for (const auto& [channel, values] : repeat.values)
    if (values.size() != repeat.time_s.size())
      throw std::invalid_argument(fmt::format("average: {} has {} samples of {} at {} times",
                                              repeat.source, values.size(), info(channel).key,
                                              repeat.time_s.size()));
}

void require_compatible(const Repeat& first, const Repeat& other) {
  if (same_times(first, other)) return;
  for (const Repeat* each : {&first, &other})
    if (!is_uniform(*each))
      throw std::invalid_argument(fmt::format(
          "{} and {} have different sample times, and those of {} are not equidistant: repeats "
          "must share their sample times or be sampled evenly",
          first.source, other.source, each->source));
  const double dt = interval(first);
  const auto samples = static_cast<double>(std::min(first.time_s.size(), other.time_s.size()));
  if (std::abs(interval(other) - dt) * samples > 0.1 * dt)
    throw std::invalid_argument(
        fmt::format("{} is sampled every {:.9g} s but {} every {:.9g} s: repeats of one condition "
                    "must be sampled at the same rate",
                    first.source, dt, other.source, interval(other)));
  if (other.time_s.front() > first.time_s.back() || other.time_s.back() < first.time_s.front())
    throw std::invalid_argument(fmt::format(
        "{} covers {:.6g} s to {:.6g} s but {} covers {:.6g} s to {:.6g} s: repeats of one "
        "condition must overlap in time",
        first.source, first.time_s.front(), first.time_s.back(), other.source, other.time_s.front(),
        other.time_s.back()));
}

/// Whether a signal jumps within one sample. The exact time of such an edge is unknown.
bool jumps(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  double step = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) step = std::max(step, std::abs(x[i] - x[i - 1]));
  return step > 0.25 * (*high - *low);
}

/// Returns the channels that every repeat has, with the best ones for alignment first.
std::vector<Channel> alignment_channels(const std::vector<Repeat>& repeats) {
  std::vector<Channel> smooth;
  std::vector<Channel> jumping;
  for (const Channel channel :
       {Channel::reference, Channel::force_reference, Channel::load_pressure_reference,
        Channel::acceleration_reference, Channel::angle_reference, Channel::torque_reference,
        Channel::command, Channel::pilot_pressure, Channel::position, Channel::angle,
        Channel::load_pressure, Channel::pressure_a, Channel::pressure_b, Channel::force,
        Channel::torque}) {
    const bool usable = std::all_of(repeats.begin(), repeats.end(), [&](const Repeat& repeat) {
      const auto found = repeat.values.find(channel);
      return found != repeat.values.end() && !is_constant(found->second);
    });
    if (!usable) continue;
    (jumps(repeats.front().values.at(channel)) ? jumping : smooth).push_back(channel);
  }
  smooth.insert(smooth.end(), jumping.begin(), jumping.end());
  return smooth;
}

/// Returns the repeat with the smallest sum of rms distances to the others. Among three repeats it
/// is never an outlier.
std::size_t central_repeat(const std::vector<Repeat>& repeats, Channel channel) {
  std::vector<double> total(repeats.size(), 0.0);
  for (std::size_t a = 0; a < repeats.size(); ++a) {
    for (std::size_t b = a + 1; b < repeats.size(); ++b) {
      const auto& x = repeats[a].values.at(channel);
      const auto& y = repeats[b].values.at(channel);
      const std::size_t n = std::min(x.size(), y.size());
      double sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
      const double distance = std::sqrt(sum / static_cast<double>(n));
      total[a] += distance;
      total[b] += distance;
    }
  }
  return static_cast<std::size_t>(std::min_element(total.begin(), total.end()) - total.begin());
}

/// Returns the mean of the offsets, excluding those that are far larger than the others.
double common_offset(const std::vector<double>& offsets, double smallest) {
  const double centre = median(offsets);
  std::vector<double> distance;
  for (const double offset : offsets) distance.push_back(std::abs(offset - centre));
  const double limit = offsets.size() < 3 ? std::numeric_limits<double>::infinity()
                                          : std::max(smallest, kDisproportion * median(distance));
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (distance[i] > limit) continue;
    sum += offsets[i];
    ++count;
  }
  return sum / count;
}

/// Returns the delay of each repeat relative to one of them, in samples; std::nullopt if any of
/// them cannot be determined.
std::optional<std::vector<Lag>> lags_against(std::size_t centre, const std::vector<Repeat>& repeats,
                                             Channel channel) {
  std::vector<const std::vector<double>*> others;
  for (std::size_t r = 0; r < repeats.size(); ++r)
    if (r != centre) others.push_back(&repeats[r].values.at(channel));
  const std::vector<double>& x = repeats[centre].values.at(channel);
  const auto near = find_lags(x, others, kSearchSamples);
  std::vector<Lag> lags;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (k == centre) lags.emplace_back();
    const auto lag = near[k] ? near[k] : find_lag(x, *others[k], 10 * kSearchSamples);
    if (!lag) return std::nullopt;
    lags.push_back(*lag);
  }
  if (centre == others.size()) lags.emplace_back();
  return lags;
}

struct Offsets {
  std::vector<double> seconds;
  std::vector<double> sd_s;
};

/// Finds the offsets by correlation, in the first channel that determines all of them.
std::optional<Offsets> correlate_offsets(const std::vector<Repeat>& repeats) {
  const double dt = interval(repeats.front());
  for (const Channel channel : alignment_channels(repeats)) {
    const std::size_t centre = central_repeat(repeats, channel);
    const auto lags = lags_against(centre, repeats, channel);
    if (!lags) continue;
    Offsets offsets;
    for (std::size_t r = 0; r < repeats.size(); ++r) {
      // Lags count samples from the start of each file, so the start times are added.
      offsets.seconds.push_back((*lags)[r].samples * dt + repeats[r].time_s.front() -
                                repeats[centre].time_s.front());
      offsets.sd_s.push_back((*lags)[r].sd_samples * dt);
    }
    // The offset of the central repeat is known no better than those of the other repeats.
    offsets.sd_s[centre] = *std::max_element(offsets.sd_s.begin(), offsets.sd_s.end());
    const double common = common_offset(offsets.seconds, dt);
    for (double& offset : offsets.seconds) offset -= common;
    return offsets;
  }
  return std::nullopt;
}

/// Whether any offset is significant. Either all repeats are shifted or none, because shifting only
/// a few of them would shift their mean.
bool any_significant(const Offsets& offsets, double smallest_s) {
  for (std::size_t r = 0; r < offsets.seconds.size(); ++r) {
    if (std::abs(offsets.seconds[r]) > std::max(smallest_s, kSignificance * offsets.sd_s[r]))
      return true;
  }
  return false;
}

}  // namespace

AlignedRepeats align(const std::vector<Repeat>& repeats, bool correlate) {
  if (repeats.empty()) throw std::invalid_argument("average: no repeat");
  for (const Repeat& repeat : repeats) require_values(repeat);
  const Repeat& first = repeats.front();
  for (const Repeat& repeat : repeats) require_compatible(first, repeat);

  AlignedRepeats result;
  result.offset_s.assign(repeats.size(), 0.0);
  result.shifted_s.assign(repeats.size(), 0.0);
  const double dt = interval(first);
  for (const Repeat& repeat : repeats) {
    const bool same = same_times(first, repeat);
    result.shift.push_back(same ? 0.0 : (first.time_s.front() - repeat.time_s.front()) / dt);
  }
  if (!correlate || repeats.size() < 2) return result;
  // In a bridged hole, an edge moves to the end of the hole, which would look like an offset.
  if (std::any_of(repeats.begin(), repeats.end(),
                  [](const Repeat& repeat) { return !repeat.bridged.empty(); })) {
    result.warnings.emplace_back("holes are bridged: repeats are not aligned");
    return result;
  }
  if (!is_uniform(first)) {
    result.warnings.emplace_back("the sample times are not equidistant: repeats are not aligned");
    return result;
  }
  const auto offsets = correlate_offsets(repeats);
  if (!offsets) {
    result.warnings.emplace_back(
        "no channel determines the offsets of all repeats (none common to all, constant, too "
        "noisy, too far apart, or faster than 0.35 of the sample rate): repeats are not aligned");
    return result;
  }
  result.offset_s = offsets->seconds;
  if (!any_significant(*offsets, kFewestSamples * dt)) return result;
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    const double offset = offsets->seconds[r];
    if (std::abs(offset) <= kFewestSamples * dt) continue;
    result.shifted_s[r] = offset;
    result.shift[r] += offset / dt;
  }
  return result;
}

}  // namespace rigcal::datasets
